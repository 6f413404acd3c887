# SPDX-License-Identifier: GPL-3.0-or-later
"""Fluid domains in Blender as a module, which aborts as it ends, and where it evaluates a simulation again."""

import logging
import os
import shutil
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

logger = logging.getLogger(__name__)

_temporary_folders: set[Path] = set()
"""Temporary folders of Blender, where a file with fluid domains is or was open."""


def note_fluid_domains(bpy: ModuleType, frame: int) -> None:
    """Take note of the fluid domains of the open file before it is evaluated at a frame; a warning names those of which
    Blender's simulation may abort there, as nothing can once it has."""
    domains = [(source.name, modifier.domain_settings) for source in bpy.data.objects for modifier in _domains(source)]
    if domains:
        _temporary_folders.add(Path(bpy.app.tempdir))
    for name, settings in domains:
        if frame > settings.cache_frame_start:
            logger.warning(
                'Object "%s": Blender as a module may abort as it evaluates this fluid domain after frame %d; if it '
                "does, render the file in Blender itself (blender -b), or delete the domain",
                name,
                settings.cache_frame_start,
            )


def _domains(source: Any) -> list[Any]:
    fluids = [modifier for modifier in source.modifiers if modifier.type == "FLUID"]
    return [modifier for modifier in fluids if modifier.fluid_type == "DOMAIN"]


def end_before_blender_aborts(status: int) -> None:
    """End the process with an exit status where Blender's module would abort as it is taken down; otherwise return."""
    if not _temporary_folders:
        return
    for folder in _temporary_folders:
        if folder.name.startswith("blender_"):  # and not the system's own, where Blender could make none
            shutil.rmtree(folder, ignore_errors=True)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)

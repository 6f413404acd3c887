# SPDX-License-Identifier: GPL-3.0-or-later
"""Fluid domains in Blender as a module, which aborts as it ends, and where it evaluates a simulation again."""

import contextlib
import logging
import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

logger = logging.getLogger(__name__)

_temporary_folders: set[Path] = set()
"""Blender's temporary folders while a file with fluid domains is or was open."""
_named: set[tuple[str, str]] = set()
"""Files and their domains that a warning has named."""


@contextlib.contextmanager
def gas_left_out(bpy: ModuleType) -> Iterator[None]:
    """A with block in which files are opened without evaluating their gas domains, as Blender's module aborts as it
    frees one that it has evaluated after its first frame. Their smoke and fire are left out, with a warning."""

    @bpy.app.handlers.persistent
    def leave_out(*_: object) -> None:
        for source in bpy.data.objects:
            for modifier in _domains(source):
                if modifier.domain_settings.domain_type == "GAS":
                    modifier.show_render = modifier.show_viewport = False

    bpy.app.handlers.load_post.append(leave_out)
    try:
        yield
    finally:
        bpy.app.handlers.load_post.remove(leave_out)


def note_fluid_domains(bpy: ModuleType, frame: int) -> None:
    """Take note of the fluid domains of the open file before it is evaluated at a frame; a warning names once each of
    gas, and each of liquid of which Blender's simulation may abort there, as nothing can once it has."""
    domains = [(source.name, modifier.domain_settings) for source in bpy.data.objects for modifier in _domains(source)]
    if domains:
        _temporary_folders.add(Path(bpy.app.tempdir))
    for name, settings in domains:
        key = bpy.data.filepath, name
        if settings.domain_type == "GAS" and key not in _named:
            _named.add(key)
            logger.warning(
                'Object "%s": smoke and fire are left out, as Blender as a module cannot free them; render the file in '
                "Blender itself (blender -b)",
                name,
            )
        if settings.domain_type != "GAS" and frame > settings.cache_frame_start and key not in _named:
            _named.add(key)
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

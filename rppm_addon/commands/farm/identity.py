# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells one RPPM from another, so that the workers of a farm all render alike."""

import hashlib
import importlib.metadata
from pathlib import Path

import rppm_addon

from ...gl.programs.sources import SHADER_FOLDER

_SUFFIXES = (".py", ".npz", ".glsl", ".comp", ".vert", ".frag", ".geom")


def identity() -> str:
    """Version of the RPPM that this process runs, and eight digits of a digest of its files and shaders."""
    package = Path(rppm_addon.__file__).resolve().parent
    digest = hashlib.sha256()
    for folder in (package, SHADER_FOLDER):
        for path in sorted(folder.rglob("*")):
            if path.suffix in _SUFFIXES and (folder == SHADER_FOLDER or SHADER_FOLDER not in path.parents):
                digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return f"{importlib.metadata.version('rppm-addon')}+{digest.hexdigest()[:8]}"

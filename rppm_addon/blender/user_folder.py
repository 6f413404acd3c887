# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder that Blender gives the add-on for a user's files: the log, reports and, of an extension, programs."""

import os
from pathlib import Path

import bpy

from ..gl.programs.binary_cache import VARIABLE

_EXTENSIONS = "bl_ext"
_programs = ""
"""Folder of compiled programs that this module has chosen; empty where it has not."""


def is_extension() -> bool:
    """Whether Blender has loaded the add-on as an extension, which keeps its files in a folder of its own."""
    return __package__.split(".")[0] == _EXTENSIONS


def user_folder() -> Path:
    """The extension's own folder or, from source, one among Blender's data files. It need not exist."""
    if is_extension():
        return Path(bpy.utils.extension_path_user(".".join(__package__.split(".")[:3])))
    return Path(bpy.utils.user_resource("DATAFILES", path="rppm"))


def register() -> None:
    """Have an extension's compiled programs kept in its own folder, unless the environment names another one.

    Blender deletes that folder with the extension. Processes that Blender starts take the same.
    """
    global _programs
    if is_extension() and VARIABLE not in os.environ:
        _programs = os.environ[VARIABLE] = str(user_folder() / "programs")


def unregister() -> None:
    """Leave the environment as it was."""
    global _programs
    if _programs and os.environ.get(VARIABLE) == _programs:
        del os.environ[VARIABLE]
    _programs = ""

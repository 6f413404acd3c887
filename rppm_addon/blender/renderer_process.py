# SPDX-License-Identifier: GPL-3.0-or-later
"""The one renderer process of this Blender."""

import importlib.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import bpy

if TYPE_CHECKING:
    from ..session.client import RendererProcess

_MODULES = ("numpy", "moderngl", "glcontext")
"""What the process imports besides this package."""
_process: "RendererProcess | None" = None


def root_package() -> str:
    """The name under which Blender knows the extension: bl_ext.REPOSITORY.rppm, or rppm_addon from source."""
    return __package__.rpartition(".rppm_addon")[0] or "rppm_addon"


def missing_modules() -> list[str]:
    """Modules that the process needs and Python does not find; nothing is imported."""
    return [name for name in _MODULES if importlib.util.find_spec(name) is None]


def log_path() -> Path:
    """The file that the process logs to, in a folder that is the user's own."""
    try:
        folder = bpy.utils.extension_path_user(root_package(), create=True)
    except ValueError:  # registered from source
        folder = bpy.utils.user_resource("DATAFILES", path="rppm", create=True)
    return Path(folder) / "renderer.log"


def shared() -> "RendererProcess":
    """The process that all sessions share; made here, started by whoever needs it."""
    global _process
    if _process is None:
        from ..session.client import RendererProcess

        # Blender's Python is told with -I to ignore the environment, so folders are handed on.
        specifications = [importlib.util.find_spec(name) for name in _MODULES]
        folders = dict.fromkeys(
            str(
                Path(found.origin).parent if found.submodule_search_locations is None else Path(found.origin).parents[1]
            )
            for found in specifications
            if found is not None
        )
        _process = RendererProcess([sys.executable, *bpy.app.python_args], list(folders), log_path())
    return _process


def existing() -> "RendererProcess | None":
    """The process, if anything has asked for it yet."""
    return _process


def release() -> None:
    """End the process, if there is one; shared() makes a new one."""
    global _process
    if _process is not None:
        _process.close()
        _process = None

# SPDX-License-Identifier: GPL-3.0-or-later
"""Where Open Image Denoise may be found: beside Blender, in the wheel pyoidn, or where the user says."""

import enum
import importlib.util
import os
import sys
import sysconfig
from dataclasses import dataclass
from pathlib import Path

VARIABLE = "RPPM_OIDN"
"""The environment variable that names the library's file."""
LIBRARY_NAME = "OpenImageDenoise.dll" if sys.platform == "win32" else "libOpenImageDenoise.so.2"
REMEDY = (
    "take a Blender from blender.org, which brings it, install the package pyoidn (pip install rppm-addon[denoise]), "
    f"or name the file of {LIBRARY_NAME} in the add-on's preferences or the environment variable {VARIABLE}"
)
"""Advice to users where no library is found."""


class Source(enum.Enum):
    """Whom the library comes from; the value is what users read."""

    BLENDER = "Blender"
    WHEEL = "the package pyoidn"
    PATH = "the chosen path"


@dataclass(frozen=True)
class LibraryPlace:
    """A file that is taken for the library."""

    source: Source
    path: Path


def library_places(blender_folder: Path | None = None, chosen: str = "") -> list[LibraryPlace]:
    """The files there are, in the order in which they are tried. Nothing is loaded.

    Args:
        blender_folder: of Blender's program, where one runs; else the bpy module's is looked for.
        chosen: the file that the user names; "" is what RPPM_OIDN names, if anything. It need not be there.
    """
    places = []
    folder = blender_folder or _module_folder("bpy")
    if folder is not None and (path := _first_file([folder / part / LIBRARY_NAME for part in _beside_program()])):
        places.append(LibraryPlace(Source.BLENDER, path))
    wheel = _module_folder("pyoidn")
    if wheel is not None and (path := _first_file([wheel / "oidn" / part / LIBRARY_NAME for part in ("lib", "bin")])):
        places.append(LibraryPlace(Source.WHEEL, path))
    if chosen := chosen or os.environ.get(VARIABLE, ""):
        places.append(LibraryPlace(Source.PATH, Path(chosen)))
    return places


def _beside_program() -> list[str]:
    """Folders of libraries seen from Blender's: the official builds', then those of a system's packages."""
    multiarch = sysconfig.get_config_var("MULTIARCH")
    return ["lib", "blender.shared", "../lib64", "../lib", *([f"../lib/{multiarch}"] if multiarch else [])]


def _module_folder(name: str) -> Path | None:
    """A package's folder, without importing it."""
    try:
        found = importlib.util.find_spec(name)
    except (ImportError, ValueError):
        return None
    return Path(found.origin).parent if found is not None and found.origin else None


def _first_file(paths: list[Path]) -> Path | None:
    return next((path for path in paths if path.is_file()), None)

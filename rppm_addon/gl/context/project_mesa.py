# SPDX-License-Identifier: GPL-3.0-or-later
"""A newer Mesa than the system's, in a folder of the project's own, for machines without a GPU.

``make setup`` unpacks it (.ci/unpack_mesa.py). Its libraries are loaded by their paths before the context opens: for
whatever asks for them by name later, libglvnd first of all, the dynamic linker takes those that are there already. So
no environment variable is needed, which would have to be set before a process starts and would reach its children.
"""

import ctypes
import functools
import logging
import os
import platform
import sys
from collections.abc import Mapping
from pathlib import Path

from ...scene.errors import DeviceError

log = logging.getLogger(__name__)

VARIABLE = "RPPM_MESA"
"""Environment variable: another folder to take Mesa from, or SYSTEM."""
SYSTEM = "system"
FOLDER = Path(__file__).resolve().parents[3] / ".mesa"
"""Beside rppm_addon in a checkout; an installed extension has none."""
RELEASE_FILE = "release"
"""In the folder: the system that its libraries were built for, as ``system_release`` names it."""

_LIBRARIES = ("libdrm.so.2", "libdrm_*.so.?", "libgallium-*.so", "libgbm.so.1", "libEGL_mesa.so.0")
"""Patterns of file names, each after what it needs."""
_GPU_FILES = ("dri/renderD*", "nvidia[0-9]*", "nvidiactl", "kfd", "dxg")
_CHOICES = ("LIBGL_DRIVERS_PATH", "__EGL_VENDOR_LIBRARY_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS")
"""Environment variables by which users choose a driver."""


def has_gpu(devices: Path = Path("/dev")) -> bool:
    """Whether a GPU's driver has put its files there."""
    return any(any(devices.glob(pattern)) for pattern in _GPU_FILES)


def system_release() -> str:
    """The system's name and version, such as "debian 12"; empty where it is unknown."""
    try:
        release = platform.freedesktop_os_release()
    except OSError:
        return ""
    return f"{release['ID']} {release.get('VERSION_ID', '')}".strip()


def libraries(folder: Path) -> list[Path]:
    """Mesa's libraries in a folder, in the order in which to load them; empty unless all are there."""
    for library_folder in sorted(folder.glob("usr/lib/*/")):
        found = [sorted(library_folder.glob(pattern)) for pattern in _LIBRARIES]
        if all(found):
            return [path for paths in found for path in paths]
    return []


def is_unpacked(folder: Path) -> bool:
    """Whether a folder has a whole Mesa for this system; one that is being unpacked is not whole."""
    try:
        return (folder / RELEASE_FILE).read_text(encoding="utf-8").strip() == system_release() != ""
    except OSError:
        return False


def choose_folder(
    environment: Mapping[str, str] = os.environ, devices: Path = Path("/dev"), default: Path = FOLDER
) -> Path | None:
    """The folder to take Mesa from; None for the system's, which whoever has a GPU or has chosen a driver keeps.

    Raises DeviceError when the environment names a folder that has no Mesa for this system.
    """
    named = environment.get(VARIABLE, "")
    if named == SYSTEM or has_gpu(devices) or any(environment.get(name) for name in _CHOICES):
        return None
    folders = filter(None, environment.get("LD_LIBRARY_PATH", "").split(os.pathsep))
    if any(Path(folder, "libEGL_mesa.so.0").exists() for folder in folders):
        return None
    folder = Path(named) if named else default
    if is_unpacked(folder) and libraries(folder):
        return folder.resolve()
    if named:
        raise DeviceError(
            f"{VARIABLE} names {named}, which has no Mesa for this system; "
            f"name one that make setup unpacked, or {VARIABLE}={SYSTEM}"
        )
    return None


@functools.cache
def load_project_mesa() -> Path | None:
    """Have this process use the chosen folder's Mesa from its first context on.

    Returns the folder, or None where it is the system's. Raises DeviceError as choose_folder does.
    """
    folder = choose_folder() if sys.platform.startswith("linux") else None
    if folder is None:
        return None
    paths = libraries(folder)
    loaded = [path.name for path in paths if _is_loaded(path.name)]
    if loaded:
        log.warning("the Mesa of %s is not used: the process has loaded %s already", folder, ", ".join(loaded))
        return None
    try:
        for path in paths:
            ctypes.CDLL(str(path))
    except OSError as error:
        log.warning("the Mesa of %s cannot be used (%s); delete the folder and run make setup", folder, error)
        return None
    return folder


def _is_loaded(name: str) -> bool:
    try:
        ctypes.CDLL(name, mode=os.RTLD_NOLOAD | os.RTLD_LAZY)
    except OSError:
        return False
    return True

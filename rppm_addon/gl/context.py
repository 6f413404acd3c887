# SPDX-License-Identifier: GPL-3.0-or-later
"""The offscreen OpenGL context and what its device can do."""

import ctypes
import functools
import logging
import os
import re
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..scene.errors import DeviceError
from .devices import device_names
from .project_mesa import load_project_mesa
from .requirements import NEEDS, refuse_small_devices

log = logging.getLogger(__name__)

REQUIRED_VERSION = 430
_LIMITS = (
    "GL_MAX_SHADER_STORAGE_BLOCK_SIZE",
    *NEEDS,
    "GL_MAX_COMPUTE_WORK_GROUP_COUNT",
    "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS",
    "GL_MAX_TEXTURE_SIZE",
    "GL_MAX_VIEWPORT_DIMS",
)
_NUM_PROGRAM_BINARY_FORMATS = 0x87FE
_AVAILABLE_KIBIBYTES = {"GL_NVX_gpu_memory_info": 0x9049, "GL_ATI_meminfo": 0x87FC}


@dataclass
class DeviceInformation:
    """What was found: names, OpenGL version, limits by their GL names, and what is missing."""

    name: str
    driver: str
    version: str
    limits: dict[str, Any] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)
    driver_folder: str = ""
    """Where the driver was loaded from, if it is not the system's."""
    devices: list[str] = field(default_factory=list)
    """Names of all that EGL lists, by their numbers."""

    @property
    def label(self) -> str:
        """Device and driver's version: where both are the same, so are pictures bit for bit."""
        # The driver is its vendor, OpenGL's version, maybe the profile in brackets, and its own version.
        return f"{self.name}, {re.sub(r'^.*?[0-9]+[.][0-9.]+ (?:[(].*?[)] )?', '', self.driver, count=1)}"


class Context:
    """An offscreen context of OpenGL 4.3 core: EGL on Linux, WGL on Windows."""

    def __init__(self, gl: Any, information: DeviceInformation, device: str | None = None) -> None:
        self.moderngl = gl
        self._device = device
        self.information = information
        self.limits = information.limits

    @classmethod
    def create(cls, device: str | None = None) -> "Context":
        """Open a context.

        ``device`` is an EGL device number as text; None takes the environment variable
        RPPM_DEVICE, then the driver's default. Raises DeviceError saying what to install, or what the device
        has too little of.
        """
        import moderngl

        if sys.platform == "darwin":
            raise DeviceError("macOS stops at OpenGL 4.1; RPPM needs 4.3: use Linux or Windows")
        mesa = load_project_mesa()
        options: dict[str, Any] = {}
        device = device if device is not None else os.environ.get("RPPM_DEVICE", "")
        if sys.platform.startswith("linux"):
            options["backend"] = "egl"
            if device:
                if not device.isdigit():
                    raise DeviceError(
                        f"device {device!r} is not a number; give the EGL device number, 0 being the first"
                    )
                options["device_index"] = int(device)
        try:
            gl = moderngl.create_context(standalone=True, require=REQUIRED_VERSION, **options)
        except Exception as error:  # moderngl raises bare Exception
            raise DeviceError(
                f"no OpenGL 4.3 context could be opened ({error}); install a driver with EGL "
                "(Debian: libegl1 libegl-mesa0 libgl1-mesa-dri libgl1) or choose another device"
            ) from error
        info = gl.info
        information = DeviceInformation(
            name=info["GL_RENDERER"],
            driver=f"{info['GL_VENDOR']} {info['GL_VERSION']}",
            version=f"{gl.version_code // 100}.{gl.version_code % 100 // 10}",
            limits={name: info[name] for name in _LIMITS if name in info},
            driver_folder=str(mesa or ""),
            devices=device_names(),
        )
        try:
            refuse_small_devices(information.name, information.limits)
        except DeviceError:
            gl.release()
            raise
        context = cls(gl, information, device)
        if not context.has_program_binaries:
            information.missing.append("program binaries (programs are compiled at every start)")
        if context.is_software:
            information.missing.append("a GPU (Mesa renders on the processor)")
        log.info("device %s, %s %s", information.name, information.driver, information.driver_folder)
        return context

    def another(self) -> "Context":
        """Open another context of the same device, for the calling thread. Raises DeviceError."""
        return Context.create(self._device)

    @functools.cached_property
    def is_software(self) -> bool:
        """Whether the driver draws on the processor, where GL timer queries mean nothing."""
        return any(name in self.information.name.lower() for name in ("llvmpipe", "softpipe", "swrast"))

    @property
    def storage_block_limit(self) -> int:
        """Bytes that one storage block may span."""
        return int(str(self.limits["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"]))

    def function(self, name: str, result: Any, *arguments: Any) -> Any:
        """A GL function that moderngl does not wrap, as a ctypes function; None if the driver lacks it."""
        if sys.platform.startswith("linux"):
            library = ctypes.CDLL("libEGL.so.1")
            resolve, prototype = library.eglGetProcAddress, ctypes.CFUNCTYPE
        else:
            library = ctypes.WinDLL("opengl32.dll")
            resolve, prototype = library.wglGetProcAddress, ctypes.WINFUNCTYPE
        resolve.restype = ctypes.c_void_p
        resolve.argtypes = [ctypes.c_char_p]
        address = resolve(name.encode())
        return prototype(result, *arguments)(address) if address else None

    @property
    def has_program_binaries(self) -> bool:
        """Whether the driver hands out compiled programs."""
        return self.integers(_NUM_PROGRAM_BINARY_FORMATS)[0] > 0

    @property
    def available_memory(self) -> int | None:
        """Bytes that the device has left by its driver's word; None where the driver does not tell."""
        if self.is_software:
            try:
                lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
            except OSError:
                return None
            return next((int(line.split()[1]) << 10 for line in lines if line.startswith("MemAvailable:")), None)
        for extension, name in _AVAILABLE_KIBIBYTES.items():
            if extension in self.moderngl.extensions:
                return self.integers(name)[0] << 10
        return None

    def integers(self, name: int) -> list[int]:
        """glGetIntegerv of up to four numbers."""
        values = (ctypes.c_int * 4)()
        get_integer = self.function("glGetIntegerv", None, ctypes.c_uint, ctypes.POINTER(ctypes.c_int))
        if get_integer is None:  # Windows resolves GL 1.1 functions from the library itself
            get_integer = ctypes.WinDLL("opengl32.dll").glGetIntegerv  # type: ignore[attr-defined]
        get_integer(name, values)
        return list(values)

    def barrier(self) -> None:
        """Order everything written before against everything read after."""
        self.moderngl.memory_barrier()

    def finish(self) -> None:
        """Wait until the device has done all it was given."""
        self.moderngl.finish()

    def seconds_of(self, work: Callable[[], object]) -> float:
        """Seconds from an idle device until it has done what ``work`` gives it, by the wall clock."""
        self.finish()
        start = time.perf_counter()
        work()
        self.finish()
        return time.perf_counter() - start

    def release(self) -> None:
        """Close the context; nothing made in it may be used any more."""
        self.moderngl.release()


def device_information(device: str | None = None) -> DeviceInformation:
    """Open a context, describe its device, and close it. Raises DeviceError."""
    context = Context.create(device)
    try:
        return context.information
    finally:
        context.release()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The offscreen OpenGL context and what its device can do."""

import ctypes
import dataclasses
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

from ...processors import usable_cores
from ...scene.errors import DeviceError
from .devices import Choice, Device, choose, list_devices
from .driver_errors import OUT_OF_MEMORY, DriverErrors
from .kernel_devices import DeviceKind
from .losses import LossWatch
from .project_mesa import load_project_mesa
from .requirements import NEEDS, refuse_small_devices

log = logging.getLogger(__name__)

REQUIRED_VERSION = 430
_LIMITS = (
    "GL_MAX_SHADER_STORAGE_BLOCK_SIZE",
    "GL_MAX_TEXTURE_BUFFER_SIZE",
    *NEEDS,
    "GL_MAX_COMPUTE_WORK_GROUP_COUNT",
    "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS",
    "GL_MAX_TEXTURE_SIZE",
    "GL_MAX_VIEWPORT_DIMS",
)
_NUM_PROGRAM_BINARY_FORMATS, _MAX_TEXTURE_BUFFER_SIZE, _MAX_VERTEX_IMAGE_UNIFORMS = 0x87FE, 0x8C2B, 0x90CA
TEXEL_SIZE = 16
"""Bytes of a texel, at most."""
_MIN_TEXEL_SIZE = 4
LARGEST_BUFFER = (1 << 32) - TEXEL_SIZE
"""Bytes that shaders and drivers count in 32 bits."""
_AVAILABLE_KIBIBYTES = {"GL_NVX_gpu_memory_info": 0x9049, "GL_ATI_meminfo": 0x87FC}
_DEDICATED_KIBIBYTES = 0x9047
"""Name of the dedicated memory, in KiB, in GL_NVX_gpu_memory_info."""
_VARIABLE = "RPPM_DEVICE"
_MAX_DRIVER_THREADS = 32
"""Threads that llvmpipe has at most (LP_MAX_THREADS)."""
_MULTI_BIND_VERSION = 440
_NO_ADDRESSES = frozenset((1, 2, 3, ctypes.c_void_p(-1).value))
"""Addresses that some of Windows' drivers return in place of 0 (khronos.org/opengl/wiki/Load_OpenGL_Functions)."""
_REMEDY = (
    "install a driver with EGL (Debian: libegl1 libegl-mesa0 libgl1-mesa-dri libgl1), let this user open /dev/dri, or "
    "choose another device"
)
_REMEDY_ON_WINDOWS = (
    "install the driver of the graphics card's maker, as Windows' own ends at OpenGL 1.1; over Remote Desktop start "
    "Blender at the machine itself"
)
_SHARING = frozenset((DeviceKind.INTEGRATED, DeviceKind.SOFTWARE))
"""Kinds whose memory is the processor's."""


@dataclass
class DeviceInformation:
    """Facts about an opened device: names, OpenGL version, limits by their GL names, and what is missing."""

    name: str
    driver: str
    version: str
    limits: dict[str, Any] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)
    driver_folder: str = ""
    """Where the driver was loaded from, if it is not the system's."""
    number: int | None = None
    """EGL's, of ``devices``; None where it does not list them."""
    devices: list[Device] = field(default_factory=list)
    """All that EGL lists, by their numbers; of others than this one what is known without opening them."""
    warnings: list[str] = field(default_factory=list)
    """Why it is not the device that was wished for."""

    @property
    def kind(self) -> str:
        """A DeviceKind."""
        return DeviceKind.UNKNOWN if self.number is None else self.devices[self.number].kind

    @property
    def label(self) -> str:
        """Device and driver's version: where both are the same, so are pictures bit for bit."""
        return f"{self.name}, {driver_version(self.driver)}"


class Context:
    """An offscreen context of OpenGL 4.3 core: EGL on Linux, WGL on Windows."""

    def __init__(self, gl: Any, information: DeviceInformation) -> None:
        self.moderngl = gl
        self.information = information
        self.limits = information.limits
        self.large_buffers = 0
        """Buffers of now that are larger than a storage block may be, or texel buffers of one word each."""

    @classmethod
    def create(cls, device: str | None = None) -> "Context":
        """Open a context.

        ``device`` says which (devices.choose); None takes the environment variable RPPM_DEVICE. Raises DeviceError
        saying what to install, or what the device has too little of.
        """
        if sys.platform == "darwin":
            raise DeviceError("macOS stops at OpenGL 4.1; RPPM needs 4.3: use Linux or Windows")
        mesa = load_project_mesa()
        wish = device if device is not None else os.environ.get(_VARIABLE, "")
        devices = list_devices()
        if sys.platform.startswith("linux"):
            context = cls._open_first(choose(wish, devices), devices)
        else:
            context = cls._open(None, devices)
            if wish:
                log.warning("%s says %s, but Windows chooses the device: see docs/settings.md", _VARIABLE, wish)
        information = context.information
        information.driver_folder = str(mesa or "")
        if not context.has_program_binaries:
            information.missing.append("program binaries (programs are compiled at every start)")
        if context.is_software:
            information.missing.append("a GPU (Mesa renders on the processor)")
        for text in information.warnings:
            log.warning("%s", text)
        log.info("device %s, %s %s", information.name, information.driver, information.driver_folder)
        return context

    @classmethod
    def _open_first(cls, choice: Choice, devices: list[Device]) -> "Context":
        """The first of the chosen devices that can be opened, or EGL's own choice where it lists none."""
        if not choice.devices:
            return cls._open(None, devices)
        failures: list[str] = []
        for device in choice.devices:
            try:
                context = cls._open(device, devices)
            except DeviceError as error:
                failures.append(str(error))
                continue
            instead = f"rendering on {context.information.name} instead; choose another device"
            if choice.is_missing:
                context.information.warnings.append(f"the device {choice.wish} is not there: {instead}")
            elif failures:
                context.information.warnings.append(f"{'; '.join(failures)}: {instead}")
            return context
        raise DeviceError("; ".join(failures))

    @classmethod
    def _open(cls, device: Device | None, devices: list[Device]) -> "Context":
        import moderngl

        options: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
        if device is not None:
            options["device_index"] = device.number
        try:
            gl = moderngl.create_context(standalone=True, require=REQUIRED_VERSION, **options)
        except Exception as error:  # moderngl raises bare Exception
            of = f" on {device.label}" if device is not None else ""
            remedy = _REMEDY_ON_WINDOWS if sys.platform == "win32" else _REMEDY
            raise DeviceError(f"no OpenGL 4.3 context could be opened{of} ({error}); {remedy}") from error
        info = gl.info
        information = DeviceInformation(
            name=info["GL_RENDERER"],
            driver=f"{info['GL_VENDOR']} {info['GL_VERSION']}",
            version=f"{gl.version_code // 100}.{gl.version_code % 100 // 10}",
            limits={name: info[name] for name in _LIMITS if name in info},
            number=None if device is None else device.number,
            devices=devices,
        )
        try:
            refuse_small_devices(information.name, information.limits)
        except DeviceError:
            gl.release()
            raise
        context = cls(gl, information)
        if device is not None:
            device.name, device.driver = short_name(information.name), driver_version(information.driver)
            device.memory = context.memory or device.memory
        return context

    def another(self) -> "Context":
        """Open another context of the same device, for the calling thread. Raises DeviceError."""
        number = self.information.number
        return Context.create("" if number is None else str(number))

    @functools.cached_property
    def is_software(self) -> bool:
        """Whether the driver draws on the processor, where GL timer queries mean nothing."""
        return any(name in self.information.name.lower() for name in ("llvmpipe", "softpipe", "swrast"))

    @functools.cached_property
    def driver_threads(self) -> int:
        """Number of threads to which llvmpipe gives the groups of a dispatch; 0 of other drivers."""
        if not self.is_software:
            return 0
        told = os.environ.get("LP_NUM_THREADS", "")
        return min(int(told) if told.isdigit() else usable_cores(), _MAX_DRIVER_THREADS)

    @functools.cached_property
    def has_multi_bind(self) -> bool:
        """True where one call of the driver binds several images (OpenGL 4.4, GL_ARB_multi_bind)."""
        gl = self.moderngl
        return gl.version_code >= _MULTI_BIND_VERSION or "GL_ARB_multi_bind" in gl.extensions

    @property
    def storage_block_limit(self) -> int:
        """Bytes that one storage block may span."""
        return min(int(self.limits["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"]), LARGEST_BUFFER)

    @functools.cached_property
    def max_texels(self) -> int:
        """Texels that one texel buffer may span."""
        return self.integers(_MAX_TEXTURE_BUFFER_SIZE)[0]

    @property
    def whole_limit(self) -> int:
        """Bytes that a buffer may have for every program to take all of it at once."""
        return min(self.storage_block_limit, _MIN_TEXEL_SIZE * self.max_texels)

    @functools.cached_property
    def vertex_images(self) -> int:
        """Images that a vertex shader may read."""
        return self.integers(_MAX_VERTEX_IMAGE_UNIFORMS)[0]

    def array_limit(self, texel_bytes: int | None) -> int:
        """Bytes of an array that is texels of so many bytes where it is larger than a storage block; None: never."""
        return max(self.storage_block_limit, min((texel_bytes or 0) * self.max_texels, LARGEST_BUFFER))

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
        if address and address not in _NO_ADDRESSES:
            return prototype(result, *arguments)(address)
        if sys.platform.startswith("linux") or not hasattr(library, name):
            return None
        return prototype(result, *arguments)((name, library))  # of GL 1.1, in the library itself on Windows

    @property
    def has_program_binaries(self) -> bool:
        """Whether the driver hands out compiled programs."""
        return self.integers(_NUM_PROGRAM_BINARY_FORMATS)[0] > 0

    @property
    def memory(self) -> int | None:
        """Bytes that the device has, its own or the processor's; None where the driver does not report it."""
        if self.is_software or self.information.kind in _SHARING:
            return _memory_of_processor("MemTotal")
        if "GL_NVX_gpu_memory_info" in self.moderngl.extensions:
            return self.integers(_DEDICATED_KIBIBYTES)[0] << 10
        return None

    @property
    def available_memory(self) -> int | None:
        """Bytes that the device has left by its driver's word; None where the driver does not report it."""
        if self.is_software or self.information.kind in _SHARING:
            # What the drivers of integrated devices report is what the firmware keeps aside, often 256 MiB.
            return _memory_of_processor("MemAvailable")
        for extension, name in _AVAILABLE_KIBIBYTES.items():
            if extension in self.moderngl.extensions:
                return self.integers(name)[0] << 10
        return None

    def integers(self, name: int) -> list[int]:
        """glGetIntegerv of up to four numbers."""
        values = (ctypes.c_int * 4)()
        get_integer = self.function("glGetIntegerv", None, ctypes.c_uint, ctypes.POINTER(ctypes.c_int))
        get_integer(name, values)
        return list(values)

    def barrier(self) -> None:
        """Order everything written before against everything read after."""
        self.moderngl.memory_barrier()

    def finish(self) -> None:
        """Wait until the device has done all it was given. Raises DeviceLostError where it was reset."""
        self.moderngl.finish()
        self._losses.check()

    @functools.cached_property
    def _errors(self) -> DriverErrors:
        return DriverErrors(self.function)

    @functools.cached_property
    def _losses(self) -> LossWatch:
        gl = self.moderngl
        return LossWatch(self.function, self._errors, gl.version_code, gl.extensions)

    def seconds_of(self, work: Callable[[], object]) -> float:
        """Seconds from an idle device until it has done what ``work`` gives it, by the wall clock."""
        self.finish()
        start = time.perf_counter()
        work()
        self.finish()
        return time.perf_counter() - start

    @property
    def lacks_memory(self) -> bool:
        """Whether the driver had none left for what it was given since this was asked last, which moderngl does not
        ask it: a buffer is without memory then, and what is to be in it is lost."""
        return self._errors.take(OUT_OF_MEMORY)

    def refuse_lost_memory(self) -> None:
        """Raise DeviceError where the device lacks memory: some allocate it only as they draw."""
        if self.lacks_memory:
            raise DeviceError(
                f"the device {self.information.name} has run out of memory; lower the resolution or the photons, "
                "simplify the scene, or close what else uses the device"
            )

    def release(self) -> None:
        """Close the context; nothing made in it may be used any more."""
        self.moderngl.release()


def _memory_of_processor(name: str) -> int | None:
    """Bytes of a line of /proc/meminfo."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
    except OSError:
        return None
    return next((int(line.split()[1]) << 10 for line in lines if line.startswith(f"{name}:")), None)


def short_name(name: str) -> str:
    """A device's name without what drivers say of themselves behind it in brackets."""
    return re.sub(r"(\s*[(]([^()]*,.*|LLVM.*)[)]|(/PCIe)?/SSE2)$", "", name) or name


def driver_version(driver: str) -> str:
    """The version that a driver gives itself, such as Mesa 25.0.7."""
    # The driver is its vendor, OpenGL's version, maybe the profile in brackets, and its own version.
    return re.sub(r"^.*?[0-9]+[.][0-9.]+ (?:[(].*?[)] )?", "", driver, count=1)


def device_information(device: str | None = None) -> DeviceInformation:
    """Open a context, describe its device, and close it. Raises DeviceError."""
    context = Context.create(device)
    try:
        return context.information
    finally:
        context.release()


def open_others(devices: list[Device], number: int | None) -> list[Device]:
    """The devices, each opened for a moment but that of a number, with what their drivers report or why they fail.

    Another context is the calling thread's afterwards than was before.
    """
    known = []
    for device in devices:
        if device.number != number:
            try:
                device = device_information(str(device.number)).devices[device.number]
            except DeviceError as error:
                device = dataclasses.replace(device, problem=str(error))
        known.append(device)
    return known

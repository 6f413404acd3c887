# SPDX-License-Identifier: GPL-3.0-or-later
"""The EGL devices of this machine, and which of them a user's words mean (RPPM_DEVICE)."""

import contextlib
import ctypes
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ...scene.common.quantities import bytes_text
from ...scene.errors import DeviceError
from .kernel_devices import DeviceKind, kernel_device
from .project_mesa import load_project_mesa

_EXTENSIONS, _DRM_FILE, _RENDER_FILE, _RENDERER = 0x3055, 0x3233, 0x3377, 0x335F
_UUID = 0x335C
_MOST = 64


@dataclass
class Device:
    """A device as far as it is known: what only an open context knows is added later."""

    number: int
    """EGL's, from 0."""
    identity: str
    """The same whatever else is plugged in; without a space."""
    kind: str
    """A DeviceKind."""
    name: str
    driver: str = ""
    """The kernel's; once it was opened, OpenGL's."""
    memory: int | None = None
    """Bytes of its own, or those that it shares with the processor."""
    problem: str = ""
    """Why it cannot be opened, if that was tried."""

    @property
    def label(self) -> str:
        """One line: name, kind, memory, driver, and what is wrong with it."""
        memory = ""
        if self.memory is not None:
            is_shared = self.kind in {DeviceKind.INTEGRATED, DeviceKind.SOFTWARE}
            memory = f"{bytes_text(self.memory)}{' of the processor' if is_shared else ''}"
        kind = "" if self.kind == DeviceKind.UNKNOWN else self.kind
        problem = f"cannot be used: {self.problem}" if self.problem else ""
        facts = ", ".join(filter(None, (kind, memory, self.driver, problem)))
        return f"{self.name} ({facts})" if facts else self.name


class _Egl:
    """EGL's functions for devices. Raises LookupError where it has none."""

    def __init__(self) -> None:
        try:
            library = ctypes.CDLL("libEGL.so.1")
        except OSError as error:
            raise LookupError(error) from error
        self._resolve = library.eglGetProcAddress
        self._resolve.restype, self._resolve.argtypes = ctypes.c_void_p, [ctypes.c_char_p]
        integer, pointer = ctypes.c_int, ctypes.c_void_p
        integers = ctypes.POINTER(integer)
        self._list = self._function(b"eglQueryDevicesEXT", ctypes.c_uint, integer, ctypes.POINTER(pointer), integers)
        self._string = self._function(b"eglQueryDeviceStringEXT", ctypes.c_char_p, pointer, integer)

    def _function(self, name: bytes, *types: type) -> Callable:
        address = self._resolve(name)
        if not address:
            raise LookupError(name)
        return ctypes.CFUNCTYPE(*types)(address)

    def devices(self) -> list[int]:
        """Handles, in the order of their numbers."""
        found, count = (ctypes.c_void_p * _MOST)(), ctypes.c_int(0)
        there = self._list(_MOST, found, ctypes.byref(count))
        return [handle for handle in found[: count.value] if handle is not None] if there else []

    def text(self, device: int, name: int) -> str:
        """A string of a device; empty where there is none."""
        with contextlib.suppress(UnicodeDecodeError):
            return (self._string(device, name) or b"").decode()
        return ""

    def uuid(self, device: int) -> str:
        """Return the UUID of EGL_EXT_device_persistent_id, in hexadecimal; empty where there is none."""
        types = (ctypes.c_uint, ctypes.c_void_p, ctypes.c_int, ctypes.c_int, ctypes.c_char_p)
        with contextlib.suppress(LookupError):
            query = self._function(b"eglQueryDeviceBinaryEXT", *types, ctypes.POINTER(ctypes.c_int))
            value, size = ctypes.create_string_buffer(16), ctypes.c_int(0)
            if query(device, _UUID, len(value), value, ctypes.byref(size)):
                return value.raw[: size.value].hex()
        return ""


def list_devices() -> list[Device]:
    """The devices by their numbers, none of them opened; none where EGL does not list them, as on Windows."""
    if not sys.platform.startswith("linux"):
        return []
    load_project_mesa()
    try:
        egl = _Egl()
    except LookupError:
        return []
    return [_described(egl, number, device) for number, device in enumerate(egl.devices())]


def _described(egl: _Egl, number: int, device: int) -> Device:
    extensions = egl.text(device, _EXTENSIONS).split()
    name = egl.text(device, _RENDERER) if "EGL_EXT_device_query_name" in extensions else ""
    if "EGL_MESA_device_software" in extensions:
        return Device(number, DeviceKind.SOFTWARE.value, DeviceKind.SOFTWARE, name or "Mesa on the processor")
    files = (("EGL_EXT_device_drm_render_node", _RENDER_FILE), ("EGL_EXT_device_drm", _DRM_FILE))
    for extension, which in files:
        file = egl.text(device, which) if extension in extensions else ""
        known = kernel_device(file) if file else None
        if known is not None:
            name = name or f"{known.maker} device {known.identity.partition('@')[0]}".strip()
            return Device(number, known.identity, known.kind, name, known.driver, known.memory)
    # NVIDIA's driver has no file where its part for displays is not loaded.
    uuid = egl.uuid(device) if "EGL_EXT_device_persistent_id" in extensions else ""
    kind = DeviceKind.DISCRETE if "EGL_NV_device_cuda" in extensions else DeviceKind.UNKNOWN
    return Device(number, f"uuid@{uuid}" if uuid else str(number), kind, name or f"EGL device {number}")


@dataclass(frozen=True)
class Choice:
    """Devices in the order in which to try them, and what to say where they are not what was wished for."""

    devices: list[Device]
    wish: str = ""
    """Device wished for where any other will do, in the user's words; empty: no wish, or only that device will do."""
    is_missing: bool = False
    """Whether what was wished for is not there."""


_SOFTWARE_VARIABLE = "LIBGL_ALWAYS_SOFTWARE"
"""Environment variable of Mesa: where it is true, Mesa opens nothing but its software device."""
_RANKS = {DeviceKind.DISCRETE: 0, DeviceKind.UNKNOWN: 1, DeviceKind.INTEGRATED: 2, DeviceKind.VIRTUAL: 3}


def choose(text: str, devices: Sequence[Device]) -> Choice:
    """Choose devices by a user's words: "" cards before the rest, a number, an identity, or a kind.

    With ``?`` behind it, any other will do where that is not there; what follows the ``?`` is its name for messages.
    Then a card that has moved to another place of its bus is found as well, if it is the only one of its make.
    Raises DeviceError where there is no such device and it must be that.
    """
    hardware = sorted((d for d in devices if d.kind != DeviceKind.SOFTWARE), key=lambda d: _RANKS[DeviceKind(d.kind)])
    software = [d for d in devices if d.kind == DeviceKind.SOFTWARE]
    is_forced = software and os.environ.get(_SOFTWARE_VARIABLE, "").lower() in {"1", "true", "yes"}
    automatic = software if is_forced or not hardware else hardware
    wanted, mark, name = text.partition("?")
    if not wanted:
        return Choice(automatic)
    found = [d for d in devices if wanted in {str(d.number), d.identity, d.kind}]
    if not mark:
        if not found:
            there = "; ".join(f"{d.number} or {d.identity}: {d.label}" for d in devices) or "EGL lists none"
            raise DeviceError(f"there is no device {text!r}; choose one of those that there are ({there})")
        return Choice(found)
    if not found and "@" in wanted:
        made = wanted.partition("@")[0]
        alike = [d for d in devices if d.identity.partition("@")[0] == made]
        found = alike if len({d.identity for d in alike}) == 1 and made not in {"uuid", "platform"} else []
    others = [d for d in automatic if d not in found]
    return Choice([*found, *others], f"{name} ({wanted})" if name else wanted, not found)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The EGL devices of this machine, whose numbers choose one (RPPM_DEVICE)."""

import contextlib
import ctypes
import sys

_EXTENSIONS, _DRM_FILE, _RENDERER = 0x3055, 0x3233, 0x335F
_MOST = 64


def device_names() -> list[str]:
    """A name for each EGL device, in the order of their numbers; none where EGL does not list them, as on Windows."""
    if not sys.platform.startswith("linux"):
        return []
    try:
        egl = ctypes.CDLL("libEGL.so.1")
    except OSError:
        return []
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    egl.eglGetProcAddress.argtypes = [ctypes.c_char_p]
    list_address = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    ask_address = egl.eglGetProcAddress(b"eglQueryDeviceStringEXT")
    if not list_address or not ask_address:
        return []
    integer, pointer = ctypes.c_int, ctypes.c_void_p
    query = ctypes.CFUNCTYPE(ctypes.c_uint, integer, ctypes.POINTER(pointer), ctypes.POINTER(integer))(list_address)
    ask = ctypes.CFUNCTYPE(ctypes.c_char_p, pointer, integer)(ask_address)
    devices, count = (pointer * _MOST)(), integer(0)
    if not query(_MOST, devices, ctypes.byref(count)):
        return []

    def text(device: object, name: int) -> str:
        with contextlib.suppress(UnicodeDecodeError):
            return (ask(device, name) or b"").decode()
        return ""

    found = []
    for device in devices[: count.value]:
        extensions = text(device, _EXTENSIONS).split()
        name = text(device, _RENDERER) if "EGL_EXT_device_query_name" in extensions else ""
        if not name and "EGL_MESA_device_software" in extensions:
            name = "Mesa on the processor"
        elif not name and "EGL_EXT_device_drm" in extensions:
            name = text(device, _DRM_FILE)
        found.append(name or "unnamed")
    return found

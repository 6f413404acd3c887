# SPDX-License-Identifier: GPL-3.0-or-later
"""Open Image Denoise 2 by its C interface (include/OpenImageDenoise/oidn.h), on the processor or a GPU."""

import contextlib
import ctypes
import os
import sys
import threading
from ctypes import POINTER, c_bool, c_char_p, c_int, c_size_t, c_void_p
from pathlib import Path

import numpy as np

from ..processors import usable_cores
from ..scene.errors import DenoiserError
from ..scene.settings import DenoisingQuality

_DEVICE_CPU = 1
_FORMAT_FLOAT3 = 3
_QUALITIES = {DenoisingQuality.HIGH: 6, DenoisingQuality.BALANCED: 5, DenoisingQuality.FAST: 4}
_FAST_SINCE = 20300
"""The version that has OIDN_QUALITY_FAST, as oidnGetDeviceInt tells versions."""
_IMAGE = (c_void_p, c_char_p, c_void_p, c_int, *[c_size_t] * 5)
_COPY = (c_void_p, c_size_t, c_size_t, c_void_p)
_FUNCTIONS = {
    "oidnGetNumPhysicalDevices": (c_int,),
    "oidnGetPhysicalDeviceInt": (c_int, c_int, c_char_p),
    "oidnGetPhysicalDeviceString": (c_char_p, c_int, c_char_p),
    "oidnNewDeviceByID": (c_void_p, c_int),
    "oidnNewBuffer": (c_void_p, c_void_p, c_size_t),
    "oidnWriteBuffer": (None, *_COPY),
    "oidnReadBuffer": (None, *_COPY),
    "oidnReleaseBuffer": (None, c_void_p),
    "oidnSetFilterImage": (None, *_IMAGE),
    "oidnNewDevice": (c_void_p, c_int),
    "oidnSetDeviceInt": (None, c_void_p, c_char_p, c_int),
    "oidnSetDeviceBool": (None, c_void_p, c_char_p, c_bool),
    "oidnGetDeviceInt": (c_int, c_void_p, c_char_p),
    "oidnGetDeviceError": (c_int, c_void_p, POINTER(c_char_p)),
    "oidnCommitDevice": (None, c_void_p),
    "oidnReleaseDevice": (None, c_void_p),
    "oidnNewFilter": (c_void_p, c_void_p, c_char_p),
    "oidnSetSharedFilterImage": (None, *_IMAGE),
    "oidnSetFilterBool": (None, c_void_p, c_char_p, c_bool),
    "oidnSetFilterInt": (None, c_void_p, c_char_p, c_int),
    "oidnCommitFilter": (None, c_void_p),
    "oidnExecuteFilter": (None, c_void_p),
    "oidnReleaseFilter": (None, c_void_p),
}
"""Functions that are called, by name: the types of the result and of the arguments."""


class OpenImageDenoise:
    """The library, opened, with its device. One thread at a time computes; others wait."""

    def __init__(self, path: str | Path, threads: int = 0, use_gpu: bool = False, copies_images: bool = False) -> None:
        """Load the library and begin to use its device.

        Args:
            path: the file of libOpenImageDenoise.so.2 or OpenImageDenoise.dll; what it loads lies beside it.
            threads: to compute with; 0 is as many as this process may run on.
            use_gpu: whether the first GPU that the library knows computes, where it knows one.
            copies_images: whether images are copied to memory of the device, as is always done for a GPU.

        Raises:
            DenoiserError: there is no such file, it is another library or version, or does not run here.
        """
        self.path = Path(path)
        self._calls = _loaded(self.path)
        self._lock = threading.Lock()
        gpus = self._gpus() if use_gpu else []
        self.device_name = gpus[0][1] if gpus else "the processor"
        self._copies_images = bool(gpus) or copies_images
        if gpus:
            self._device = self._calls["oidnNewDeviceByID"](gpus[0][0])
        else:
            self._device = self._calls["oidnNewDevice"](_DEVICE_CPU)
        self._check(f"cannot be used on {self.device_name}")  # without a device as well
        if not gpus:
            self._calls["oidnSetDeviceInt"](self._device, b"numThreads", threads or usable_cores())
            # Else it would bind its threads, and the one that calls, to processors that the renderer uses too.
            self._calls["oidnSetDeviceBool"](self._device, b"setAffinity", False)
        self._calls["oidnCommitDevice"](self._device)
        self._check(f"cannot use {self.device_name}")
        self._number: int = self._calls["oidnGetDeviceInt"](self._device, b"version")
        if self._number // 10000 != 2:
            self.release()
            raise DenoiserError(f"{self.path} is version {self.version} of Open Image Denoise; take one of version 2")

    def _gpus(self) -> list[tuple[int, str]]:
        """Return numbers and names of the GPUs that the library can use, the fastest first."""
        call = self._calls
        numbers = range(call["oidnGetNumPhysicalDevices"]())
        found = [number for number in numbers if call["oidnGetPhysicalDeviceInt"](number, b"type") != _DEVICE_CPU]
        names = (call["oidnGetPhysicalDeviceString"](number, b"name") or b"a GPU" for number in found)
        return [(number, name.decode(errors="replace")) for number, name in zip(found, names, strict=True)]

    @property
    def version(self) -> str:
        """As in 2.3.3."""
        return f"{self._number // 10000}.{self._number // 100 % 100}.{self._number % 100}"

    def filter(
        self, images: dict[str, np.ndarray], quality: DenoisingQuality, hdr: bool = False, clean_features: bool = False
    ) -> np.ndarray:
        """Denoise the first of the images.

        Args:
            images: (height, width, 3) each, by the names of the filter RT: "color", which "albedo" and "normal" may
                guide, or one of these alone.
            quality: how much time it may take.
            hdr: whether color goes beyond 1.
            clean_features: whether albedo and normal are without noise.

        Returns:
            (height, width, 3) float32.

        Raises:
            DenoiserError: the library cannot do it; its own words are in the message.
        """
        arrays = {name: np.ascontiguousarray(image, np.float32) for name, image in images.items()}
        height, width = next(iter(arrays.values())).shape[:2]
        arrays["output"] = np.empty((height, width, 3), np.float32)
        with self._lock, contextlib.ExitStack() as held:
            call = self._calls
            filter_ = call["oidnNewFilter"](self._device, b"RT")
            held.callback(call["oidnReleaseFilter"], filter_)
            shape = width, height, 0, 0, 0  # neither offset nor gaps
            buffers = self._copied(arrays, held) if self._copies_images else {}
            for name, array in arrays.items():
                if name in buffers:
                    call["oidnSetFilterImage"](filter_, name.encode(), buffers[name], _FORMAT_FLOAT3, *shape)
                else:
                    address = array.ctypes.data
                    call["oidnSetSharedFilterImage"](filter_, name.encode(), address, _FORMAT_FLOAT3, *shape)
            if "color" in arrays:
                call["oidnSetFilterBool"](filter_, b"hdr", hdr)
                call["oidnSetFilterBool"](filter_, b"cleanAux", clean_features)
            call["oidnSetFilterInt"](filter_, b"quality", self._quality(quality))
            call["oidnCommitFilter"](filter_)
            call["oidnExecuteFilter"](filter_)
            if buffers:
                output = arrays["output"]
                call["oidnReadBuffer"](buffers["output"], 0, output.nbytes, output.ctypes.data)
            self._check("cannot denoise the picture")
        return arrays["output"]

    def _copied(self, arrays: dict[str, np.ndarray], held: contextlib.ExitStack) -> dict[str, int]:
        """Return buffers of the device that hold images, by name, until the stack is closed."""
        buffers = {}
        for name, array in arrays.items():
            buffers[name] = self._calls["oidnNewBuffer"](self._device, array.nbytes)
            self._check("has too little memory on its device")
            held.callback(self._calls["oidnReleaseBuffer"], buffers[name])
            if name != "output":
                self._calls["oidnWriteBuffer"](buffers[name], 0, array.nbytes, array.ctypes.data)
        return buffers

    def _quality(self, quality: DenoisingQuality) -> int:
        if quality is DenoisingQuality.FAST and self._number < _FAST_SINCE:
            quality = DenoisingQuality.BALANCED
        return _QUALITIES[quality]

    def _check(self, failure: str) -> None:
        """Raise DenoiserError if anything has gone wrong since it was asked last."""
        message = c_char_p()
        if self._calls["oidnGetDeviceError"](self._device, ctypes.byref(message)):
            reason = (message.value or b"it does not say why").decode(errors="replace")
            raise DenoiserError(f"{self.path} {failure} ({reason}); turn Denoise off, or try another library")

    def release(self) -> None:
        """Give the device back; the library stays loaded."""
        if self._device:
            self._calls["oidnReleaseDevice"](self._device)
            self._device = None


def _loaded(path: Path) -> dict:
    """The library's functions by name."""
    if not path.is_file():
        raise DenoiserError(f"{path} is not there; name the file of an Open Image Denoise library of version 2")
    try:
        if sys.platform == "win32":
            os.add_dll_directory(str(path.parent))
        library = ctypes.CDLL(str(path))
        calls = {name: getattr(library, name) for name in _FUNCTIONS}
    except OSError as error:
        raise DenoiserError(f"{path} cannot be loaded ({error}); name another Open Image Denoise library") from error
    except AttributeError as error:
        raise DenoiserError(f"{path} is no Open Image Denoise library of version 2 ({error}); name one") from error
    for name, (result, *arguments) in _FUNCTIONS.items():
        calls[name].restype, calls[name].argtypes = result, arguments
    return calls

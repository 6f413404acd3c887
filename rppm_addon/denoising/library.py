# SPDX-License-Identifier: GPL-3.0-or-later
"""Open Image Denoise 2 by its C interface (include/OpenImageDenoise/oidn.h), computing on the processor."""

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
_FUNCTIONS = {
    "oidnNewDevice": (c_void_p, c_int),
    "oidnSetDeviceInt": (None, c_void_p, c_char_p, c_int),
    "oidnSetDeviceBool": (None, c_void_p, c_char_p, c_bool),
    "oidnGetDeviceInt": (c_int, c_void_p, c_char_p),
    "oidnGetDeviceError": (c_int, c_void_p, POINTER(c_char_p)),
    "oidnCommitDevice": (None, c_void_p),
    "oidnReleaseDevice": (None, c_void_p),
    "oidnNewFilter": (c_void_p, c_void_p, c_char_p),
    "oidnSetSharedFilterImage": (None, c_void_p, c_char_p, c_void_p, c_int, *[c_size_t] * 5),
    "oidnSetFilterBool": (None, c_void_p, c_char_p, c_bool),
    "oidnSetFilterInt": (None, c_void_p, c_char_p, c_int),
    "oidnCommitFilter": (None, c_void_p),
    "oidnExecuteFilter": (None, c_void_p),
    "oidnReleaseFilter": (None, c_void_p),
}
"""Functions that are called, by name: the types of the result and of the arguments."""


class OpenImageDenoise:
    """The library, opened, with its device. One thread at a time computes; others wait."""

    def __init__(self, path: str | Path, threads: int = 0) -> None:
        """Load the library and begin to use the processor.

        Args:
            path: the file of libOpenImageDenoise.so.2 or OpenImageDenoise.dll; what it loads lies beside it.
            threads: to compute with; 0 is as many as this process may run on.

        Raises:
            DenoiserError: there is no such file, it is another library or version, or does not run here.
        """
        self.path = Path(path)
        self._calls = _loaded(self.path)
        self._lock = threading.Lock()
        self._device = self._calls["oidnNewDevice"](_DEVICE_CPU)
        self._check("cannot be used on this processor")  # without a device as well
        self._calls["oidnSetDeviceInt"](self._device, b"numThreads", threads or usable_cores())
        # Else it would bind its threads, and the one that calls, to processors that the renderer uses too.
        self._calls["oidnSetDeviceBool"](self._device, b"setAffinity", False)
        self._calls["oidnCommitDevice"](self._device)
        self._check("cannot use the processor")
        self._number: int = self._calls["oidnGetDeviceInt"](self._device, b"version")
        if self._number // 10000 != 2:
            self.release()
            raise DenoiserError(f"{self.path} is version {self.version} of Open Image Denoise; take one of version 2")

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
        with self._lock:
            call = self._calls
            filter_ = call["oidnNewFilter"](self._device, b"RT")
            for name, array in arrays.items():
                address = array.ctypes.data
                shape = width, height, 0, 0, 0  # neither offset nor gaps
                call["oidnSetSharedFilterImage"](filter_, name.encode(), address, _FORMAT_FLOAT3, *shape)
            if "color" in arrays:
                call["oidnSetFilterBool"](filter_, b"hdr", hdr)
                call["oidnSetFilterBool"](filter_, b"cleanAux", clean_features)
            call["oidnSetFilterInt"](filter_, b"quality", self._quality(quality))
            call["oidnCommitFilter"](filter_)
            call["oidnExecuteFilter"](filter_)
            call["oidnReleaseFilter"](filter_)
            self._check("cannot denoise the picture")
        return arrays["output"]

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

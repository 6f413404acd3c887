# SPDX-License-Identifier: GPL-3.0-or-later
"""Linked programs kept on disk, where the driver offers program binaries."""

import ctypes
import hashlib
import logging
import os
import struct
import sys
import tempfile
from pathlib import Path

from .context import Context

log = logging.getLogger(__name__)

_PROGRAM_BINARY_LENGTH = 0x8741
_LINK_STATUS = 0x8B82


def cache_folder() -> Path:
    """Where binaries are kept: RPPM_CACHE, or the platform's cache folder of the user."""
    if "RPPM_CACHE" in os.environ:
        return Path(os.environ["RPPM_CACHE"])
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", tempfile.gettempdir())) / "rppm" / "programs"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rppm" / "programs"


class BinaryCache:
    """Program binaries keyed by device, driver and source text.

    A binary that the driver refuses (after an update, say) is compiled again: nothing is lost.
    """

    def __init__(self, context: Context) -> None:
        self.available = context.has_program_binaries
        if not self.available:
            return
        integers = ctypes.POINTER(ctypes.c_int)
        self._parameter = context.function("glGetProgramiv", None, ctypes.c_uint, ctypes.c_uint, integers)
        self._get = context.function(
            "glGetProgramBinary",
            None,
            ctypes.c_uint,
            ctypes.c_int,
            integers,
            ctypes.POINTER(ctypes.c_uint),
            ctypes.c_void_p,
        )
        self._set = context.function(
            "glProgramBinary", None, ctypes.c_uint, ctypes.c_uint, ctypes.c_void_p, ctypes.c_int
        )
        self.available = None not in (self._parameter, self._get, self._set)
        self._device = f"{context.information.name}\n{context.information.driver}\n"

    def _path(self, text: str) -> Path:
        return cache_folder() / (hashlib.sha256((self._device + text).encode()).hexdigest() + ".bin")

    def holds(self, text: str) -> bool:
        """Whether there is a binary of this source."""
        return self.available and self._path(text).exists()

    def load(self, program: int, text: str) -> bool:
        """Replace the GL program's code by the stored binary of this source; False if there is none."""
        if not self.available:
            return False
        try:
            stored = self._path(text).read_bytes()
        except OSError:
            return False
        if len(stored) <= 4:
            return False
        self._set(program, struct.unpack("<I", stored[:4])[0], stored[4:], len(stored) - 4)
        status = ctypes.c_int(0)
        self._parameter(program, _LINK_STATUS, ctypes.byref(status))
        return bool(status.value)

    def store(self, program: int, text: str) -> None:
        """Keep a linked program; a full or read-only disk only costs the next start's time."""
        if not self.available:
            return
        length = ctypes.c_int(0)
        self._parameter(program, _PROGRAM_BINARY_LENGTH, ctypes.byref(length))
        if length.value <= 0:
            return
        data = (ctypes.c_char * length.value)()
        kind, written = ctypes.c_uint(0), ctypes.c_int(0)
        self._get(program, length.value, ctypes.byref(written), ctypes.byref(kind), data)
        path = self._path(text)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
                file.write(struct.pack("<I", kind.value) + data.raw[: written.value])
            Path(file.name).replace(path)
        except OSError as error:
            log.info("program binary not kept: %s", error)

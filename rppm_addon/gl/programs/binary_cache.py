# SPDX-License-Identifier: GPL-3.0-or-later
"""Linked programs kept on disk, where the driver offers program binaries."""

import contextlib
import ctypes
import hashlib
import logging
import os
import stat
import struct
import sys
import tempfile
from pathlib import Path

from ..context.context import Context

log = logging.getLogger(__name__)

VARIABLE = "RPPM_CACHE"
"""The environment variable that names the folder of binaries."""
_PROGRAM_BINARY_LENGTH = 0x8741
_LINK_STATUS = 0x8B82
_DIGEST_SIZE, _KIND_SIZE = 32, 4
_FORMAT = "digest, kind, binary\n"
"""Format of an entry, part of its key: entries of another format are other entries."""


def cache_folder() -> Path:
    """Where binaries are kept: VARIABLE, or the platform's cache folder of the user, or a temporary one."""
    if VARIABLE in os.environ:
        return Path(os.environ[VARIABLE])
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", tempfile.gettempdir())) / "rppm" / "programs"
    if os.environ.get("XDG_CACHE_HOME"):
        return Path(os.environ["XDG_CACHE_HOME"]) / "rppm" / "programs"
    try:
        return Path.home() / ".cache" / "rppm" / "programs"
    except RuntimeError:  # without HOME, a user that the system has no entry of: in many containers
        return Path(tempfile.gettempdir()) / f"rppm-{os.getuid()}" / "programs"


def pack_entry(key: bytes, kind: int, binary: bytes) -> bytes:
    """Pack the entry of a program: a digest over key and rest, the driver's kind of binary, and the binary."""
    body = struct.pack("<I", kind) + binary
    return hashlib.sha256(key + body).digest() + body


def unpack_entry(key: bytes, entry: bytes) -> tuple[int, bytes] | None:
    """Kind and binary of what was written for this key; None where it is another's, or is not whole."""
    digest, body = entry[:_DIGEST_SIZE], entry[_DIGEST_SIZE:]
    if len(body) <= _KIND_SIZE or digest != hashlib.sha256(key + body).digest():
        return None
    return struct.unpack("<I", body[:_KIND_SIZE])[0], body[_KIND_SIZE:]


def _is_trusted(status: os.stat_result) -> bool:
    """Whether only the user, or root, has written what drivers will run."""
    if sys.platform == "win32":  # where folders below the user's are the user's
        return True
    return status.st_uid in (os.getuid(), 0) and not status.st_mode & stat.S_IWOTH


class BinaryCache:
    """Program binaries keyed by device, driver and source text.

    A binary that the driver refuses (after an update, say) is compiled again: nothing is lost. So is one that lies
    where another's should, is not whole, or may be of another user: drivers believe what they are given.
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

        folder = cache_folder()
        with contextlib.suppress(FileNotFoundError):
            if self.available and not _is_trusted(folder.stat()):
                log.warning("%s is another user's, or all may write to it: programs are not kept there", folder)
                self.available = False

    def _key(self, text: str) -> bytes:
        return hashlib.sha256((_FORMAT + self._device + text).encode()).digest()

    def _path(self, text: str) -> Path:
        return cache_folder() / f"{self._key(text).hex()}.bin"

    def holds(self, text: str) -> bool:
        """Whether there is a binary of this source."""
        return self.available and self._path(text).exists()

    def load(self, program: int, text: str) -> bool:
        """Replace the GL program's code by the stored binary of this source; False if there is none."""
        if not self.available:
            return False
        try:
            with self._path(text).open("rb") as file:
                entry = unpack_entry(self._key(text), file.read()) if _is_trusted(os.fstat(file.fileno())) else None
        except OSError:
            return False
        if entry is None:
            log.warning("%s is not what was kept there: the program is compiled again", self._path(text))
            return False
        kind, binary = entry
        self._set(program, kind, binary, len(binary))
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
        try:
            _write(self._path(text), pack_entry(self._key(text), kind.value, data.raw[: written.value]))
        except OSError as error:
            log.info("program binary not kept: %s", error)


def _write(path: Path, entry: bytes) -> None:
    """Whole or not at all, for no other user to change."""
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    temporary = None
    try:
        with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
            temporary = Path(file.name)
            file.write(entry)
        # Closed, with what a full disk has to say of the rest: Windows renames and removes nothing that is open.
        temporary.replace(path)
    except BaseException:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        raise

# SPDX-License-Identifier: GPL-3.0-or-later
"""Blocks of memory that two processes share, without names that could outlive them.

The standard library's shared_memory is not used: it leaves files in /dev/shm when processes are killed, starts a
process beside Blender to clear up after it (below Python 3.13), and takes what it needs from /dev/shm, which is small
in containers and ends in a bus error where it is full.
"""

import contextlib
import mmap
import os
import re
import secrets
import sys
from pathlib import Path

import numpy as np

if sys.platform != "win32":
    import fcntl

_LABEL = "rppm"
_NAME = re.compile(r"(/proc/\d+/fd/\d+):(\d+)")
_NAME_ON_WINDOWS = re.compile(rf"{_LABEL}-[0-9a-f]{{32}}")
_FILE_MAP_READ = 4


class SharedBlock:
    """Bytes in ``memory`` that the other process sees as well once it has opened the block by its ``name``.

    On Linux the block is a file without a path, which the other process opens by the creator's number for it; the
    memory goes with the last process or array that has it. On Windows the system keeps names, as long as any process
    has the block open: there it can be opened until it is closed, withdrawn or not.
    """

    def __init__(self, name: str, memory: mmap.mmap, file: int | None = None) -> None:
        self.name = name
        self.memory = memory
        self._file = file

    @classmethod
    def create(cls, size: int) -> "SharedBlock":
        """A new block of zeros, to be withdrawn or closed. Raises OSError when there is not so much memory."""
        if sys.platform == "win32":
            name = f"{_LABEL}-{secrets.token_hex(16)}"
            return cls(name, mmap.mmap(-1, size, tagname=name))
        file = os.memfd_create(_LABEL, os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
        try:
            os.ftruncate(file, size)
            fcntl.fcntl(file, fcntl.F_ADD_SEALS, fcntl.F_SEAL_SHRINK)
            return cls(f"/proc/{os.getpid()}/fd/{file}:{os.fstat(file).st_ino}", mmap.mmap(file, size), file)
        except BaseException:
            os.close(file)
            raise

    @classmethod
    def open(cls, name: str, size: int) -> "SharedBlock":
        """A block that the other process has created.

        Raises FileNotFoundError when it has been withdrawn, and ValueError or OSError when it is none.
        """
        if type(size) is not int or size <= 0:  # a mapping of 0 bytes is one of all there are
            raise ValueError(f"a block of {size!r} bytes")
        if sys.platform == "win32":
            return cls(name, _opened_on_windows(name, size))
        match = _NAME.fullmatch(name)
        if match is None:
            raise ValueError(f"{name} names no shared memory")
        path, identity = match.groups()
        if not str(Path(path).readlink()).startswith(f"/memfd:{_LABEL} "):
            raise FileNotFoundError(f"{name} is something else now")
        file = os.open(path, os.O_RDWR | os.O_CLOEXEC | os.O_NONBLOCK)
        try:
            status = os.fstat(file)
            if status.st_ino != int(identity):
                raise FileNotFoundError(f"{name} is another block now")
            if status.st_size < size:
                raise ValueError(f"{name} has less than {size} bytes")
            # To read what was cut off ends a process.
            if not fcntl.fcntl(file, fcntl.F_GET_SEALS) & fcntl.F_SEAL_SHRINK:
                raise ValueError(f"{name} may become smaller while it is read")
            return cls(name, mmap.mmap(file, size))
        finally:
            os.close(file)

    def write(self, offset: int, array: np.ndarray) -> None:
        """Put a contiguous array's bytes there; quicker than through ``memory``, which is cleared page by page first.

        Raises OSError when there is not so much memory.
        """
        data = array.reshape(-1).view(np.uint8).data
        if self._file is None:
            self.memory[offset : offset + len(data)] = data
            return
        while data:
            written = os.pwrite(self._file, data, offset)
            data, offset = data[written:], offset + written

    def withdraw(self) -> None:
        """Let nobody open the block any more; who has it open keeps it. May be called more than once."""
        file, self._file = self._file, None
        if file is not None:
            os.close(file)

    def close(self) -> None:
        """Withdraw it, and give the memory back now, unless arrays still lie in it: then it goes with the last."""
        self.withdraw()
        with contextlib.suppress(BufferError):
            self.memory.close()


if sys.platform == "win32":
    import _winapi

    def _opened_on_windows(name: str, size: int) -> mmap.mmap:
        """The block of a name, which mmap alone would make where there is none. Raises as SharedBlock.open does."""
        if _NAME_ON_WINDOWS.fullmatch(name) is None:
            raise ValueError(f"{name} names no shared memory")
        block = _winapi.OpenFileMapping(_FILE_MAP_READ, False, name)  # FileNotFoundError where it is no more
        try:
            return mmap.mmap(-1, size, tagname=name)  # PermissionError where it has less bytes
        finally:
            _winapi.CloseHandle(block)

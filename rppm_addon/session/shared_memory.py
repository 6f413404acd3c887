# SPDX-License-Identifier: GPL-3.0-or-later
"""Blocks of memory that two processes share.

The standard library's shared_memory is not used: its resource tracker starts a process of its own beside Blender
(below Python 3.13) and it does not reserve what it creates, so that a full /dev/shm ends in a bus error.
"""

import contextlib
import mmap
import os
import secrets
import sys
import tempfile
from pathlib import Path

PREFIX = "rppm-"
_FOLDERS = (Path("/dev/shm"), Path(tempfile.gettempdir()))


class SharedBlock:
    """Bytes in ``memory`` that whoever opens the block by ``name`` sees as well.

    On Linux a block is a file. It is unlinked as soon as both sides have it open, so that no end of a process leaves
    anything behind; the memory lives until the last array in it is gone. On Windows names vanish by themselves.
    """

    def __init__(self, name: str, memory: mmap.mmap) -> None:
        self.name = name
        self.memory = memory

    @classmethod
    def create(cls, size: int) -> "SharedBlock":
        """A new block of zeros. Raises OSError when there is not so much memory."""
        name = f"{PREFIX}{os.getpid()}-{secrets.token_hex(8)}"
        if sys.platform == "win32":
            return cls(name, mmap.mmap(-1, size, tagname=name))
        for last, folder in enumerate(_FOLDERS, 1 - len(_FOLDERS)):
            path = folder / name
            try:
                return cls(str(path), _map_new_file(path, size))
            except OSError:  # a container's /dev/shm is often small
                path.unlink(missing_ok=True)
                if last == 0:
                    raise
        raise AssertionError

    @classmethod
    def open(cls, name: str, size: int) -> "SharedBlock":
        """A block that the other process has created. Raises OSError or ValueError when there is none such."""
        if sys.platform == "win32":
            return cls(name, mmap.mmap(-1, size, tagname=name))
        path = Path(name)
        if not path.name.startswith(PREFIX) or path.parent not in _FOLDERS:
            raise ValueError(f"{name} is no block of shared memory")
        file = os.open(path, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW)
        try:
            if os.fstat(file).st_size < size:
                raise ValueError(f"{name} has less than {size} bytes")
            return cls(name, mmap.mmap(file, size))
        finally:
            os.close(file)

    def unlink(self) -> None:
        """Take the name away; who has the block open keeps it. May be called on both sides and more than once."""
        if sys.platform != "win32":
            Path(self.name).unlink(missing_ok=True)

    def close(self) -> None:
        """Give the memory back now, unless arrays still lie in it: then it goes with the last of them."""
        with contextlib.suppress(BufferError):
            self.memory.close()


def _map_new_file(path: Path, size: int) -> mmap.mmap:
    file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
    try:
        os.posix_fallocate(file, 0, size)
        return mmap.mmap(file, size)
    finally:
        os.close(file)


def remove_leftovers() -> None:
    """Unlink blocks whose creator was killed before the other side had opened them."""
    if sys.platform == "win32":
        return
    for path in (path for folder in _FOLDERS for path in folder.glob(f"{PREFIX}*")):
        creator = path.name.removeprefix(PREFIX).partition("-")[0]
        if creator.isdigit() and not _is_running(int(creator)):
            with contextlib.suppress(OSError):
                path.unlink()


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # another user's
        pass
    return True

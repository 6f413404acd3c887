# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are there whole or not at all, whatever ends the process or fills the disk; and what is no file."""

import contextlib
import os
import platform
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

_LONGEST_STEM, _LONGEST_MACHINE = 24, 80
"""Bytes of the file's and of the machine's own name that a temporary name has: systems allow 255 in all, and Windows
260 letters of the whole path, so it should not be much longer than the name that it becomes."""
_TRIES, _BETWEEN_TRIES_SECONDS = 20, 0.1
"""To replace a file on Windows while something else, such as a picture viewer or virus scanner, has it open."""
_SYNCHRONIZE, _IS_RUNNING, _NO_SUCH_PROCESS = 0x100000, 0x102, 87
"""Windows': a right, an answer and an error."""


def is_no_file(path: Path) -> bool:
    """Whether something else has this name, such as a device or a pipe, at which readers wait."""
    return path.exists() and not path.is_file()


@contextlib.contextmanager
def renamed_when_whole(path: str | Path) -> Iterator[str]:
    """A temporary name in the folder of ``path``, which is made, that becomes ``path`` when all went well and its bytes
    are on the disk. What killed processes left of earlier tries is removed. Raises OSError."""
    path = Path(path)
    temporary: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        start = f".{_start_of(path.stem, _LONGEST_STEM)}.{_start_of(platform.node(), _LONGEST_MACHINE)}-"
        _remove_left(path.parent, start, path.suffix)
        handle, name = tempfile.mkstemp(prefix=f"{start}{os.getpid()}-", suffix=path.suffix, dir=path.parent)
        temporary = Path(name)
        os.close(handle)
        yield name
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(0o666 & ~mask)
        with temporary.open("r+b") as file:
            os.fsync(file.fileno())
        replace(temporary, path)
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def replace(made: Path, path: Path) -> None:
    """Give a file the name of another, which it replaces. Raises OSError.

    Windows refuses while anybody has the other one open, which mostly is soon over.
    """
    for _ in range(_TRIES - 1 if sys.platform == "win32" else 0):
        with contextlib.suppress(PermissionError):
            made.replace(path)
            return
        time.sleep(_BETWEEN_TRIES_SECONDS)
    made.replace(path)


def _start_of(name: str, longest: int) -> str:
    return os.fsencode(name)[:longest].decode(errors="ignore")


def _remove_left(folder: Path, start: str, suffix: str) -> None:
    """Remove temporary files of this machine's processes that are no more; those of others may be in use."""
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        left = [entry.name for entry in entries if entry.name.startswith(start) and entry.name.endswith(suffix)]
        for name in left:
            process, dash, _ = name.removeprefix(start).partition("-")
            if dash and process.isdecimal() and not _lives(int(process)):
                (folder / name).unlink(missing_ok=True)


if sys.platform == "win32":
    import _winapi

    def _lives(process: int) -> bool:  # os.kill would end it
        try:
            handle = _winapi.OpenProcess(_SYNCHRONIZE, False, process)
        except OSError as error:
            return error.winerror != _NO_SUCH_PROCESS
        try:
            return _winapi.WaitForSingleObject(handle, 0) == _IS_RUNNING
        finally:
            _winapi.CloseHandle(handle)

else:

    def _lives(process: int) -> bool:
        try:
            os.kill(process, 0)
        except (ProcessLookupError, OverflowError):
            return False
        except OSError:
            return True
        return True

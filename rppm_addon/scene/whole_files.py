# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are there whole or not at all, whatever ends the process or fills the disk; and what is no file."""

import contextlib
import os
import platform
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

_LONGEST_START = 80
"""Bytes of the file's and of the machine's own name that a temporary name has: systems allow 255 in all."""


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
        start = f".{_start_of(path.stem)}.{_start_of(platform.node())}-"
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
        temporary.replace(path)
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _start_of(name: str) -> str:
    return name.encode(errors="surrogateescape")[:_LONGEST_START].decode(errors="ignore")


def _remove_left(folder: Path, start: str, suffix: str) -> None:
    """Remove temporary files of this machine's processes that are no more; those of others may be in use."""
    if sys.platform == "win32":  # where asking for a process ends it
        return
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        left = [entry.name for entry in entries if entry.name.startswith(start) and entry.name.endswith(suffix)]
        for name in left:
            process, dash, _ = name.removeprefix(start).partition("-")
            if dash and process.isdecimal() and not _lives(int(process)):
                (folder / name).unlink(missing_ok=True)


def _lives(process: int) -> bool:
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True

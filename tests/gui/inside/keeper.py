# SPDX-License-Identifier: GPL-3.0-or-later
"""The first process of the chroot's namespaces: starts programs as it is told, and all end with it.

Requests are lines of JSON on stdin, answers lines of JSON on stdout; it leaves when stdin ends.
"""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

SAMPLE_SECONDS = 0.03
"""From one look at a process to the next."""

started: dict[str, subprocess.Popen] = {}


def start(name: str, command: list[str], environment: dict[str, str], log: str) -> dict:
    """Start a program; its output goes to ``log``."""
    with open(log, "wb") as output:
        started[name] = subprocess.Popen(
            command, env=os.environ | environment, stdin=subprocess.DEVNULL, stdout=output, stderr=output
        )
    return {"pid": started[name].pid}


def run(command: list[str], environment: dict[str, str], seconds: float) -> dict:
    """Run a program to its end; ``status`` is None where it took longer than ``seconds``."""
    try:
        done = subprocess.run(
            command, env=os.environ | environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=seconds
        )
    except subprocess.TimeoutExpired as expired:
        return {"status": None, "output": f"{_text(expired.stdout)}{_text(expired.stderr)}"}
    return {"status": done.returncode, "output": f"{_text(done.stdout)}{_text(done.stderr)}"}


def wait(name: str, seconds: float) -> dict:
    """The exit status of a started program; None while it still runs after ``seconds``."""
    try:
        return {"status": started[name].wait(seconds)}
    except subprocess.TimeoutExpired:
        return {"status": None}


def kill(pid: int) -> dict:
    """Kill a process at once."""
    os.kill(pid, signal.SIGKILL)
    return {}


def processes() -> dict:
    """Command lines of the active by process number, this one left out."""
    found = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdecimal() and folder.name != str(os.getpid()):
            try:
                state = (folder / "stat").read_text().rpartition(")")[2].split()[0]
                command = (folder / "cmdline").read_bytes().rstrip(b"\0").split(b"\0")
            except OSError:
                continue  # it has just ended
            if state != "Z":
                found[folder.name] = [_text(word) for word in command]
    return {"processes": found}


def shared_memory() -> dict:
    """Names in /dev/shm, and of RPPM's blocks where that is too small."""
    return {"names": sorted(os.listdir("/dev/shm")) + [path.name for path in Path("/tmp").glob("rppm*")]}


def resources(folders: list[str]) -> dict:
    """Return the resources of each active process, in bytes and numbers, and the bytes of the files in ``folders``."""
    found = {}
    for pid, command in processes()["processes"].items():
        place = Path("/proc", pid)
        with contextlib.suppress(OSError):  # it has just ended
            status = dict(line.split(":", 1) for line in (place / "status").read_text().splitlines())
            handles = [handle for handle in (place / "fd").iterdir() if handle.is_symlink()]
            found[pid] = {
                "command": command,
                "resident": 1024 * int(status["VmRSS"].split()[0]),
                "anonymous": 1024 * int(status["RssAnon"].split()[0]),
                "threads": int(status["Threads"]),
                "handles": len(handles),
                "shared": {str(block.st_ino): block.st_size for block in map(_memory, handles) if block},
            }
    files = [path for folder in folders for path in Path(folder).rglob("*") if path.is_file()]
    return {"processes": found, "files": {str(path): _size(path) for path in files}}


def _memory(handle: Path) -> os.stat_result | None:
    """Return the status of a handle of shared memory, or None for other handles and those that are gone."""
    try:
        return handle.stat() if os.readlink(handle).startswith("/memfd:") else None
    except OSError:
        return None


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


def busy_share(pid: int, seconds: float) -> dict:
    """Share of moments at which a thread of a process runs or waits for a processor."""
    samples = max(1, round(seconds / SAMPLE_SECONDS))
    busy = 0
    for _ in range(samples):
        states = []
        for stat in Path(f"/proc/{pid}/task").glob("*/stat"):
            with contextlib.suppress(OSError):  # the thread has just ended
                states.append(stat.read_text().rpartition(")")[2].split()[0])
        busy += any(state in "RD" for state in states)
        time.sleep(seconds / samples)
    return {"share": busy / samples}


def _text(data: bytes | None) -> str:
    return (data or b"").decode(errors="replace")


def main() -> None:
    requests = {f.__name__: f for f in (start, run, wait, kill, processes, shared_memory, resources, busy_share)}
    for line in sys.stdin:
        name, arguments = json.loads(line)
        try:
            answer = requests[name](**arguments)
        except Exception as error:
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()

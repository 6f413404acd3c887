# SPDX-License-Identifier: GPL-3.0-or-later
"""A machine in the machine: Debian's Blender, an X server and their tools, in namespaces of their own."""

import json
import os
import queue
import subprocess
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent
DISPLAY = ":1"
START_SECONDS = 30.0


class MachineError(Exception):
    """A program inside the chroot did not do what it should; the message has its output."""


def chroot_folder() -> Path:
    """Where the chroot is kept between runs: RPPM_GUI, or the user's cache folder."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return Path(os.environ.get("RPPM_GUI") or cache / "rppm-gui") / "chroot"


class ChrootMachine:
    """Runs programs inside the chroot; everything ends with ``close``. ``folder`` is their /mnt."""

    def __init__(self, chroot: Path, folder: Path) -> None:
        self.folder = folder
        self._process = subprocess.Popen(
            [HERE / "enter_chroot.sh", chroot, folder, "python3", "/mnt/inside/keeper.py"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._answers: queue.SimpleQueue[str] = queue.SimpleQueue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        for line in self._process.stdout:
            self._answers.put(line)
        self._answers.put("")

    def _ask(self, request: str, patience: float = START_SECONDS, /, **arguments: object) -> dict:
        """Have keeper.py do something; raises MachineError where it fails or does not answer."""
        try:
            self._process.stdin.write(json.dumps([request, arguments]) + "\n")
            self._process.stdin.flush()
            line = self._answers.get(timeout=patience)
        except (OSError, queue.Empty) as error:
            raise MachineError(f"the chroot does not answer to {request} {arguments}") from error
        answer = json.loads(line) if line else {"error": "it has ended"}
        if "error" in answer:
            raise MachineError(f"{request} {arguments} in the chroot: {answer['error']}")
        return answer

    def start(self, name: str, command: Sequence[str], environment: Mapping[str, str] | None = None) -> int:
        """Start a program in the background, its output in ``name``.log; returns its process number."""
        log = f"/mnt/{name}.log"
        return self._ask("start", name=name, command=list(command), environment=dict(environment or {}), log=log)["pid"]

    def run(
        self, command: Sequence[str], environment: Mapping[str, str] | None = None, seconds: float = START_SECONDS
    ) -> str:
        """Run a program to its end and return its output; raises MachineError on failure or after ``seconds``."""
        done = self._ask(
            "run", seconds + START_SECONDS, command=list(command), environment=dict(environment or {}), seconds=seconds
        )
        if done["status"] != 0:
            how = "took too long" if done["status"] is None else f"failed with {done['status']}"
            raise MachineError(f"{' '.join(command)} {how}:\n{done['output'][-8000:]}")
        return done["output"]

    def wait(self, name: str, seconds: float) -> int | None:
        """Exit status of a started program, None while it runs after ``seconds``."""
        return self._ask("wait", seconds + START_SECONDS, name=name, seconds=seconds)["status"]

    def kill(self, pid: int) -> None:
        self._ask("kill", pid=pid)

    def processes(self) -> dict[int, list[str]]:
        """Command lines of the active processes, without keeper.py."""
        return {int(pid): command for pid, command in self._ask("processes")["processes"].items()}

    def shared_memory(self) -> list[str]:
        """Names of the shared memory that exists inside."""
        return self._ask("shared_memory")["names"]

    def resources(self, *folders: str) -> dict[str, dict]:
        """Return the resources of each active process, by its number, and the bytes of files in folders, by path."""
        return self._ask("resources", folders=list(folders))

    def busy_share(self, pid: int, seconds: float) -> float:
        """Share of moments, in the next seconds, at which a thread of a process runs or waits for a processor."""
        return self._ask("busy_share", seconds + START_SECONDS, pid=pid, seconds=seconds)["share"]

    def start_display(self, width: int, height: int) -> None:
        """An X server whose screen has this size; programs find it by ``DISPLAY``."""
        screen = f"{width}x{height}x24"
        self.start("xvfb", ["Xvfb", DISPLAY, "-screen", "0", screen, "-nolisten", "tcp", "-displayfd", "1"])
        log = self.folder / "xvfb.log"
        for _ in range(int(START_SECONDS / 0.1)):
            if log.read_text().splitlines()[-1:] == [DISPLAY.removeprefix(":")]:
                return
            if self.wait("xvfb", 0.1) is not None:
                break
        raise MachineError(f"the X server did not start: {log.read_text()}")

    def screenshot(self, name: str) -> Path:
        """A picture of the whole screen, ``name``.png in the folder."""
        self.run(["import", "-window", "root", "-depth", "8", f"png24:/mnt/{name}.png"], {"DISPLAY": DISPLAY})
        return self.folder / f"{name}.png"

    def press(self, *arguments: object) -> None:
        """Real keys and mouse: arguments of xdotool."""
        self.run(["xdotool", *map(str, arguments)], {"DISPLAY": DISPLAY})

    def close(self) -> None:
        """End all that runs inside."""
        self._process.stdin.close()
        try:
            self._process.wait(10.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait(10.0)
        self._process.stdout.close()

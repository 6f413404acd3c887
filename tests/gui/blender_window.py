# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender window inside the chroot, and what a test does with it."""

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from chroot_machine import DISPLAY, ChrootMachine, MachineError
from PIL import Image

USER_FOLDER = {"BLENDER_USER_RESOURCES": "/mnt/user", "RPPM_CACHE": "/mnt/programs"}
"""Environment of every Blender: folders that the tests of a session share."""

KEY_CODES = {"F12": "96"}
"""Function keys by number: by name xdotool would hold Alt as well."""


class StepError(Exception):
    """A step failed inside Blender, or Blender does not answer."""


class BlenderWindow:
    """Blender with a file open, filling the screen."""

    def __init__(self, machine: ChrootMachine, file: str, width: int, height: int) -> None:
        self.machine = machine
        self.height = height
        self._folder = machine.folder / "agent"
        self._folder.mkdir(exist_ok=True)
        for left in self._folder.iterdir():
            left.unlink()
        command = ["blender", "--offline-mode", "--window-geometry", "0", "0", str(width), str(height)]
        command += ["--python-exit-code", "1", f"/mnt/{file}", "--python", "/mnt/inside/agent.py", "--", "/mnt/agent"]
        self.pid = machine.start("blender", command, USER_FOLDER | {"DISPLAY": DISPLAY})
        self.wait_until("ready", 120.0)

    def log(self) -> str:
        """Return the text that Blender has printed."""
        return (self.machine.folder / "blender.log").read_text(errors="replace")

    def step(self, step: str, seconds: float = 30.0, /, **arguments: Any) -> Any:
        """Do a step of inside/steps.py; raises StepError when it fails or takes longer than ``seconds``."""
        (self._folder / "request.new").write_text(json.dumps([step, arguments]))
        (self._folder / "request.new").rename(self._folder / "request.json")
        answer = self._folder / "answer.json"
        end = time.monotonic() + seconds
        while not answer.exists():
            if (status := self.machine.wait("blender", 0.0)) is not None:
                raise StepError(f"Blender ended with {status} at {step} {arguments}:\n{self.log()[-8000:]}")
            if time.monotonic() > end:
                raise StepError(f"Blender does not answer to {step} {arguments}:\n{self.log()[-8000:]}")
            time.sleep(0.005)
        result = json.loads(answer.read_text())
        answer.unlink()
        if "error" in result:
            raise StepError(f"{step} {arguments} failed in Blender:\n{result['error']}\n{self.log()[-4000:]}")
        return result["result"]

    def wait_until(self, step: str, seconds: float, fits: Callable[[Any], bool] = bool, /, **arguments: Any) -> Any:
        """Repeat a step until its result fits, and return it; raises StepError after ``seconds``."""
        end = time.monotonic() + seconds
        while not fits(result := self.step(step, seconds, **arguments)):
            if time.monotonic() > end:
                raise StepError(f"{step} {arguments} was still {result} after {seconds:.0f} s:\n{self.log()[-8000:]}")
            time.sleep(0.05)
        return result

    def screenshot(self, name: str, kind: str = "") -> np.ndarray:
        """The screen, or an area's main region, (height, width, 3) of 8 bits, row 0 at the top; also ``name``.png."""
        path = self.machine.screenshot(name)
        if kind:
            x, y, width, height = self.step("rectangle", kind=kind)
            with Image.open(path) as picture:
                picture.crop((x, y, x + width, y + height)).save(path)
        with Image.open(path) as picture:
            return np.asarray(picture.convert("RGB"))

    def point_at(self, kind: str, across: float = 0.5, down: float = 0.5) -> None:
        """Move the mouse over an area's main region; keys go to the area below it."""
        x, y, width, height = self.step("rectangle", kind=kind)
        self.machine.press("mousemove", int(x + across * width), int(y + down * height))
        time.sleep(0.1)

    def shrink(self, kind: str, width: int, height: int) -> None:
        """Give an area's main region about this size, less than half of what it has."""
        for size, wanted in (("width", width), ("height", height)):
            self.step("split", kind=kind, size=size, wanted=wanted)
            self.wait_until("ready", 10.0)  # sizes are known once the window is laid out
            self.step("keep_smallest", kind=kind)
            self.wait_until("ready", 10.0)

    def press(self, key: str) -> None:
        """Press and release a key, by its X11 name, maybe after others that are held: ctrl+F12."""
        *held, last = key.split("+")
        self.machine.press("key", "+".join([*held, KEY_CODES.get(last, last)]))

    def quit(self) -> None:
        """Quit as a user does, and check that nothing stays behind."""
        self.step("quit_blender")
        status = self.machine.wait("blender", 60.0)
        assert status == 0, f"Blender ended with {status}:\n{self.log()[-8000:]}"
        nothing_left(self.machine)
        assert "Traceback" not in self.log(), self.log()[-8000:]


def nothing_left(machine: ChrootMachine, seconds: float = 5.0) -> None:
    """Check that no process but the X server and no shared memory is there, at the latest after ``seconds``."""
    end = time.monotonic() + seconds
    while True:
        processes = [command for command in machine.processes().values() if command[0] != "Xvfb"]
        names = machine.shared_memory()
        if not processes and not names:
            return
        assert time.monotonic() < end, f"left behind: processes {processes}, shared memory {names}"
        time.sleep(0.1)


def blender_in_background(machine: ChrootMachine, *arguments: str, seconds: float = 300.0) -> str:
    """Run ``blender --background`` with the installed extension; returns what it printed."""
    try:
        return machine.run(["blender", "--background", "--offline-mode", *arguments], USER_FOLDER, seconds)
    finally:
        nothing_left(machine)


def read_png(path: Path) -> np.ndarray:
    """(height, width, 3) of 8 bits, row 0 at the top."""
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB"))


__all__ = ["BlenderWindow", "MachineError", "StepError", "blender_in_background", "nothing_left", "read_png"]

# SPDX-License-Identifier: GPL-3.0-or-later
"""F12, animations, edits and renders that are stopped, in turn in one window with a rendered viewport.

tools/soak.py runs it (make soak). It asks that memory, handles, threads, processes and files stay flat, and that
pictures are those of a Blender that has just been started.
"""

import hashlib
import json
import os
import shutil
import time
from pathlib import Path

import numpy as np
import OpenEXR
from blender_window import USER_FOLDER
from viewport_window import arrange, show_rendered

MINUTES = float(os.environ.get("RPPM_SOAK_MINUTES", "2"))
FOLDER = Path(os.environ.get("RPPM_SOAK_FOLDER", Path(__file__).resolve().parents[2] / "out/soak"))
STATES = 8
"""As in inside/soak_steps.py, with FRAMES."""
FRAMES = 10
COMPARED_EVERY = 50
"""Frames, of which the last is rendered by another Blender as well."""
ANIMATED_EVERY = 4
"""Rounds."""
STOPPED_AT = 3
"""The state in which a render is begun and stopped before the one that counts."""
LOOKED_AT_SECONDS = 0.7
"""How long the viewport renders a state before F12."""
PATIENCE = 600.0
TEMPORARY, KEPT = ("/dev/shm", "/tmp", "/var/tmp", "/run"), ("/mnt/user", "/mnt/programs", "/mnt/home")


def pixels(path: Path) -> np.ndarray:
    """Read all channels of a picture, (height, width, channels)."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return np.dstack([channel.pixels for _, channel in sorted(file.channels().items())])


class Soak:
    """One window that is used for long."""

    def __init__(self, blender) -> None:
        self.blender = blender
        self.folder = blender.machine.folder
        self.counts = dict.fromkeys(("frames", "animations", "stopped", "repeated", "compared", "mismatches"), 0)
        self._sums: dict[tuple[int, int], str] = {}
        """Checksum of the first picture of each state and frame."""
        self._started = time.monotonic()

    @property
    def minutes(self) -> float:
        return (time.monotonic() - self._started) / 60.0

    def round(self, number: int) -> None:
        state = number % STATES
        frame = self.blender.step("soak_state", 120.0, state=state)
        self.blender.step("turn", 120.0, degrees=360.0 / STATES)
        time.sleep(LOOKED_AT_SECONDS)
        if state == STOPPED_AT:
            self.stop_one()
        self.press("F12", "completed")
        self.blender.step("save_result", 120.0, path="/mnt/soak/still.exr")
        self.see(self.folder / "soak/still.exr", state, frame)
        if number % ANIMATED_EVERY == ANIMATED_EVERY - 1:
            self.press("ctrl+F12", "completed")
            self.counts["animations"] += 1
            for frame in range(1, FRAMES + 1):
                self.see(self.folder / f"soak/{frame:04d}.exr", state, frame)

    def press(self, key: str, counted: str) -> None:
        """Press a key and wait until one more render was completed or cancelled."""
        before = self.blender.step("render_counts", 120.0)[counted]
        self.blender.press(key)
        self.blender.wait_until("render_counts", PATIENCE, lambda counts: counts[counted] > before)

    def stop_one(self) -> None:
        self.blender.step("assign", 120.0, path="scene.rppm.samples", value=1000000)
        before = self.blender.step("render_counts", 120.0)["started"]
        self.blender.press("F12")
        self.blender.wait_until("render_counts", PATIENCE, lambda counts: counts["started"] > before)
        time.sleep(1.0)
        self.press("Escape", "cancelled")
        self.blender.step("assign", 120.0, path="scene.rppm.samples", value=2)
        self.counts["stopped"] += 1

    def see(self, path: Path, state: int, frame: int) -> None:
        """Count a picture, compare it with those of the same state and frame, and each so many with a fresh one."""
        self.counts["frames"] += 1
        picture = pixels(path)
        assert np.isfinite(picture).all() and picture[..., :3].max() > 0.0, (state, frame)
        found = hashlib.sha256(picture.tobytes()).hexdigest()
        self.counts["repeated"] += (state, frame) in self._sums
        if self._sums.setdefault((state, frame), found) != found:
            self.mismatch(path, state, frame)
        if self.counts["frames"] % COMPARED_EVERY == 0:
            self.counts["compared"] += 1
            if not np.array_equal(picture, self.fresh(frame)):
                self.mismatch(path, state, frame)
        path.rename(FOLDER / f"last_{state}_{frame}.exr") if self.counts["frames"] <= STATES else path.unlink()

    def fresh(self, frame: int) -> np.ndarray:
        """Return the picture that another Blender renders of the file as it is now."""
        self.blender.step("soak_copy", 120.0, path="/mnt/soak/copy.blend")
        command = ["blender", "--background", "--offline-mode", "/mnt/soak/copy.blend"]
        command += ["--render-output", "/mnt/soak/fresh_####", "--render-frame", str(frame)]
        self.blender.machine.run(command, USER_FOLDER, PATIENCE)
        path = self.folder / f"soak/fresh_{frame:04d}.exr"
        picture = pixels(path)
        path.rename(FOLDER / "fresh.exr")
        (self.folder / "soak/copy.blend").unlink()
        return picture

    def mismatch(self, path: Path, state: int, frame: int) -> None:
        self.counts["mismatches"] += 1
        name = f"mismatch_{self.counts['mismatches']}_{state}_{frame}"
        shutil.copy(path, FOLDER / f"{name}.exr")
        if (FOLDER / "fresh.exr").exists():
            shutil.copy(FOLDER / "fresh.exr", FOLDER / f"{name}_fresh.exr")

    def measured(self) -> dict[str, float]:
        """A line of the log: bytes are MiB."""
        resources = self.blender.machine.resources(*TEMPORARY, *KEPT)
        processes = {pid: held for pid, held in resources["processes"].items() if held["command"][0] != "Xvfb"}
        blender = processes[str(self.blender.pid)]
        pid, renderer = next(p for p in processes.items() if p[1]["command"][-1].endswith("bootstrap.py"))
        line = {"minutes": round(self.minutes, 2), **self.counts}
        for name, held in ("blender", blender), ("renderer", renderer):
            for kind in ("resident", "anonymous"):
                line[f"{name}_{kind}"] = round(held[kind] / 2**20, 1)
            line[f"{name}_handles"], line[f"{name}_threads"] = held["handles"], held["threads"]
        blocks = {place: size for held in processes.values() for place, size in held["shared"].items()}
        line |= {"renderer_pid": int(pid), "processes": len(processes)}
        line |= {"shared_blocks": len(blocks), "shared": round(sum(blocks.values()) / 2**20, 2)}
        for name, folders in ("temporary", TEMPORARY), ("kept", KEPT):
            sizes = [size for path, size in resources["files"].items() if path.startswith(folders)]
            line |= {f"{name}_files": len(sizes), f"{name}_bytes": round(sum(sizes) / 2**20, 2)}
        return line


def test_long_use(open_blender):
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    blender = open_blender("small.blend")
    (blender.machine.folder / "soak").mkdir(exist_ok=True)
    arrange(blender)
    blender.step("soak_begin")
    blender.step("free_view")
    show_rendered(blender, PATIENCE)
    blender.step("watch_no_more")
    soak, number, lines = Soak(blender), 0, []
    with (FOLDER / "soak.jsonl").open("w", encoding="utf-8") as log:
        while soak.minutes < MINUTES:
            soak.round(number)
            number += 1
            if soak.minutes >= min(len(lines) + 1, MINUTES):
                lines.append(soak.measured())
                log.write(json.dumps(lines[-1]) + "\n")
                log.flush()
    blender.quit()
    assert soak.counts["mismatches"] == 0
    assert len({line["renderer_pid"] for line in lines}) == 1, "the renderer's process was started anew"

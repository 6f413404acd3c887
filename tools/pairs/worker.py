# SPDX-License-Identifier: GPL-3.0-or-later
"""One file, rendered by both renderers in a process of its own: ``python -m tools.pairs.worker SOURCE TARGET JSON``.

TARGET.npz gets the pictures, TARGET.json what was said. Lines that begin with STAGE tell where it is, as Blender may
abort the process at any time.
"""

import json
import os
import sys
import tempfile
import time
import traceback
from pathlib import Path
from types import TracebackType

import bpy
import numpy as np

import rppm_addon
from rppm_addon.blender.export import SceneError
from rppm_addon.commands.blend_files.data_paths import set_data_path, split_assignment
from rppm_addon.pictures import read_exr
from rppm_addon.scene import Scene
from rppm_addon.session.render.observers import RenderObserver, observing
from rppm_addon.session.render.results import Progress, RenderResult

from . import staging
from .settings import Effort, equalize
from .suspects import suspects_of

STAGE = "@stage "
SEEDS = (1, 2)
"""Seeds of each renderer's two pictures, which tell its noise."""


class _Follower(RenderObserver):
    """Keeps what a render of RPPM is of and when its first picture was there."""

    def __init__(self) -> None:
        self.scene: Scene | None = None
        self.first_picture = float("nan")
        self.error = ""
        self.warnings: list[str] = []
        self._start = time.perf_counter()

    def on_scene(self, scene: Scene) -> bool:
        self.scene = scene
        return True

    def on_progress(self, progress: Progress) -> None:
        if progress.iteration >= 1 and self.first_picture != self.first_picture:
            self.first_picture = time.perf_counter() - self._start

    def on_finish(self, result: RenderResult, scene: Scene) -> None:
        self.warnings = list(scene.warnings)

    def on_error(self, text: str) -> None:
        self.error = text


def _stage(name: str) -> None:
    print(f"{STAGE}{name}", flush=True)


def _picture(scene: bpy.types.Scene, engine: str, folder: str) -> np.ndarray:
    """(H, W, 4) of a render by one of the engines."""
    scene.render.engine = engine
    target = Path(folder, f"{engine}.exr")
    target.unlink(missing_ok=True)
    scene.render.filepath = str(target)
    bpy.ops.render.render(write_still=True)
    return read_exr(target).combined


def _ours(scene: bpy.types.Scene, folder: str) -> tuple[np.ndarray, _Follower]:
    """(seeds, H, W, 4), and what happened to the first of them. Raises SceneError with what RPPM says."""
    pictures, followers = [], []
    for seed in SEEDS:
        scene.rppm.seed = seed
        follower = _Follower()
        with observing(follower):
            pictures.append(_picture(scene, "RPPM", folder))
        if follower.error:
            raise SceneError(follower.error)
        followers.append(follower)
    return np.array(pictures), followers[0]


def _theirs(scene: bpy.types.Scene, folder: str) -> np.ndarray:
    """(seeds, H, W, 4)."""
    pictures = []
    for seed in SEEDS:
        scene.cycles.seed, scene.cycles.use_animated_seed = seed, False
        pictures.append(_picture(scene, "CYCLES", folder))
    return np.array(pictures)


def main(source: Path, target: Path, effort: Effort, values: list[str]) -> None:
    """Render a file and write what comes of it."""
    _stage("opening")
    rppm_addon.register()
    bpy.ops.wm.open_mainfile(filepath=str(source), load_ui=False, use_scripts=False)
    staging.stage(source)
    scene = bpy.context.scene
    equalize(scene, effort)
    for path, value in map(split_assignment, values):
        set_data_path((scene, bpy.data), path, value)
    with tempfile.TemporaryDirectory() as folder:
        _stage("RPPM")
        ours, follower = _ours(scene, folder)
        _stage("Cycles")
        theirs = _theirs(scene, folder)
    _stage("looking for what Cycles gets wrong")
    report = {
        "warnings": follower.warnings,
        "first_picture_seconds": follower.first_picture,
        "triangles": follower.scene.triangle_count if follower.scene else 0,
        "suspects": suspects_of(follower.scene) if follower.scene else [],
    }
    np.savez_compressed(Path(f"{target}.npz"), ours=ours.astype(np.float32), theirs=theirs.astype(np.float32))
    Path(f"{target}.json").write_text(json.dumps(report, indent=2), encoding="utf-8")


def _tell(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    traceback.print_exception(kind, error, trace)
    sys.stderr.flush()
    os._exit(1)


if __name__ == "__main__":
    sys.excepthook = _tell
    told = json.loads(sys.argv[3])
    main(Path(sys.argv[1]), Path(sys.argv[2]), Effort(**told["effort"]), told["values"])
    sys.stdout.flush()
    os._exit(0)  # an engine that is registered, or a fluid domain, may hang or abort Blender at its exit

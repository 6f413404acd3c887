# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how animations flicker: what differs between frames beside what moves, with one seed and with many.

Two series of the same frames, each with a fixed seed of its own, tell all (A and B, frames k):
variance of a frame: (A_k - B_k)^2 / 2; what moves: (A_k+1 - A_k)(B_k+1 - B_k), free of noise as the seeds are
independent; flicker with the seed fixed: (A_k+1 - A_k)^2 / 2, animated: (A_k+1 - B_k)^2 / 2, each less half of what
moves. Flicker over variance is 0 where noise stands still, and 1 where frames are independent.

Prints a table and, with --output, writes the figures as JSON. Needs the bpy module.
"""

import argparse
import dataclasses
import json
import sys
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np

import rppm_addon
from rppm_addon.blender.export import export_scene
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Scene

from . import ROOT
from .machine import Clock, describe

SAMPLES = ("pool", "spotlight")
STEPS = (0.0, 0.02, 0.1, 0.5, 1.0)
"""From frame to frame, in frames of the sample at 24 a second."""
SEEDS = (0, 1)
FIRST_FRAME = 8.0
DARK = 0.1
"""Share of the picture's mean that is added to that of a pixel, so that nearly black ones do not outweigh all."""


def frames_of(sample: str, step: float, count: int) -> Iterator[Scene]:
    """The exported scenes of successive frames."""
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / f"docs/samples/{sample}.blend"))
    scene = bpy.context.scene
    for k in range(count):
        frame, part = divmod(FIRST_FRAME + step * k, 1.0)
        scene.frame_set(int(frame), subframe=part)
        yield export_scene(bpy.context.evaluated_depsgraph_get()).expanded()


class Pictures:
    """Renders scenes in a small frame."""

    def __init__(self, width: int, photons: int, iterations: int) -> None:
        self.context = Context.create()
        self._library = ProgramLibrary(self.context)
        self._mapper = ProgressivePhotonMapper(self.context, self._library)
        self.size, self.photons, self.iterations = (width, width * 3 // 4), photons, iterations

    def of(self, scene: Scene, seed: int) -> np.ndarray:
        """(height, width, 3) radiance."""
        camera = dataclasses.replace(scene.camera, width=self.size[0], height=self.size[1])
        settings = dataclasses.replace(scene.settings, photons=self.photons, seed=seed)
        self._mapper.update(dataclasses.replace(scene, camera=camera, settings=settings))
        for _ in range(self.iterations):
            self._mapper.iterate()
        return self._mapper.film.read_radiance()[..., :3].astype(float)

    def release(self) -> None:
        self._mapper.release()
        self._library.release()
        self.context.release()


def figures(series: np.ndarray) -> dict[str, float]:
    """Relative variance and what moves, and flicker over variance; series: (2 seeds, frames, height, width, 3)."""
    mean = series.mean(axis=(0, 1))
    weight = 1.0 / (mean + DARK * mean.mean()) ** 2
    a, b = series
    change_a, change_b = np.diff(a, axis=0), np.diff(b, axis=0)
    variance = np.mean((a - b) ** 2 * weight) / 2
    moves = np.mean(change_a * change_b * weight) / 2
    fixed = np.mean((change_a**2 + change_b**2) * weight) / 4
    animated = np.mean(((a[1:] - b[:-1]) ** 2 + (b[1:] - a[:-1]) ** 2) * weight) / 4
    return {
        "relative_variance": float(variance),
        "moves": float(moves),
        "fixed": float((fixed - moves) / variance),
        "animated": float((animated - moves) / variance),
    }


def table(lines: list[dict]) -> str:
    """In Markdown."""
    rows = ["| sample | frames a step | variance of a frame | what moves | fixed seed | animated seed |",
            "|---|---:|---:|---:|---:|---:|"]  # fmt: skip
    rows += [
        f"| {line['sample']} | {line['step']:g} | {line['relative_variance']:.4f} | {line['moves']:.4f} "
        f"| {line['fixed']:.3f} | {line['animated']:.3f} |"
        for line in lines
    ]
    return "\n".join(rows)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", nargs="+", choices=SAMPLES, default=list(SAMPLES))
    parser.add_argument("--steps", nargs="+", type=float, default=list(STEPS), help="frames between two that are shown")
    parser.add_argument("--frames", type=int, default=16, metavar="N", help="two or more (16)")
    parser.add_argument("--width", type=int, default=96, metavar="PIXELS")
    parser.add_argument("--photons", type=int, default=32768, metavar="N", help="an iteration (32768)")
    parser.add_argument("--iterations", type=int, default=16, metavar="N")
    parser.add_argument("--output", type=Path, metavar="FILE.json", help="where the figures go")
    options = parser.parse_args(arguments)
    rppm_addon.register()
    pictures = Pictures(options.width, options.photons, options.iterations)
    lines = []
    try:
        for sample in options.samples:
            for step in options.steps:
                scenes = list(frames_of(sample, step, options.frames))
                series = np.array([[pictures.of(scene, seed) for scene in scenes] for seed in SEEDS])
                lines.append({"sample": sample, "step": step, **figures(series)})
                print(table(lines[-1:]).splitlines()[-1], flush=True)
        if options.output is not None:
            machine = describe(pictures.context, Clock(pictures.context))
            measured = vars(options) | {"output": str(options.output)}
            document = {"machine": machine, "options": measured, "lines": lines}
            options.output.parent.mkdir(parents=True, exist_ok=True)
            options.output.write_text(json.dumps(document, indent=1) + "\n", "utf-8")
        print(table(lines))
    finally:
        pictures.release()
        rppm_addon.unregister()
    return 0


if __name__ == "__main__":
    sys.exit(main())

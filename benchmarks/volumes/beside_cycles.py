# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the noise of RPPM and of Cycles in plain media after equal time.

    python -m benchmarks.volumes.beside_cycles dense_ball cloud --width 160 --samples 16 32

Both engines render in turns, with seeds of their own and equal bounces. The variance of pixels between seeds is
relative to the squared mean + 0.01 of all pictures of both, without the worst thousandth of the pixels; it counts times
the least seconds of processor time of a picture, all cores together, the time to start and to compile not counted.
Prints rows of a table: scene; photons of a sample; variance, seconds and their product for RPPM; the same for Cycles;
the ratio of the products; RPPM's mean over Cycles'.

With --blocks 8, a line below says how the means of blocks of 8 x 8 pixels compare: the median of RPPM's over Cycles';
the block that differs the most with its standard error; and the blocks that differ by more than 3 % and by more than
three standard errors, which are of the seeds of both. Blocks darker than 2 % of the picture's mean are left out.
"""

import argparse
import dataclasses
import time

import bpy
import numpy as np

from rppm_addon.blender.export import export_scene
from rppm_addon.scene import Scene
from rppm_addon.session.render.renderer import Renderer
from tests.parity.engines import cycles_pass

from ..peers.metrics import EPSILON, LEFT_OUT
from .media_scenes import SCENES


@dataclasses.dataclass
class Run:
    """Pictures of one engine with seeds of their own, and the seconds that each took."""

    pictures: list[np.ndarray] = dataclasses.field(default_factory=list)
    seconds: list[float] = dataclasses.field(default_factory=list)

    def add(self, picture: np.ndarray, seconds: float) -> None:
        """Add a picture, (H, W, 3)."""
        self.pictures.append(picture.astype(np.float64))
        self.seconds.append(seconds)

    def variance(self, mean: np.ndarray) -> np.ndarray:
        """(H, W) variance of a picture relative to the squared mean, (H, W, 3)."""
        return (np.var(self.pictures, 0, ddof=1) / (mean**2 + EPSILON)).mean(-1)


def relative_variance(variance: np.ndarray) -> float:
    """The mean without the worst pixels."""
    ordered = np.sort(variance.ravel())
    return float(ordered[: ordered.size - round(LEFT_OUT * ordered.size)].mean())


def _ours(renderer: Renderer, scene: Scene, seed: int, photons: int) -> tuple[np.ndarray, float, int]:
    settings = scene.settings.with_values(seed=seed, photons=photons)
    renderer.forget()
    began = time.process_time()
    result = renderer.render(dataclasses.replace(scene, settings=settings))
    spent = time.process_time() - began
    return result.frame.combined[..., :3], spent, result.statistics.photons // settings.iterations


def _theirs(samples: int, seed: int) -> tuple[np.ndarray, float]:
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.seed = "CYCLES", samples, seed
    began = time.process_time()
    picture = cycles_pass("Combined", "RGB", samples)
    spent = time.process_time() - began
    return np.maximum(picture, 0.0), spent


def _blocks(pictures: list[np.ndarray], side: int) -> tuple[np.ndarray, np.ndarray]:
    """Means of blocks of pixels and their standard errors, from pictures of several seeds."""
    values = np.mean(pictures, axis=-1)
    count, height, width = values.shape
    values = values[:, : height // side * side, : width // side * side]
    means = values.reshape(count, height // side, side, width // side, side).mean(axis=(2, 4))
    return means.mean(0), means.std(0, ddof=1) / count**0.5


def _line_of_blocks(ours: Run, theirs: Run, side: int) -> str:
    (mean, error), (their_mean, their_error) = (_blocks(run.pictures, side) for run in (ours, theirs))
    bright = their_mean > 0.02 * their_mean.mean()
    ratio = (mean / np.maximum(their_mean, 1e-30))[bright]
    error = (np.hypot(error, their_error) / np.maximum(their_mean, 1e-30))[bright]
    worst, off = np.argmax(np.abs(ratio - 1.0)), np.abs(ratio - 1.0) > np.maximum(0.03, 3.0 * error)
    return (
        f"blocks: median {np.median(ratio):.4f}, worst {ratio[worst]:.3f} +- {error[worst]:.3f}, "
        f"{off.sum()} of {off.size} off; errors of blocks {np.median(error):.4f}"
    )


def compare(name: str, options: argparse.Namespace) -> None:
    """Print the rows of a scene: one for each number of photons."""
    SCENES[name]()
    render, cycles = bpy.context.scene.render, bpy.context.scene.cycles
    render.resolution_x, render.resolution_y = options.width, options.width * 3 // 4
    scene = export_scene(bpy.context.evaluated_depsgraph_get())
    ours, theirs = options.samples
    settings = scene.settings.with_values(
        volume_bounces=cycles.volume_bounces, max_bounces=cycles.max_bounces, iterations=ours, use_denoising=False
    )
    scene = dataclasses.replace(scene, settings=settings)
    runs = {photons: Run() for photons in options.photons}
    cycles_run, counts = Run(), {}
    with Renderer() as renderer:
        _ours(renderer, scene, 99, 0)
        _theirs(1, 99)
        for seed in range(options.seeds):
            for photons, run in runs.items():
                picture, seconds, counts[photons] = _ours(renderer, scene, seed, photons)
                run.add(picture, seconds)
            cycles_run.add(*_theirs(theirs, seed))
    if options.keep:
        kept = {f"photons_{photons}": run.pictures for photons, run in runs.items()}
        np.savez(f"{options.keep}/{name}.npz", cycles=cycles_run.pictures, **kept)
    mean = np.mean([*cycles_run.pictures, *(picture for run in runs.values() for picture in run.pictures)], axis=0)
    their_noise, their_seconds = relative_variance(cycles_run.variance(mean)), min(cycles_run.seconds)
    for photons, run in runs.items():
        noise, seconds = relative_variance(run.variance(mean)), min(run.seconds)
        means = [np.mean(run.pictures, (1, 2, 3)), np.mean(cycles_run.pictures, (1, 2, 3))]
        ratio = means[0].mean() / means[1].mean()
        error = np.hypot(*(m.std(ddof=1) / len(m) ** 0.5 / m.mean() for m in means))
        print(
            f"| {name} | {counts[photons]}{'' if photons else ' (automatic)'} | "
            f"{noise:.3g} x {seconds:.3g} s = {noise * seconds:.3g} | "
            f"{their_noise:.3g} x {their_seconds:.3g} s = {their_noise * their_seconds:.3g} | "
            f"{noise * seconds / (their_noise * their_seconds):.2f} | {ratio:.4f} +- {error:.4f} |",
            flush=True,
        )
        if options.blocks:
            print(_line_of_blocks(run, cycles_run, options.blocks), flush=True)


def main() -> None:
    """Print the rows of scenes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=list(SCENES), help=", ".join(SCENES))
    parser.add_argument("--width", type=int, default=160, help="of pictures, pixels (160)")
    parser.add_argument("--samples", type=int, nargs=2, default=(16, 32), help="of RPPM and of Cycles (16 32)")
    parser.add_argument("--seeds", type=int, default=3, help="pictures of each (3)")
    parser.add_argument("--photons", type=int, nargs="*", default=[0], help="of an iteration; 0 is automatic (0)")
    parser.add_argument("--blocks", type=int, default=0, help="pixels along a side of the blocks that are compared")
    parser.add_argument("--keep", help="folder for the pictures")
    options = parser.parse_args()
    for name in options.scenes:
        compare(name, options)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""How far RPPM and Cycles differ in a row."""

from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np

from rppm_addon.blender.export import export_scene
from rppm_addon.scene import Scene
from rppm_addon.session.render.renderer import Renderer

from ..comparison import block_means, mean_variance
from ..engines import render_cycles
from .flip import flip
from .rows import Kind, Row

BATCHES, CYCLES_SEEDS = 4, 2
LIGHT = {
    "max_bounces": 64, "transparent_max_bounces": 64,  # as Cycles' in these scenes
    "iterations": 24, "photons": 2048, "camera_path_length": 4, "photon_path_length": 4,
}  # fmt: skip
VALUES = {
    "iterations": 1, "photons": 64, "camera_path_length": 1, "photon_path_length": 1, "filter_width": 0.0,
    "use_final_gather": False,
}  # fmt: skip
SAMPLES = 32
WRONG = 0.002
"""Fraction of white: a pixel of values that differs more is wrong."""


@dataclass(frozen=True)
class Measurement:
    """Differences as shares of Cycles' radiance."""

    mean: float
    """Difference of the mean, in the channel where it is largest, for light; mean absolute difference for values."""
    mean_error: float
    """Standard error of the mean's difference, from seeds."""
    block: float
    """Difference of the mean over 8 x 8 pixels, in the block where it is largest beyond four standard errors."""
    block_excess: float
    """Part of the block's difference that is beyond four standard errors."""
    wrong: float
    """Share of pixels that differ visibly; for values."""
    rppm: np.ndarray
    cycles: np.ndarray
    """(H, W, 3) the means over the seeds, row 0 at the bottom."""
    cycles_seeds: np.ndarray
    """(seeds, H, W, 3)"""
    warnings: tuple[str, ...]

    @cached_property
    def flip(self) -> float:
        """Mean FLIP of the pictures, noise included."""
        return self._flip(self.cycles, self.rppm)

    @cached_property
    def flip_noise(self) -> float:
        """Mean FLIP of Cycles' pictures of two seeds, 0 for values."""
        return self._flip(*self.cycles_seeds[:2]) if len(self.cycles_seeds) > 1 else 0.0

    def _flip(self, *pictures: np.ndarray) -> float:
        return float(flip(*(encoded(picture, white_of(self.cycles)) for picture in pictures)).mean())


def encoded(picture: np.ndarray, white: float) -> np.ndarray:
    """Linear radiance as sRGB, white at 1."""
    linear = np.clip(picture / white, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def white_of(reference: np.ndarray) -> float:
    """The radiance that is shown as white."""
    return float(np.percentile(reference, 99)) or 1.0


def measure(row: Row, renderer: Renderer, part: float = 1.0) -> Measurement:
    """Build the row's scene, render it with both engines and compare.

    part: of the usual iterations of light that RPPM takes.
    """
    row.build()
    values = row.kind is Kind.VALUES
    cycles = bpy.context.scene.cycles
    if values:
        cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.01
    scene = export_scene(bpy.context.evaluated_depsgraph_get())
    settings = (VALUES if values else LIGHT) | row.settings
    iterations = settings["iterations"] * row.effort
    scene.settings = scene.settings.with_values(
        **settings | {"iterations": iterations if values else round(part * iterations)}
    )
    reference = render_cycles(1, 1) if values else render_cycles(SAMPLES * row.effort, CYCLES_SEEDS)
    pictures = _batches(renderer, scene, 1 if values else BATCHES)
    return compared(pictures, reference, values, tuple(scene.warnings))


def _batches(renderer: Renderer, scene: Scene, count: int) -> np.ndarray:
    """(count, H, W, 3) means over parts of the iterations, which tell the noise without building the scene again."""
    sums, size = [0.0], scene.settings.iterations // count

    def keep(progress, frame) -> None:
        if progress.iteration == len(sums) * size:
            sums.append(progress.iteration * frame().combined[..., :3].astype(np.float64))

    renderer.render(scene, on_progress=keep)
    return np.array([(after - before) / size for before, after in zip(sums, sums[1:])])


def compared(rppm: np.ndarray, cycles: np.ndarray, values: bool, warnings: tuple[str, ...] = ()) -> Measurement:
    """Figures of pictures (seeds, H, W, 3)."""
    ours, reference = rppm.mean(axis=0), cycles.mean(axis=0)
    level, white = max(reference.mean(), 1e-9), white_of(reference)
    a, b = block_means(rppm), block_means(cycles)
    difference = np.abs(a.mean(axis=0) - b.mean(axis=0))
    squared_error = mean_variance(a) + mean_variance(b)
    blocks = np.maximum(b.mean(axis=0), 0.1 * level)
    excess = (difference - 4.0 * np.sqrt(squared_error)) / blocks
    worst = np.unravel_index(np.argmax(excess), excess.shape)
    channels = reference.mean(axis=(0, 1))
    if values:
        mean = np.abs(ours - reference).mean() / level
    else:
        # A channel that is nearly black is judged by the picture.
        by_channel = np.abs(ours.mean(axis=(0, 1)) - channels) / np.maximum(channels, 0.2 * level)
        mean = by_channel.max()
    return Measurement(
        mean=float(mean),
        mean_error=float(np.sqrt(squared_error.sum()) / squared_error.size / level),
        block=float(difference[worst] / blocks[worst]),
        block_excess=float(max(excess[worst], 0.0)),
        wrong=float((np.abs(ours - reference).max(axis=-1) > WRONG * np.maximum(reference.max(axis=-1), white)).mean()),
        rppm=ours,
        cycles=reference,
        cycles_seeds=cycles,
        warnings=warnings,
    )


MOST_WRONG = 0.005
"""Share of the pixels of values that may differ: those where an edge runs through the center."""


def shortcomings(row: Row, found: Measurement) -> list[str]:
    """List the shortcomings of a row; empty when it is as it should be."""
    wrong = []
    if row.kind is Kind.VALUES and not row.reason and found.wrong > MOST_WRONG:
        wrong.append(f"{found.wrong:.2%} of the pixels differ")
    if found.mean_error > 0.008:
        wrong.append(f"the mean is too noisy to tell: {found.mean_error:.2%}")
    if found.mean > row.mean + 2.5 * found.mean_error:
        wrong.append(f"the mean differs by {found.mean:.2%} +- {found.mean_error:.2%}")
    if found.block_excess > row.block and (row.kind is Kind.LIGHT or row.reason):
        wrong.append(f"a block differs by {found.block:.2%}, {found.block_excess:.2%} beyond its noise")
    if bool(found.warnings) != row.warns:
        wrong.append(f"warnings: {found.warnings}")
    return wrong

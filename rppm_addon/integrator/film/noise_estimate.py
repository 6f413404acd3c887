# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise of the film, estimated from half of its iterations.

The mean of half of the iterations and that of all differ as two independent estimates do, so their distance says how
far the mean of all is from that of infinitely many. Dammertz et al., A Hierarchical Automatic Stopping Condition for
Monte Carlo Global Illumination (2009), in the unit of Cycles (kernel/film/adaptive_sampling.h). Where points fill
their space evenly the mean of all is better than that: measured along edges, by 1.5 at 64 iterations and 2.3 at 512.
What both halves have alike, the blur of the radius, cannot be measured so.
"""

import math

import numpy as np

from ...gl.buffer_sets import ComputeShader, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..common.film_buffers import BANDS_TOGETHER, FilmBuffer, FilmParts
from ..common.stage_sizes import StageSizes
from ..device_scene.stage_context import StageContext
from .events import BandEvents, Listener

Record("HalfParameters", count="uint", quantum="float", first_pixel="uint", number="uint")
Record("NoiseParameters", count="uint", width="uint", height="uint", columns="uint", exposure="float", balance="float")
StorageBlock("HalfMeans", "float half_means[];")

BLOCK = BANDS_TOGETHER
"""Pixels along a side of the blocks whose noise counts: of a single pixel's a few iterations say nothing."""
Constants("NoiseBlocks", NOISE_BLOCK=BLOCK)
_SHORTEST_RUN, _RUNS_PER_OCTAVE = 16, 4
LEAST_MEASURED, MEASURED_EVERY = 2 * _SHORTEST_RUN, _SHORTEST_RUN // 2
"""Iterations of which the noise can be measured, and those from one time to the next."""


def _run_length(index: int) -> int:
    return max(_SHORTEST_RUN, (1 << max(index.bit_length() - 1, 0)) // _RUNS_PER_OCTAVE)


def is_in_half(number: int) -> bool:
    """Whether an iteration (from 1) belongs to the half.

    Points of iterations fill their space evenly, and so do 2^k of them from a multiple of 2^k on, while those of every
    other iteration, however chosen, are strewn: of them the halves would show several times the noise that there is,
    most of it along edges, as all pixels look through the same subpixel. So runs of iterations belong to the half or do
    not, in the order of Thue and Morse, and are as long as a quarter of the iterations before. Radii shrink: a blur
    that goes away counts as far as it differs from run to run.
    """
    index = number - 1
    return (index // _run_length(index)).bit_count() % 2 == 1


def count_in_half(iterations: int) -> int:
    """Number of iterations that belong to the half, among the first ``iterations``."""
    count = index = 0
    while index < iterations:
        end = index + _run_length(index)
        if is_in_half(index + 1):
            count += min(end, iterations) - index
        index = end
    return count


def _block_count(sizes: StageSizes) -> int:
    return math.ceil(sizes.width / BLOCK) * math.ceil(sizes.height / BLOCK)


class NoiseEstimate(Listener):
    """The mean of half of the iterations, 12 bytes a pixel."""

    memory_group = "passes"
    remedy = "lower the resolution"
    _half = FilmBuffer("half of the film", "float", 3, together=True)
    _noises = StorageBuffer("noise of blocks", "float", _block_count, block="Noises")
    _add = ComputeShader("film/noise_estimate/add.comp")
    _measure = ComputeShader("film/noise_estimate/measure.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._width, self._columns = sizes.width, math.ceil(sizes.width / BLOCK)

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where the picture ends with its noise."""
        return sizes.measures_noise

    def band_ended(self, events: BandEvents) -> None:
        """Listener.band_ended: add the band's estimate, as Film does, of an iteration that belongs to the half."""
        iteration, band, sums = events.iteration, events.band, events.sums
        number, skipped = iteration.number, iteration.skipped
        if iteration.film_count is not None:
            number, skipped = iteration.film_count, 0
        if not is_in_half(number):
            return
        with events.context.timers.stage("noise"):
            self._add.run(
                band.pixel_count,
                {**events.context.blocks, **events.importons.blocks, "HalfMeans": self._half.of(band)},
                {
                    "count": band.pixel_count,
                    "quantum": sums.quantum,
                    "first_pixel": self._half.first_pixel(band),
                    "number": count_in_half(number) - count_in_half(skipped),
                },
            )

    def measure(self, context: StageContext, film: FilmParts, exposure: float, skipped: int, iteration: int) -> float:
        """The noise of the noisiest block of a film, (pixels, 4) float32, of the iterations after ``skipped`` up to
        ``iteration``; infinite while one of the halves is empty. Waits for the device."""
        if not self.is_on:
            raise ValueError("nothing is known of the noise: the stage is off")
        here = count_in_half(iteration) - count_in_half(skipped)
        rest = iteration - skipped - here
        if not here or not rest:
            return math.inf
        with context.timers.stage("noise"):
            noise = 0.0
            for part, half, rows in zip(film, self._half, film.rows, strict=True):
                blocks = self._columns * math.ceil(rows / BLOCK)
                self._measure.run(
                    blocks,
                    {**self.blocks, "Film": part.buffer, "HalfMeans": half.buffer},
                    {
                        "count": blocks,
                        "width": self._width,
                        "height": rows,
                        "columns": self._columns,
                        "exposure": exposure,
                        # Of halves that are not alike: from the spread of the distance to that of the mean of all.
                        "balance": math.sqrt(here / rest),
                    },
                )
                noise = max(noise, float(self._noises.read(np.float32, blocks).max()))
            return noise

    def read(self) -> np.ndarray | None:
        """(height, width, 3) float32 mean of the half, row 0 at the bottom; None where the stage is off."""
        return self._half.read(np.float32, 3) if self.is_on else None

    def restore(self, half: np.ndarray | None) -> bool:
        """Take what read gave; whether there is what the stage needs."""
        if self.is_on and half is not None:
            self._half.upload(half)
        return not self.is_on or half is not None

# SPDX-License-Identifier: GPL-3.0-or-later
"""A rolling shutter: rows are exposed one after the other, from the top.

Each iteration is one moment, at which some rows are exposed. Only the bands with these rows take part in it.
"""

import dataclasses
import functools
from collections.abc import Sequence

import numpy as np

from ...scene.camera import Camera
from ...scene.motion import Shutter
from ..common.band import Band
from ..common.iteration import Iteration
from .moments import moment

_GOLDEN = 0.6180339887498949
"""Step of the points that choose iterations by the shutter's curve."""


@functools.lru_cache(maxsize=8)
def _moments(count: int, seed: int) -> np.ndarray:
    """(count,) float64 times of the first iterations, and of as many more as make a power of two."""
    return np.array([moment(number + 1, seed) for number in range(count)])


class RollingShutter:
    """The bands of a picture, and when each is exposed."""

    def __init__(self, shutter: Shutter, camera: Camera, bands: Sequence[Band]) -> None:
        self._bands = bands
        duration = shutter.rolling_duration
        first_row = camera.region[1]
        rows = np.array([first_row + band.first_row + 0.5 * (band.rows - 1) for band in bands])
        # As in Cycles, by the lower edge of each row.
        self._centers = 0.5 + (0.5 - rows / camera.height) * (1.0 - duration)
        """(bands,) middle of the time in which each is exposed, 0 to 1."""
        between = (1.0 - duration) * np.array([band.rows for band in bands]) / camera.height
        self._widths = np.maximum(duration, between)
        """(bands,) length of that time: at least the time from one band to the next."""
        self._curve = np.maximum(np.nan_to_num(shutter.curve), 0.0)

    def iterations(self, iteration: Iteration) -> list[tuple[Band, Iteration]]:
        """The bands that take part in an iteration, with the iteration as it is for each: of those that it only learns
        from, nothing enters the film.

        All bands are in the film's first iteration, for rows that are exposed in none of the iterations. What is
        exposed later takes the place of that.
        """
        taken = self._exposed(iteration)
        counts = taken.sum(axis=0)
        is_first = iteration.number_in_film == 1
        found = []
        for band, is_exposed, count in zip(self._bands, taken[-1] if len(taken) else counts, counts, strict=True):
            film_count = 1 if is_first else int(count) if is_exposed else 0
            if film_count or iteration.precedes_learning:
                found.append((band, dataclasses.replace(iteration, film_count=film_count)))
        return found

    def least_count(self, iteration: Iteration) -> int:
        """The number of iterations of the film, up to this one, in which the band is exposed that is exposed least."""
        return int(self._exposed(iteration).sum(axis=0).min(initial=iteration.number_in_film))

    def _exposed(self, iteration: Iteration) -> np.ndarray:
        """(iterations, bands) bool: in which of those of the film, up to this one, each band is exposed."""
        count = 1 << max(iteration.number - 1, 0).bit_length()
        times = _moments(count, iteration.seed)[iteration.skipped : iteration.number, None]
        places = (times - self._centers) / self._widths + 0.5
        exposed = (places >= 0.0) & (places < 1.0)
        most = self._curve.max()
        if most > 0.0 and self._curve.min() < most:
            openness = self._curve[np.clip((places * len(self._curve)).astype(int), 0, len(self._curve) - 1)] / most
            numbers = np.arange(iteration.skipped, iteration.number)[:, None]
            exposed &= (_GOLDEN * (numbers + 7 * np.arange(len(self._bands)))) % 1.0 < openness
        return exposed

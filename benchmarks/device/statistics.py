# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight lines through times, variances and errors of pictures."""

import numpy as np

_DARK = 0.1
"""Share of the picture's mean that is added to that of a pixel, so that nearly black ones do not outweigh all."""


def fit_line(x: list[float], seconds: list[float]) -> dict[str, float]:
    """seconds = base + slope x by least squares of the relative errors, and the greatest of those."""
    x, seconds = np.asarray(x, float), np.asarray(seconds, float)
    slope, base = np.polyfit(x, seconds, 1, w=1.0 / seconds)
    error = np.abs(base + slope * x - seconds) / seconds
    return {"base_seconds": float(base), "slope_seconds": float(slope), "greatest_relative_error": float(error.max())}


def block_error(picture: np.ndarray, reference: np.ndarray, side: int) -> float:
    """Median relative error of the means of blocks of side x side pixels; both (height, width), cut to whole blocks."""

    def blocks(values: np.ndarray) -> np.ndarray:
        rows, columns = values.shape[0] // side, values.shape[1] // side
        return values[: rows * side, : columns * side].reshape(rows, side, columns, side).mean(axis=(1, 3))

    truth = blocks(reference)
    return float(np.median(np.abs(blocks(picture) - truth) / (truth + _DARK * reference.mean())))


def variances(without: np.ndarray, rejecting: np.ndarray) -> tuple[float, list[float], list[float]]:
    """Relative variance without roulette, and twice a ratio to it with its standard error.

    ``without`` and ``rejecting`` are (seeds, 2, height, width), after as many iterations and after as much
    time, and have the same photons; 6 seeds or more. Roulette's own noise is then what they differ by, and it
    adds to the variance that the photons bring: E[X'] = X given the photons, so
    Var X' = Var X + E[(X' - X)^2]. Relative is the mean over the pixels of variance / mean^2.
    """

    def relative(seeds: np.ndarray) -> np.ndarray:
        """Without roulette; with it after as many iterations; with it after as much time."""
        halves = seeds[seeds % 2 == 0], seeds[seeds % 2 == 1]
        return weighed(*halves) + weighed(*halves[::-1])

    def weighed(seeds: np.ndarray, others: np.ndarray) -> np.ndarray:
        # Means of other seeds: where a mean is low by chance, the variance of the same seeds is so too.
        mean = without[others, 0].mean(axis=0)
        weights = 0.5 / (mean**2 + (_DARK * mean.mean()) ** 2)
        plain, noisy = without[seeds], rejecting[seeds]
        photons = np.mean(plain.var(axis=0, ddof=1) * weights, axis=(1, 2))
        own = np.mean(np.mean((noisy - plain) ** 2, axis=0) * weights, axis=(1, 2))
        return np.array([photons[0], *(photons + own)])

    seeds = np.arange(len(without))
    whole = relative(seeds)
    # The jackknife: one seed is left out, then the next.
    left_out = np.array([relative(seeds[seeds != seed]) for seed in seeds])
    errors = np.sqrt((len(seeds) - 1) * np.var(left_out[:, 1:] / left_out[:, :1], axis=0))
    return float(whole[0]), *([float(value / whole[0]), float(error)] for value, error in zip(whole[1:], errors))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors, fits and ratios of variances that the benchmark's figures show."""

import numpy as np
import pytest

from benchmarks.device.statistics import block_error, fit_line, variances


def test_block_error_is_the_median_of_whole_blocks():
    reference = np.ones((5, 9))
    picture = np.kron([[1.0, 1.2], [1.0, 1.2]], np.ones((2, 4)))
    picture = np.pad(picture, ((0, 1), (0, 1)), constant_values=9.0)
    assert block_error(picture, reference, 4) == pytest.approx(0.1 / 1.1)
    assert block_error(picture, reference, 2) == pytest.approx(0.1 / 1.1)


def test_a_straight_line_is_found():
    x = np.array([1.0, 10.0, 100.0, 1000.0])
    fit = fit_line(x, 3.0 + 0.5 * x)
    assert fit == pytest.approx({"base_seconds": 3.0, "slope_seconds": 0.5, "greatest_relative_error": 0.0}, abs=1e-9)


def test_variance_of_roulette_doubles_that_of_independent_splats():
    """Poisson numbers of splats, each kept twice or not at all; four times the iterations quarter the variance."""
    rng = np.random.default_rng(5)
    counts = rng.poisson(20.0, (8, 5, 60, 50))  # seeds, 1 iteration and then 4 more, rows, columns
    kept = 2.0 * rng.binomial(counts, 0.5)
    without, rejecting = (
        np.stack([values[:, 0], values[:, 1:].mean(axis=1)], axis=1) for values in (counts.astype(float), kept)
    )
    variance, same_iterations, same_time = variances(without, rejecting)
    assert variance == pytest.approx(1 / 20, rel=0.1)
    for (ratio, error), expected in ((same_iterations, 2.0), (same_time, 0.5)):
        assert abs(ratio - expected) < 4 * error < 0.2 * expected

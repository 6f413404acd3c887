# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells of the emission's random numbers and how they are chosen."""

import numpy as np
import pytest

from rppm_addon.integrator.common.iteration import learns_after
from rppm_addon.integrator.lights import guide


@pytest.mark.parametrize("kind", guide.FINEST_CELLS)
@pytest.mark.parametrize("photons", [0, 1, 100, 5000, 1 << 20])
def test_cells_are_no_more_than_photons(kind, photons):
    cells = guide.cells_of(kind, photons)
    assert np.prod(cells) <= max(photons, 1)
    assert all(
        size & (size - 1) == 0 and 1 <= size <= most for size, most in zip(cells, guide.FINEST_CELLS[kind], strict=True)
    )
    assert np.prod(cells) == np.prod(guide.FINEST_CELLS[kind]) or np.prod(cells) > photons / 2


def test_cells_without_photons_are_taken_for_what_lies_around_them():
    left = np.zeros((4, 8))
    contributed = np.zeros((4, 8))
    left[:, :4], left[:, 4:] = 100, 100
    contributed[:, 4:] = 50
    left[0, 0] = left[0, 7] = 0
    contributed[0, 7] = 0
    estimate = guide.contribution_probability(left, contributed)
    assert estimate.shape == (4, 8)
    assert estimate[0, 0] < 0.05 < 0.4 < estimate[0, 7]
    np.testing.assert_allclose(estimate[1:, 4:], 0.5, atol=0.03)


def test_usefulness_converges_to_the_truth():
    truth = np.random.default_rng(1).random((2, 4, 1, 8))
    left = np.full(truth.shape, 1e7)
    np.testing.assert_allclose(guide.contribution_probability(left, left * truth), truth, atol=1e-5)


def test_every_cell_keeps_its_defensive_share():
    estimate = np.zeros(1024)
    estimate[7] = 1.0
    probability = guide.probabilities(estimate)
    assert probability.sum() == pytest.approx(1.0)
    assert probability.min() == pytest.approx(guide.DEFENSIVE_FRACTION / 1024) and probability[7] > 0.7


def test_starts_cut_32_bits_by_the_probabilities():
    probability = guide.probabilities(np.random.default_rng(2).random(60000))
    first = guide.starts(probability).astype(np.float64)
    assert first[0] == 0 and (np.diff(first) > 0).all()
    np.testing.assert_allclose(np.diff(np.append(first, 2.0**32)) / 2.0**32, probability, atol=2.0**-31)


def test_it_learns_at_powers_of_two_up_to_16():
    assert [iteration for iteration in range(1, 100) if learns_after(iteration)] == [1, 2, 4, 8, 16]

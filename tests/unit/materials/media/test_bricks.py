# SPDX-License-Identifier: GPL-3.0-or-later
"""Coefficients of media in sparse bricks of half floats."""

import numpy as np
import pytest

from rppm_addon.materials.media.bricks import BRICK_VOXELS, Lattice, brick_grid, usable

COLOR = np.array([0.2, 1.0, 0.5], np.float32)
BRICKS = 16


def densities(seed=1):
    return np.random.default_rng(seed).random((BRICKS, BRICK_VOXELS, 1)).astype(np.float32)


def words_of(channels):
    return BRICKS + BRICKS * BRICK_VOXELS // 2 * channels


def test_voxels_lie_on_the_corners_of_the_box():
    lattice = Lattice.of(np.array([-1.0, 0.0, 2.0]), np.array([1.0, 1.0, 4.0]), 0.3, 1000)
    assert lattice.voxels == (8, 5, 8)
    np.testing.assert_allclose(lattice.low + lattice.spacing * (np.array(lattice.voxels) - 1), [1.0, 1.0, 4.0])
    np.testing.assert_allclose(lattice.to_grid @ [-1.0, 0.0, 2.0, 1.0], [0.5, 0.5, 0.5, 1.0])
    np.testing.assert_allclose(lattice.to_grid @ [1.0, 1.0, 4.0, 1.0], [7.5, 4.5, 7.5, 1.0])


@pytest.mark.parametrize("size", [(1.0, 1.0, 1.0), (1.0, 0.01, 1.0), (100.0, 1.0, 0.0), (0.0, 0.0, 0.0)])
def test_a_lattice_has_at_most_so_many_voxels(size):
    lattice = Lattice.of(np.zeros(3), np.array(size), 1e-4, 100000)
    count = int(np.prod(lattice.voxels))
    assert min(lattice.voxels) >= 2 and count <= 100000
    assert count > 30000 or not any(size)
    assert np.isfinite(lattice.to_grid).all()


def test_a_density_of_one_color_takes_one_channel():
    """Shared by coefficients that are proportional; any other density takes a channel of its own."""
    density = densities()
    same = brick_grid((density * COLOR, 3.0 * density * COLOR[::-1], None))
    assert len(same.words) == words_of(1)
    np.testing.assert_allclose(same.scales[0] * 3.0, same.scales[1][::-1], rtol=1e-5)
    other = brick_grid((density * COLOR, densities(2) * COLOR, None))
    assert len(other.words) == words_of(2)


def test_several_colors_take_three_channels():
    grid = brick_grid((densities() * COLOR + densities(2) * COLOR[::-1], None, None))
    assert len(grid.words) == words_of(3)


def test_bricks_without_effect_take_no_memory():
    values = np.zeros((BRICKS, BRICK_VOXELS, 3), np.float32)
    values[5, 7] = 0.5
    grid = brick_grid((values, None, None))
    assert len(grid.words) == BRICKS + BRICK_VOXELS // 2
    assert np.flatnonzero(grid.words[: grid.table_size]).tolist() == [5]
    assert grid.words_at(100)[5] == grid.words[5] + 100


def test_no_medium_takes_a_table_alone():
    assert len(brick_grid((None, None, None)).words) == 1
    assert not brick_grid((np.zeros((BRICKS, BRICK_VOXELS, 3), np.float32), None, None)).words.any()


def test_any_density_is_stored_to_the_precision_of_half_floats():
    density = 1e6 * densities()
    grid = brick_grid((density * COLOR, None, None))
    stored = grid.words[BRICKS:].view("<f2").astype(np.float32).reshape(BRICKS, BRICK_VOXELS, 1) * grid.scales[0]
    np.testing.assert_allclose(stored, density * COLOR, rtol=2e-3, atol=1.0)


def test_what_cannot_be_rendered_counts_as_none():
    found = usable(np.array([np.nan, np.inf, -np.inf, -1.0, 1e30, 0.5], np.float32))
    np.testing.assert_array_equal(found, np.array([0.0, 0.0, 0.0, 0.0, 1e12, 0.5], np.float32))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells from which photons leave the grid of a medium."""

import numpy as np
import pytest

from rppm_addon.materials.media.bricks import BRICK_VOXELS, Lattice
from rppm_addon.materials.media.emission_cells import EmissionCells

ALL = 1 << 18
"""Cells, at most."""


def emission_of(lattice: Lattice, seed: int = 1, dark: float = 0.3) -> np.ndarray:
    """Random emission, of which a fraction of the voxels have none; (bricks, BRICK_VOXELS, 3)."""
    random = np.random.default_rng(seed)
    values = random.random((int(np.prod(lattice.bricks)), BRICK_VOXELS, 3)).astype(np.float32)
    return values * (random.random((*values.shape[:2], 1)) > dark)


def interpolated(values: np.ndarray) -> np.ndarray:
    """(x, y, z, 3) by voxel, what it adds to the integral of linear interpolation between the outermost voxels."""
    weights = [np.ones(size) for size in values.shape[:3]]
    for weight in weights:
        weight[[0, -1]] = 0.5
    return values * np.einsum("x,y,z->xyz", *weights)[..., None]


def probabilities(cells: EmissionCells) -> np.ndarray:
    return np.diff(np.append(cells.records[:, 1].astype(np.float64), 2.0**32)) / 2.0**32


def test_voxels_are_chosen_by_their_emission():
    lattice = Lattice((11, 9, 4), np.zeros(3), np.ones(3))
    emission = emission_of(lattice)
    cells = EmissionCells.of(emission, lattice)
    values = interpolated(lattice.in_order(emission))
    brightness = values.mean(axis=-1)
    number = cells.records[:, 0].astype(int)
    found = brightness[number % 11, number // 11 % 9, number // 99]
    assert cells.side == 1
    assert len(cells.records) == np.count_nonzero(brightness)
    np.testing.assert_allclose(cells.total, values.sum(axis=(0, 1, 2)), rtol=1e-5)
    np.testing.assert_allclose(probabilities(cells), found / brightness.sum(), rtol=1e-5)


def test_cells_of_many_voxels():
    """They hold all that shines, each as much as its voxels."""
    lattice = Lattice((81, 70, 65), np.zeros(3), np.ones(3))
    emission = emission_of(lattice, dark=0.0)
    cells = EmissionCells.of(emission, lattice)
    brightness = interpolated(lattice.in_order(emission)).mean(axis=-1)
    assert cells.side == 2
    assert len(cells.records) == 41 * 35 * 33 <= ALL
    for cell in (0, 1000, len(cells.records) - 1):
        number = int(cells.records[cell, 0])
        x, y, z = number % 81, number // 81 % 70, number // (81 * 70)
        part = brightness[x : x + 2, y : y + 2, z : z + 2].sum()
        assert probabilities(cells)[cell] == pytest.approx(part / brightness.sum(), rel=1e-3)


def test_each_cell_is_chosen_at_times():
    """However dark it is beside the others."""
    lattice = Lattice((8, 8, 8), np.zeros(3), np.ones(3))
    emission = np.full((1, BRICK_VOXELS, 3), 1e-12, np.float32)
    emission[0, 77] = 1e6
    cells = EmissionCells.of(emission, lattice)
    assert len(cells.records) == BRICK_VOXELS
    assert (probabilities(cells) > 0.0).all()


def test_nothing_that_shines():
    lattice = Lattice((8, 8, 8), np.zeros(3), np.ones(3))
    assert EmissionCells.of(np.zeros((1, BRICK_VOXELS, 3), np.float32), lattice) is None

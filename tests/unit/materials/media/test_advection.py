# SPDX-License-Identifier: GPL-3.0-or-later
"""Bricks and cells of grids whose values move."""

import numpy as np
import pytest

from rppm_addon.materials.media.advection import reached_bricks
from rppm_addon.materials.media.bricks import BRICK_SIDE, BRICK_VOXELS, Lattice
from rppm_addon.materials.media.emission_cells import EmissionCells
from rppm_addon.scene import VolumeGrid, VolumeMotion

LATTICE = Lattice((50, 41, 33), np.array([-1.0, 0.0, 2.0]), np.array([0.1, 0.2, 0.15]))
BRICKS = int(np.prod(LATTICE.bricks))


def at_lattice(values: np.ndarray) -> VolumeGrid:
    matrix = np.diag([*LATTICE.spacing, 1.0])
    matrix[:3, 3] = LATTICE.low
    return VolumeGrid(values, matrix)


def wind(random: np.random.Generator, strength: float) -> VolumeGrid:
    """Velocities in a part of the lattice."""
    matrix = np.diag([0.4, 0.5, 0.3, 1.0])
    matrix[:3, 3] = LATTICE.low + [0.5, 0.5, 0.5]
    return VolumeGrid((strength * (random.random((8, 9, 7, 3)) - 0.4)).astype(np.float32), matrix)


def filled_bricks(random: np.random.Generator, count: int) -> np.ndarray:
    """(bricks, BRICK_VOXELS, 1) float32 that is not 0 in a few bricks."""
    values = np.zeros((BRICKS, BRICK_VOXELS, 1), np.float32)
    values[random.choice(BRICKS, count, replace=False)] = random.random((count, BRICK_VOXELS, 1)) + 0.1
    return values


def brick_of(voxels: np.ndarray) -> np.ndarray:
    """(n,) numbers of the bricks of voxels (n, 3)."""
    x, y, _ = LATTICE.bricks
    i, j, k = (voxels // BRICK_SIDE).T
    return i + x * (j + y * k)


@pytest.mark.parametrize(("strength", "rest_time"), [(0.2, 0.5), (3.0, 0.5), (3.0, 0.0), (3.0, -0.5)])
def test_values_come_to_no_other_bricks(strength, rest_time):
    random = np.random.default_rng(1)
    motion = VolumeMotion(wind(random, strength), rest_time)
    values = filled_bricks(random, 8)
    filled = values.any(axis=(1, 2))
    reached = reached_bricks(filled, LATTICE, motion)
    assert (reached & filled == filled).all() and not reached.all()
    voxels = np.stack(np.meshgrid(*map(np.arange, LATTICE.voxels), indexing="ij"), axis=-1).reshape(-1, 3)
    density = at_lattice(LATTICE.in_order(values))
    seen = filled.copy()
    for time in (0.0, 0.3, 0.7, 1.0):
        found = density.at(motion.sources(LATTICE.low + LATTICE.spacing * voxels, time))[:, 0]
        seen[np.unique(brick_of(voxels[found > 1e-4]))] = True
    assert not (seen & ~reached).any()
    assert (seen & ~filled).any()


def test_velocities_elsewhere_reach_no_bricks():
    motion = VolumeMotion(VolumeGrid(np.ones((3, 3, 3, 3), np.float32), np.eye(4) + 100.0 * np.eye(4, k=3)), 0.5)
    filled = filled_bricks(np.random.default_rng(1), 3).any(axis=(1, 2))
    np.testing.assert_array_equal(reached_bricks(filled, LATTICE, motion), filled)


def test_cells_are_as_bright_as_on_average_while_the_shutter_is_open():
    way = np.broadcast_to(np.array([1.6, 0.0, 0.0], np.float32), (60, 50, 40, 3))
    matrix = np.diag([0.1, 0.2, 0.15, 1.0])
    matrix[:3, 3] = LATTICE.low - 0.5
    motion = VolumeMotion(VolumeGrid(way, matrix), 0.0)
    emission = np.zeros((BRICKS, BRICK_VOXELS, 3), np.float32)
    emission[1 + LATTICE.bricks[0] * (1 + LATTICE.bricks[1])] = [3.0, 2.0, 1.0]
    reached = reached_bricks(emission.any(axis=(1, 2)), LATTICE, motion)
    cells = EmissionCells.swept(emission, LATTICE, motion, reached)
    assert cells.side == 4
    np.testing.assert_allclose(cells.total, BRICK_VOXELS * np.array([3.0, 2.0, 1.0]))
    x = cells.records[:, 0] % LATTICE.voxels[0]
    parts = np.diff(np.append(cells.records[:, 1].astype(np.float64), 2.0**32)) / 2.0**32
    by_x = np.bincount(x // 4, parts, minlength=13)
    # A flame of two cells goes over four more; an eleventh of all is spread evenly.
    np.testing.assert_allclose(by_x[2:8], np.array([1, 3, 4, 4, 3, 1]) / 16.0 / 1.1, atol=0.03)
    assert (parts > 0.0).all() and 0.03 < 1.0 - by_x[2:8].sum() < 0.09


def test_what_does_not_shine_has_no_cells():
    motion = VolumeMotion(wind(np.random.default_rng(1), 1.0), 0.5)
    dark = np.zeros((BRICKS, BRICK_VOXELS, 3), np.float32)
    assert EmissionCells.swept(dark, LATTICE, motion, np.zeros(BRICKS, bool)) is None

# SPDX-License-Identifier: GPL-3.0-or-later
"""The kernel of photons around points in a grid: beyond a surface that ends the medium there are no photons, whether
the grid goes on behind it or ends there as well."""

from pathlib import Path

import numpy as np
import pytest
from support.iteration_block import iteration_buffer

from rppm_addon.gl.buffer_sets import BufferSet, StorageBuffer
from rppm_addon.gl.buffers.records import Record
from rppm_addon.gl.programs.bindings import ITERATION
from rppm_addon.integrator.media.scattering import MEDIUM_VERTEX
from rppm_addon.materials.media.bricks import BRICK_VOXELS, Lattice, brick_grid
from rppm_addon.materials.records import MEDIUM

Record("KernelTestParameters", count="uint", radius="float")
SHADER = str(Path(__file__).with_name("kernel_in_grids.comp"))
RAYS, RADIUS = 256, 0.2


class Tables(BufferSet):
    media = StorageBuffer("media", MEDIUM, block="Media")
    voxels = StorageBuffer("voxels", "uint", texel_bytes=4, block="MediumVoxels")
    segments = StorageBuffer("segments", MEDIUM_VERTEX, block="MediumVertices")
    rays = StorageBuffer("rays", "vec4", block="TestRays")
    results = StorageBuffer("results", "vec4", RAYS, block="Results")


def medium(low: float) -> tuple[np.ndarray, np.ndarray]:
    """MEDIUM records, and the words of a grid of even density from a height up to 1 m, and 1 m to all sides."""
    lattice = Lattice((32, 32, 32), np.array([-1.0, -1.0, low]), np.array([2.0, 2.0, 1.0 - low]) / 31.0)
    density = np.ones((int(np.prod(lattice.bricks)), BRICK_VOXELS, 3), np.float32)
    grid = brick_grid((None, density, None))
    records = MEDIUM.zeros(2)
    records["medium_bits"] = 2
    record = records[1]
    record["absorption"], record["scattering"], record["emission"] = grid.scales
    record["channels"], record["voxels"], record["first_word"] = grid.channels, lattice.voxels, 1
    for row in range(3):
        record[f"to_grid{row}"] = lattice.to_grid[row]
    return records, np.concatenate([np.zeros(1, np.uint32), grid.words_at(1)])


def weights(context, library, low: float, rays: np.ndarray, segments: np.ndarray) -> np.ndarray:
    """(RAYS,) factors of the photons' kernel."""
    tables = Tables(context, library)
    records, words = medium(low)
    tables.media.upload(records)
    tables.voxels.upload(words)
    tables.segments.upload(segments)
    tables.rays.upload(rays.astype(np.float32))
    program = library.compute(SHADER, {"MEDIA": 1, "HETEROGENEOUS_MEDIA": 1})
    iteration = iteration_buffer(context, number=3)
    program.run(RAYS, {**tables.blocks, ITERATION: iteration}, {"count": RAYS, "radius": RADIUS})
    results = tables.results.read(np.float32, 4 * RAYS).reshape(RAYS, 4)[:, 0].astype(np.float64)
    tables.release()
    return results


def kernel_above(heights: np.ndarray) -> np.ndarray:
    """The part of the kernel above a plane that lies so many radii below its center."""
    z = np.linspace(-1.0, 1.0, 4001)
    across = (1.0 - z**2) ** 2
    return np.array([across[z >= -height].sum() for height in heights]) / across.sum()


@pytest.mark.parametrize("low", [-1.0, 0.0], ids=["the grid goes on", "the grid ends"])
@pytest.mark.parametrize("begins", [True, False], ids=["from the floor", "to the floor"])
def test_a_floor_cuts_the_kernel(context, library, low, begins):
    random = np.random.default_rng(1)
    ways = random.normal(size=(RAYS, 3))
    ways[:, 2] = np.abs(ways[:, 2]) + 0.3
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    length = 0.6 / ways[:, 2]
    heights = random.uniform(0.05, 2.0, RAYS) * RADIUS
    floor = np.c_[random.uniform(-0.2, 0.2, (RAYS, 2)), np.zeros(RAYS)]
    points = floor + (heights / ways[:, 2])[:, None] * ways
    starts = floor if begins else floor + length[:, None] * ways
    ways = ways if begins else -ways
    distances = np.linalg.norm(points - starts, axis=1)
    segments = MEDIUM_VERTEX.zeros(RAYS)
    segments["far"] = length
    segments["near_loss" if begins else "far_loss"] = 1.0  # the normal, whose bits are 0, is upright
    rays = np.stack([np.c_[starts, distances], np.c_[ways, length]], axis=1)
    inside = np.abs(points[:, :2]).max(axis=1) < 1.0 - RADIUS
    assert inside.mean() > 0.5
    found = weights(context, library, low, rays, segments)
    expected = 1.0 / kernel_above(heights / RADIUS)
    np.testing.assert_allclose(found[inside], expected[inside], rtol=5e-3)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays through grids of media, against sums over many places along each ray in NumPy."""

from pathlib import Path

import numpy as np
import pytest
from support.iteration_block import iteration_buffer

from rppm_addon.gl.buffer_sets import BufferSet, StorageBuffer
from rppm_addon.gl.buffers.records import Record
from rppm_addon.gl.programs.bindings import ITERATION
from rppm_addon.materials.media.bricks import BRICK_VOXELS, Lattice, brick_grid
from rppm_addon.materials.records import MEDIUM

Record("GridTestParameters", count="uint", media="uint")
SHADER = str(Path(__file__).with_name("grid.comp"))
RAYS, PLACES = 256, 20000
BITS = 2
"""Bits of the number of a medium."""


class Tables(BufferSet):
    media = StorageBuffer("media", MEDIUM, block="Media")
    voxels = StorageBuffer("voxels", "uint", texel_bytes=4, block="MediumVoxels")
    rays = StorageBuffer("rays", "vec4", block="TestRays")
    results = StorageBuffer("results", "vec4", 4 * RAYS, block="Results")


class Field:
    """A medium with the coefficients of its voxels: extinction and emission, each (x, y, z, 3)."""

    def __init__(self, random, voxels, matrix, colors=1):
        self.matrix = np.asarray(matrix, np.float64)
        self.lattice = Lattice(voxels, np.full(3, -1.0), 2.0 / (np.array(voxels) - 1))
        bricks = int(np.prod(self.lattice.bricks))
        filled = random.integers(0, 2, (bricks, 1, 1))
        filled[0] = 1
        density = random.random((bricks, BRICK_VOXELS, colors)) * filled
        absorption = (density * np.array([0.5, 1.0, 2.0])).astype(np.float32)
        emission = (random.random((bricks, BRICK_VOXELS, 1)) * np.array([3.0, 2.0, 1.0])).astype(np.float32)
        self.grid = brick_grid((absorption, 0.5 * absorption, emission))
        self.extinction, self.emission = (self.lattice.in_order(values) for values in (1.5 * absorption, emission))

    @property
    def to_grid(self):
        return self.lattice.to_grid @ np.linalg.inv(self.matrix)

    def record(self, first):
        record = MEDIUM.zeros(1)[0]
        record["absorption"], record["scattering"], record["emission"] = self.grid.scales
        record["channels"], record["voxels"], record["first_word"] = self.grid.channels, self.lattice.voxels, first
        for row in range(3):
            record[f"to_grid{row}"] = self.to_grid[row]
        return record

    def along(self, origins, directions, distances, offsets):
        """Extinction and emission at PLACES places of each ray, (rays, PLACES, 3)."""
        t = distances[:, None] * (np.arange(PLACES) + 0.5) / PLACES
        places = origins[:, None] + t[..., None] * directions[:, None]
        cells = places @ self.to_grid[:3, :3].T + self.to_grid[:3, 3]
        inside = ((cells >= 0.5) & (cells <= np.array(self.lattice.voxels) - 0.5)).all(axis=-1)
        cells = np.clip(np.floor(cells + offsets[:, None]).astype(int), 0, np.array(self.lattice.voxels) - 1)
        index = tuple(np.moveaxis(cells, -1, 0))
        return tuple(values[index] * inside[..., None] for values in (self.extinction, self.emission))


def turned(angle, scale=1.0):
    c, s = scale * np.cos(angle), scale * np.sin(angle)
    return np.array([[c, -s, 0, 0.2], [s, c, 0, -0.1], [0, 0, 1.3, 0.05], [0, 0, 0, 1]])


def traced(context, library, records, fields, media, rays):
    tables = Tables(context, library)
    words, listed = [np.zeros(1, np.uint32)], list(records)
    for field in fields:
        first = sum(map(len, words))
        words.append(field.grid.words_at(first))
        listed.append(field.record(first))
    media_records = np.array(listed)
    media_records["medium_bits"] = BITS
    tables.media.upload(media_records)
    tables.voxels.upload(np.concatenate(words))
    tables.rays.upload(rays.astype(np.float32))
    iteration = iteration_buffer(context, number=3)
    program = library.compute(SHADER, {"MEDIA": 1, "HETEROGENEOUS_MEDIA": 1})
    program.run(RAYS, {**tables.blocks, ITERATION: iteration}, {"count": RAYS, "media": media})
    results = tables.results.read(np.float32, 16 * RAYS).reshape(RAYS, 4, 4).astype(np.float64)
    tables.release()
    return results


def random_rays(random):
    """(RAYS, 2, 4) float32: origin and distance, direction and a random number."""
    origins, targets = random.uniform(-2, 2, (RAYS, 3)), random.uniform(-1, 1, (RAYS, 3))
    directions = targets - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    directions[:6] = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    distances = random.uniform(0.5, 5.0, RAYS)
    u = random.random(RAYS)
    return np.stack([np.c_[origins, distances], np.c_[directions, u]], axis=1).astype(np.float32)


def split(rays):
    rays = rays.astype(np.float64)
    return rays[:, 0, :3], rays[:, 1, :3], rays[:, 0, 3], rays[:, 1, 3]


EVEN = MEDIUM.zeros(1)[0]


@pytest.mark.parametrize("colors", [1, 3], ids=["one channel", "three channels"])
@pytest.mark.parametrize("voxels", [(19, 8, 30), (2, 2, 2)])
def test_a_grid_along_rays(context, library, colors, voxels):
    random = np.random.default_rng(1)
    field = Field(random, voxels, turned(0.4), colors)
    rays = random_rays(random)
    results = traced(context, library, [EVEN], [field], 1, rays)
    origins, directions, distances, u = split(rays)
    offsets = results[:, 3, :3]
    assert (np.abs(offsets) <= 0.5).all() and (np.abs(offsets.mean(axis=0)) < 0.1).all()
    extinction, emission = field.along(origins, directions, distances, offsets)
    step = (distances / PLACES)[:, None, None]
    depths = np.cumsum(extinction * step, axis=1)
    np.testing.assert_allclose(results[:, 0, :3], depths[:, -1], rtol=2e-3, atol=2e-3)
    transmittance = np.exp(-(depths - 0.5 * extinction * step))
    np.testing.assert_allclose(results[:, 1, :3], (emission * transmittance * step).sum(axis=1), rtol=3e-3, atol=3e-3)
    assert_inverted(results[:, 0, 3], depths[..., 1], distances, u)
    at_half = extinction[:, PLACES // 2 - 1 : PLACES // 2 + 1]
    same = (at_half[:, 0] == at_half[:, 1]).all(axis=1)
    assert same.mean() > 0.95
    np.testing.assert_allclose(results[same, 2, :3], at_half[same, 0], rtol=2e-3, atol=1e-5)


def assert_inverted(flights, depths, distances, u):
    """The thickness of the channel up to the collision is -log(1 - u); rays without one have less in all."""
    targets = -np.log(1.0 - u)
    collides = flights < 1e29
    assert 0.1 < collides.mean() < 0.9
    clear = np.abs(targets / depths[:, -1].clip(1e-9) - 1.0) > 0.01
    np.testing.assert_array_equal(collides[clear], (targets < depths[:, -1])[clear])
    place = (flights[collides] / distances[collides] * PLACES).astype(int).clip(0, PLACES - 1)
    np.testing.assert_allclose(depths[collides, place], targets[collides], rtol=5e-3, atol=5e-3)


def test_grids_and_even_media_add_up(context, library):
    """Two grids that overlap, in a medium that is the same everywhere and beside that of the world."""
    random = np.random.default_rng(2)
    fields = [Field(random, (9, 9, 9), turned(0.1)), Field(random, (20, 10, 10), turned(1.0, 0.7))]
    world, body = MEDIUM.zeros(1)[0], MEDIUM.zeros(1)[0]
    world["absorption"], body["scattering"] = (0.1, 0.0, 0.2), (0.3, 0.2, 0.1)
    rays = random_rays(random)
    media = 1 | 2 << BITS | 3 << 2 * BITS
    results = traced(context, library, [world, body], fields, media, rays)
    origins, directions, distances, _ = split(rays)
    expected = (world["absorption"] + body["scattering"]) * distances[:, None]
    for field in fields:
        extinction, _ = field.along(origins, directions, distances, results[:, 3, :3])
        expected = expected + extinction.mean(axis=1) * distances[:, None]
    np.testing.assert_allclose(results[:, 0, :3], expected, rtol=2e-3, atol=2e-3)


def test_free_flights_through_several_media_are_exponential(context, library):
    """The thickness of a grid and a medium around it up to collisions is distributed as that of one medium."""
    random = np.random.default_rng(3)
    field = Field(random, (9, 9, 9), turned(0.1))
    body = MEDIUM.zeros(1)[0]
    body["absorption"] = 0.4
    rays = random_rays(random)
    rays[:, 0] = rays[6, 0]
    rays[:, 1, :3] = rays[6, 1, :3]
    results = traced(context, library, [EVEN, body], [field], 1 | 2 << BITS, rays)
    origins, directions, distances, _ = split(rays)
    extinction, _ = field.along(origins[:1], directions[:1], distances[:1], results[:1, 3, :3])
    depths = np.cumsum((extinction[0][:, 1] + 0.4) * distances[0] / PLACES)
    flights = np.sort(results[:, 0, 3])
    found = np.searchsorted(flights, np.linspace(0.0, distances[0], PLACES), side="right") / RAYS
    assert np.abs(found - (1.0 - np.exp(-depths))).max() < 1.63 / np.sqrt(RAYS)  # Kolmogorov and Smirnov, 1 %

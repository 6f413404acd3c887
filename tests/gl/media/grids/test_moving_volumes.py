# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes whose values move along velocities while the shutter is open."""

import functools
import math

import numpy as np
import pytest
from support.lobes import Lobe, LobeKind, material
from volume_boxes import COLOR, SIZE, STEP, VOXELS, grid_of, picture, scene_of

from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.materials.media.advection import MovingGrid, VoxelAdvection, reached_bricks
from rppm_addon.materials.media.bricks import BRICK_VOXELS, Lattice, brick_grid
from rppm_addon.scene import Material, NodeGraph, Shutter, Volume, VolumeGrid, VolumeMotion, World

OPEN = Shutter(np.ones(4))
HALF = 0.4
"""Half of the width of the slab at rest, meters."""


def slab(at):
    return np.abs(at[..., 0]) < HALF


def moving(way, rest_time=0.5, density=slab) -> Volume:
    """A density that moves evenly."""
    ways = grid_of(lambda at: np.broadcast_to(np.array(way), at.shape), 3)
    ways.values[:] = way
    return Volume({"density": grid_of(density)}, motion=VolumeMotion(ways, rest_time))


@pytest.mark.long
@pytest.mark.parametrize("rest_time", [0.0, 0.5, 1.5])
def test_a_slab_that_moves_evenly(renderer, rest_time):
    """Its transmittance is averaged over its places."""
    way = 0.6 if rest_time < 1.0 else 0.3
    volume = moving((way, 0.0, 0.0), rest_time)
    scene = scene_of(volume, iterations=32)
    scene.shutter = OPEN
    seen = picture(renderer, scene)
    density = volume.grids["density"]
    length = STEP * (VOXELS - 2)
    x = 1.6 * ((np.arange(SIZE) + 0.5) / SIZE - 0.5)
    expected = np.zeros((SIZE, 3))
    for time in (np.arange(64) + 0.5) / 64:
        places = np.stack([x - (time - rest_time) * way, 0.0 * x, 0.0 * x], axis=1)
        expected += np.exp(-COLOR * length * density.at(places)) / 64
    expected = np.broadcast_to(expected, seen.shape)
    np.testing.assert_allclose(seen, expected, rtol=6e-2)
    np.testing.assert_allclose(seen.mean(axis=(0, 1)), expected.mean(axis=(0, 1)), rtol=1e-2)


def test_a_shutter_that_opens_for_a_moment(renderer):
    """All has the place of that moment."""
    scene = scene_of(moving((0.8, 0.0, 0.0), 0.0), iterations=16)
    curve = np.zeros(256)
    curve[127:129] = 1.0
    scene.shutter = Shutter(curve)
    seen = picture(renderer, scene)
    at_rest = picture(
        renderer, scene_of(Volume({"density": grid_of(lambda at: slab(at - [0.4, 0, 0]))}), iterations=16)
    )
    np.testing.assert_allclose(seen, at_rest, rtol=4e-2)


def test_what_has_no_shutter_is_at_rest(renderer):
    """Bit for bit as without velocities."""
    still = picture(renderer, scene_of(Volume({"density": grid_of(slab)}), iterations=2))
    np.testing.assert_array_equal(picture(renderer, scene_of(moving((0.6, 0.0, 0.0)), iterations=2)), still)


def fire() -> Material:
    """Emission by the attribute "density"."""
    graph = NodeGraph()
    density = graph.add("attribute", "fac", attribute="density")
    graph.surface = graph.add("emission", "emission", color=(1.0, 0.5, 0.25), strength=density)
    return Material("fire", material("clear", Lobe(LobeKind.TRANSPARENT)).graph, graph, reads_grids=True)


def test_photons_leave_where_values_have_gone(renderer):
    """A small flame that moves aside emits as much light as at rest."""
    ball = functools.partial(np.linalg.norm, axis=-1)
    volume = moving((0.0, 0.0, 1.2), 0.0, lambda at: (ball(at) < 0.35) * 1.0)
    scene = scene_of(volume, fire(), iterations=16, photons=1 << 12)
    scene.shutter, scene.world = OPEN, World(np.zeros(3))
    emitted = renderer.render(scene).statistics.flux_watts["emitted"]
    total = STEP**3 * volume.grids["density"].values.sum(dtype=np.float64)
    assert emitted == pytest.approx(4.0 * math.pi * 1.75 * total, rel=0.03)


def lattice_and_values(random):
    lattice = Lattice((19, 16, 21), np.array([-1.0, -0.5, 0.0]), np.array([0.1, 0.12, 0.08]))
    bricks = int(np.prod(lattice.bricks))
    filled = random.random((bricks, 1, 1)) < 0.4
    density = (random.random((bricks, BRICK_VOXELS, 1)) * filled).astype(np.float32)
    return lattice, density * np.array([1.0, 0.5, 2.0], np.float32)


def wind(lattice, random, strength):
    """Velocities of few voxels around a part of a lattice."""
    matrix = np.diag([0.35, 0.4, 0.35, 1.0])
    matrix[:3, 3] = lattice.low + 0.1
    return VolumeGrid((strength * (random.random((5, 4, 5, 3)) - 0.5)).astype(np.float32), matrix)


@pytest.mark.parametrize("time", [0.0, 0.5, 1.0])
def test_voxels_have_the_values_of_their_sources(context, time):
    random = np.random.default_rng(1)
    lattice, absorption = lattice_and_values(random)
    motion = VolumeMotion(wind(lattice, random, 0.8), 0.5)
    reached = reached_bricks(absorption.any(axis=(1, 2)), lattice, motion)
    grid = brick_grid((absorption, absorption[..., ::-1] * random.random((*absorption.shape[:2], 1)), None), reached)
    advection = VoxelAdvection(context, ProgramLibrary(context))
    other = brick_grid((absorption, None, None), reached)
    advection.upload([MovingGrid(other, lattice, motion), MovingGrid(grid, lattice, motion)])
    first = 1 + len(other.words)
    words = np.concatenate([np.zeros(1, np.uint32), other.words_at(1), grid.words_at(first)])
    buffer = context.moderngl.buffer(words.tobytes())
    advection.run(time, [1, first], buffer)
    moved = np.frombuffer(buffer.read(), np.uint32)[first:]
    places = np.stack(np.meshgrid(*map(np.arange, lattice.voxels), indexing="ij"), axis=-1).reshape(-1, 3)
    sources = motion.sources(lattice.low + lattice.spacing * places, time)
    matrix = np.diag([*lattice.spacing, 1.0])
    matrix[:3, 3] = lattice.low
    low, high = lattice.low, lattice.low + lattice.spacing * (np.array(lattice.voxels) - 1)
    for channel in range(grid.channel_count):
        at_rest = VolumeGrid(lattice.in_order(unpacked(grid, grid.words, channel)), matrix)
        expected = at_rest.at(np.clip(sources, low, high)).reshape(*lattice.voxels, 1)
        found = lattice.in_order(unpacked(grid, moved, channel))
        np.testing.assert_allclose(found, expected, atol=1.5e-3)
        assert time == 0.5 or np.abs(found - at_rest.values).max() > 0.1
    np.testing.assert_array_equal(moved[: grid.table_size], grid.words_at(first)[: grid.table_size])


def unpacked(grid, words, channel):
    """(bricks, BRICK_VOXELS) values of a channel in words that begin with the table at rest."""
    values = np.zeros((grid.table_size, BRICK_VOXELS), np.float32)
    count = BRICK_VOXELS // 2
    for brick in np.flatnonzero(grid.words[: grid.table_size]):
        place = int(grid.words[brick]) + channel * count
        values[brick] = words[place : place + count].copy().view("<f2")
    return values

# SPDX-License-Identifier: GPL-3.0-or-later
"""Hits through either acceleration structure are those of testing every triangle, bit for bit."""

import numpy as np
import pytest
from deep_cubemap_rays import KINDS, make_rays
from deep_cubemap_scenes import PLAIN, bits, furnished_room, room_with_meshes

from rppm_addon.integrator.bvh.bvh import Bvh
from rppm_addon.integrator.common.records.rays import NO_TRIANGLE
from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap
from rppm_addon.self_test.ray_queries import TracedTriangles, ray_records


@pytest.fixture(params=[DeepCubemap, Bvh])
def traced(context, library, request):
    """Function that puts triangles into a structure, to trace rays through it."""
    opened = []

    def trace(triangles, center=PLAIN):
        structure = request.param(context, library)
        opened.append(TracedTriangles(context, library, triangles, center, structure=structure))
        return opened[-1]

    yield trace
    for scene in opened:
        scene.release()


def uniform_rays(count: int, seed: int) -> np.ndarray:
    return ray_records(*make_rays("uniform", count, PLAIN, seed))


@pytest.mark.parametrize("scale, offset", [(1.0, 0.0), (0.01, 0.0), (100.0, 0.0), (1.0, 1000.0), (0.01, 1.0)])
def test_hits_equal_those_of_brute_force(traced, scale, offset):
    scene = traced(
        furnished_room(4) * np.float32(scale) + np.float32(offset),
        np.float32(PLAIN) * np.float32(scale) + np.float32(offset),
    )
    for kind in KINDS:
        origins, directions = make_rays(kind, 20_000, PLAIN, seed=5)
        rays = ray_records(origins * np.float32(scale) + np.float32(offset), directions)
        hits = scene.trace(rays)
        np.testing.assert_array_equal(bits(hits), bits(scene.brute_force(rays)))
        inside = np.all(np.abs(origins) < 0.97, axis=1)
        assert np.all(hits["triangle"][inside] != NO_TRIANGLE)


def test_any_hit_decides_as_the_nearest_hit_does(traced):
    scene, rays, rng = traced(room_with_meshes(10_000)), uniform_rays(100_000, 7), np.random.default_rng(8)
    distances = scene.trace(rays)["distance"]
    # just reaching the hit, just not reaching it, and anything
    rays["maximum_distance"] = np.where(rng.random(len(rays)) < 0.5, distances, rng.uniform(0.0, 2.0, len(rays)))
    short = rng.random(len(rays)) < 0.3
    rays["maximum_distance"][short] = np.nextafter(distances[short], np.float32(0))
    free = scene.occluded(rays)
    np.testing.assert_array_equal(free, scene.trace(rays)["triangle"] == NO_TRIANGLE)
    np.testing.assert_array_equal(free == 1, rays["maximum_distance"] < distances)
    assert 0.2 < free.mean() < 0.8


def test_source_and_target_triangles_are_never_hit(traced):
    scene, rays = traced(furnished_room(4)), uniform_rays(20_000, 9)
    hits = scene.trace(rays)
    rays["source_triangle"] = hits["triangle"]
    assert not np.any(scene.trace(rays)["triangle"] == rays["source_triangle"])
    rays["source_triangle"], rays["maximum_distance"] = NO_TRIANGLE, hits["distance"]
    assert np.all(scene.occluded(rays) == 0)
    free = scene.occluded(rays, hits["triangle"])
    rays["source_triangle"] = hits["triangle"]
    np.testing.assert_array_equal(free == 1, scene.trace(rays)["triangle"] == NO_TRIANGLE)


def test_inactive_and_broken_rays_miss(traced):
    rays = uniform_rays(64, 11)
    rays["maximum_distance"][:16] = 0.0
    rays["maximum_distance"][16:24] = -1.0
    rays["maximum_distance"][24:32] = np.nan
    rays["origin"][32:36, 1] = np.nan
    rays["direction"][36:40] = np.inf
    rays["direction"][40:48] = 0.0
    rays["maximum_distance"][48:56] = np.inf
    scene = traced(room_with_meshes(10_000))
    hits, free = scene.trace(rays), scene.occluded(rays)
    assert np.all(hits["triangle"][:48] == NO_TRIANGLE) and np.all(free[:48] == 1)
    assert np.all(hits["triangle"][48:] != NO_TRIANGLE) and np.all(free[48:] == 0)


@pytest.mark.parametrize("count", [0, 1, 2, 3, 4, 5])
def test_few_triangles(traced, count):
    """Stacked up along x, seen along x."""
    corner = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], np.float32)
    scene = traced(np.array([corner + np.float32([1 + i, 0, 0]) for i in range(count)]).reshape(-1, 3, 3))
    origins = np.array([[0.0, 0.2, 0.2], [0.0, 0.8, 0.8]] + [[1.5 + i, 0.2, 0.2] for i in range(5)])
    rays = ray_records(origins, np.tile([1.0, 0.0, 0.0], (7, 1)))
    expected = [t if t < count else NO_TRIANGLE for t in (0, NO_TRIANGLE, 1, 2, 3, 4, NO_TRIANGLE)]
    np.testing.assert_array_equal(scene.trace(rays)["triangle"], expected)
    np.testing.assert_array_equal(scene.occluded(rays) == 1, np.equal(expected, NO_TRIANGLE))


def test_broken_triangles_do_no_harm(traced):
    room = furnished_room(4)
    broken = room[np.random.default_rng(14).integers(0, len(room), 60)].copy()
    broken[:20, 1, 2] = np.nan
    broken[20:30, 0] = np.inf
    broken[30:40, 2, 0] = -np.inf
    broken[40:50] = broken[40:50, :1]  # points
    broken[50:, 2] = broken[50:, 0]  # lines
    scene, whole = traced(np.concatenate([room, broken])), traced(room)
    for kind in KINDS:
        rays = ray_records(*make_rays(kind, 20_000, PLAIN, seed=15))
        np.testing.assert_array_equal(bits(scene.trace(rays)), bits(whole.trace(rays)))

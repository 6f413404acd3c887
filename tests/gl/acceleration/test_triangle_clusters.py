# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that stand in the lists of the deep cubemap together, as they do in scenes of many."""

import numpy as np
import pytest
import scenes
from deep_cubemap_hard_rays import KINDS, HardRays
from deep_cubemap_scenes import PLAIN, bits, furnished_room, room_with_meshes
from deep_cubemap_structure import read_structure
from moving_scenes import everything_moves, films_of_moved

from rppm_addon.integrator.deep_cubemap import clusters
from rppm_addon.integrator.deep_cubemap.clusters import Clusters
from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap
from rppm_addon.scene import AccelerationStructure
from rppm_addon.self_test.ray_queries import TracedTriangles


def clusters_of(cubemap: DeepCubemap) -> tuple[np.ndarray, np.ndarray]:
    """First triangle and size of each cluster that a list names, (n,) each."""
    found = np.unique(read_structure(cubemap).entries[:, 2])
    return found >> 2, 1 << (found & 3)


def triangles_of(firsts: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Sorted numbers of the triangles of all clusters, each as often as it is in one."""
    return np.sort(np.concatenate([np.arange(first, first + size) for first, size in zip(firsts, sizes)]))


@pytest.fixture(scope="module")
def meshes():
    return room_with_meshes(3_000)


@pytest.mark.parametrize("rasterize, max_cluster_size", [(False, 2), (False, 4), (True, 4), (False, 8)])
def test_clusters_change_no_hit(context, library, meshes, rasterize, max_cluster_size):
    rays = np.concatenate([HardRays(meshes, PLAIN, seed=31).rays(kind, 1000) for kind in KINDS])
    with TracedTriangles(context, library, meshes, PLAIN, 0, rasterize, max_cluster_size=1) as scene:
        expected, free, fragments = scene.trace(rays), scene.occluded(rays), scene.structure.counts["fragment"]
    with TracedTriangles(context, library, meshes, PLAIN, 0, rasterize, max_cluster_size=max_cluster_size) as scene:
        np.testing.assert_array_equal(bits(scene.trace(rays)), bits(expected))
        np.testing.assert_array_equal(scene.occluded(rays), free)
        assert scene.structure.counts["fragment"] < 0.75 * fragments


@pytest.mark.parametrize("max_cluster_size", [2, 8])
def test_each_triangle_is_in_one_cluster(context, library, meshes, max_cluster_size):
    odd = meshes[:-3]  # the last cluster is not full
    with TracedTriangles(context, library, odd, PLAIN, 0, max_cluster_size=max_cluster_size) as scene:
        firsts, sizes = clusters_of(scene.structure)
    np.testing.assert_array_equal(triangles_of(firsts, sizes), np.arange(len(odd)))
    np.testing.assert_array_equal(firsts % sizes, 0)
    assert sizes.max() == max_cluster_size and sizes.mean() > 0.6 * max_cluster_size


def test_triangles_that_lie_apart_stay_alone(context, library, meshes):
    """In no order at all, and the hits are still right."""
    mixed = np.random.default_rng(32).permutation(meshes)
    rays = HardRays(mixed, PLAIN, seed=33).rays("uniform", 2000)
    with TracedTriangles(context, library, mixed, PLAIN, 0, max_cluster_size=8) as scene:
        firsts, sizes = clusters_of(scene.structure)
        np.testing.assert_array_equal(bits(scene.trace(rays)), bits(scene.brute_force(rays)))
    assert sizes.mean() < 1.1
    np.testing.assert_array_equal(triangles_of(firsts, sizes), np.arange(len(mixed)))


def test_broken_triangles_spoil_no_cluster(context, library):
    room = furnished_room(4)
    with_broken = np.repeat(room, 2, axis=0)
    with_broken[1::2, 1, 2] = np.nan
    with_broken[1::6, 0] = np.inf
    rays = HardRays(room, PLAIN, seed=34).rays("uniform", 5000)
    with (
        TracedTriangles(context, library, with_broken, PLAIN, 0, max_cluster_size=8) as scene,
        TracedTriangles(context, library, room, PLAIN, 0, max_cluster_size=8) as whole,
    ):
        found, expected = scene.trace(rays), whole.trace(rays)
    expected["triangle"] *= 2
    np.testing.assert_array_equal(bits(found), bits(expected))


@pytest.mark.parametrize("count, max_size", [(0, 1), ((1 << 20) - 1, 1), (1 << 20, 4), (1 << 24, 8), (1 << 26, 8)])
def test_large_scenes_have_clusters(count, max_size):
    assert Clusters.of_scene(count).max_size == max_size


def test_pictures_are_the_same(mapper, other_mapper, monkeypatch):
    """Instances, one of them shining, move while the shutter is open; in the second picture one has been moved."""
    room = scenes.crowded_room(
        16, photons=256, camera_path_length=3, photon_path_length=3,
        acceleration_structure=AccelerationStructure.DEEP_CUBEMAP,
    )  # fmt: skip
    scene = everything_moves(room, 1.0)
    expected = films_of_moved(mapper, scene)
    monkeypatch.setattr(clusters, "SCENE_CLUSTER_SIZES", {1: 4})
    np.testing.assert_array_equal(films_of_moved(other_mapper, scene), expected)
    assert other_mapper.deep_cubemap.counts["fragment"] < mapper.deep_cubemap.counts["fragment"]
    assert not np.array_equal(*expected)

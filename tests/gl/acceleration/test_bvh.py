# SPDX-License-Identifier: GPL-3.0-or-later
"""Hits through the BVH are those of the deep cubemap, bit for bit, and its hierarchy holds what it should."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
import scenes
from deep_cubemap_rays import KINDS, make_rays
from deep_cubemap_scenes import PLAIN, bits, room_with_meshes
from moving_scenes import everything_moves, films_of_moved
from support.acceleration.hierarchies import HARD, assert_boxes_enclose, depth_of, leaves_of

from rppm_addon.gl.context.context import Context
from rppm_addon.integrator.bvh import bvh, clustering, leaves
from rppm_addon.integrator.device_scene.acceleration import Acceleration
from rppm_addon.scene import AccelerationStructure
from rppm_addon.scene.errors import DeviceError
from rppm_addon.scene.passes import DEEP_CUBEMAP
from rppm_addon.self_test.ray_queries import TracedTriangles, ray_records


def test_hits_equal_those_of_a_deep_cubemap(context, library):
    meshes, structure = room_with_meshes(100_000), bvh.Bvh(context, library)
    with (
        TracedTriangles(context, library, meshes, PLAIN, structure=structure) as scene,
        TracedTriangles(context, library, meshes, PLAIN, 0) as cubemap,
    ):
        for kind in KINDS:
            rays = ray_records(*make_rays(kind, 50_000, PLAIN, seed=6))
            np.testing.assert_array_equal(bits(scene.trace(rays)), bits(cubemap.trace(rays)))


@pytest.mark.parametrize("place", HARD)
def test_hierarchies_hold_each_box_once_and_are_not_deep(place):
    low = HARD[place](np.random.default_rng(3), 3001).astype(np.float32)
    numbered = np.uint32(leaves.LEAF) | np.arange(3001, dtype=np.uint32)
    nodes = clustering.build_nodes(low, low + np.float32(0.01), numbered.copy())
    np.testing.assert_array_equal(leaves_of(nodes), numbered)
    assert_boxes_enclose(nodes)
    assert depth_of(nodes) <= clustering.MAX_DEPTH


def test_hierarchies_are_the_same_each_time():
    """Whatever the number of threads that build them."""
    low = np.random.default_rng(4).normal(size=(3, 50_000)).astype(np.float32)
    numbered = np.uint32(leaves.LEAF) | np.arange(50_000, dtype=np.uint32)
    built = [clustering.build_nodes(low.copy(), low + np.float32(0.01), numbered.copy()) for _ in range(2)]
    np.testing.assert_array_equal(*built)
    assert depth_of(built[0]) < 40


def test_quadrilaterals_share_a_leaf():
    """Two triangles that do not lie together share none."""
    square = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]], np.float32)
    strangers = square + np.float32([[[5, 0, 0]], [[0, 0, 9]]])
    nodes = leaves.triangle_nodes(np.concatenate([square, strangers]), 0.0)
    np.testing.assert_array_equal(leaves_of(nodes) & 3, [2, 1, 1])
    np.testing.assert_array_equal((leaves_of(nodes) & ~np.uint32(leaves.LEAF)) >> 2, [0, 2, 3])


def test_what_the_device_cannot_hold_is_an_error(context, library, monkeypatch):
    monkeypatch.setattr(Context, "array_limit", lambda *_: 1 << 16)
    with pytest.raises(DeviceError, match="BVH nodes needs .*simplify the geometry"):
        TracedTriangles(context, library, room_with_meshes(10_000), PLAIN, structure=bvh.Bvh(context, library))


def films(mapper, scene, structure):
    """Return the radiance of a scene, and that after an object was moved."""
    scene = dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, acceleration_structure=structure))
    return films_of_moved(mapper, scene)


def test_pictures_are_the_same(mapper):
    """Through either structure, of instances that move while the shutter is open; and where one has been moved."""
    scene = everything_moves(scenes.crowded_room(16, photons=256, camera_path_length=3, photon_path_length=3), 1.0)
    expected = films(mapper, scene, AccelerationStructure.DEEP_CUBEMAP)
    assert "deep cubemap cells" in mapper.memory_bytes
    found = films(mapper, scene, AccelerationStructure.BVH)
    assert "BVH nodes" in mapper.memory_bytes and "deep cubemap cells" not in mapper.memory_bytes
    np.testing.assert_array_equal(found, expected)
    assert not np.array_equal(*expected)


@pytest.mark.parametrize("is_software", [False, True])
def test_a_software_driver_traces_through_the_bvh(library, is_software):
    scene = scenes.room(16)
    choice = Acceleration(SimpleNamespace(is_software=is_software), library)
    expected = AccelerationStructure.BVH if is_software else AccelerationStructure.DEEP_CUBEMAP
    assert choice.kind(scene) is expected
    pictured = dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, passes=(DEEP_CUBEMAP.name,)))
    assert choice.kind(pictured) is AccelerationStructure.DEEP_CUBEMAP


def test_a_camera_that_moves_builds_no_bvh(mapper, monkeypatch):
    scene = scenes.room(16, acceleration_structure=AccelerationStructure.BVH)
    mapper.build(scene)
    monkeypatch.setattr(bvh.Bvh, "build", lambda *_: pytest.fail("built again"))
    matrix = np.array(scene.camera.matrix)
    matrix[:3, 3] += 0.3
    mapper.update(dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, matrix=matrix)))

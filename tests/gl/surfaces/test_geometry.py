# SPDX-License-Identifier: GPL-3.0-or-later
"""Gathering on the GPU against NumPy."""

import dataclasses

import numpy as np
import pytest
import scenes
from packed_normals import unpack

from rppm_addon.gl.buffers.buffers import GrowingBuffer
from rppm_addon.integrator.common.records.triangles import TRIANGLE_ATTRIBUTES
from rppm_addon.integrator.surfaces.geometry import Geometry
from rppm_addon.scene import Camera, Instance, Scene
from rppm_addon.scene.errors import DeviceError

CAMERA = Camera(np.eye(4), (-1, 1, -1, 1), 4, 4)


@pytest.fixture
def geometry(context, library):
    geometry = Geometry(context, library)
    yield geometry
    geometry.release()


def read(geometry):
    triangles = geometry.triangles.read(np.float32, 12 * geometry.triangle_count).reshape(-1, 3, 4)[..., :3]
    return triangles, geometry.attributes.read(TRIANGLE_ATTRIBUTES.dtype, geometry.triangle_count)


def assert_as_built_anew(geometry, context, library, scene):
    fresh = Geometry(context, library)
    fresh.build(scene, 0)
    for ours, anew in zip((*read(geometry), geometry.bounds_low), (*read(fresh), fresh.bounds_low), strict=True):
        assert ours.tobytes() == anew.tobytes()
    fresh.release()


def turned_instances(rng, count):
    """Instances of the first mesh, linearly mapped at random, some of them mirrored."""
    matrices = np.tile(np.eye(4), (count, 1, 1))
    matrices[:, :3] = rng.normal(size=(count, 3, 4))
    return [Instance(0, matrix, [0]) for matrix in matrices]


def test_triangles_of_more_than_a_block_are_the_same(context, library, geometry, monkeypatch):
    instances = turned_instances(np.random.default_rng(5), 12)
    ball = scenes.sphere("ball", 9, 5)
    scene = Scene(CAMERA, [ball], instances, [scenes.diffuse(1, 1, 1)])
    geometry.build(scene, 1)
    assert len(geometry.triangles.ranges(geometry.triangle_count)) == 1 and geometry.triangle_count > 600
    monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", 48 * 300)
    parts = Geometry(context, library)
    parts.build(scene, 1)
    ranges = parts.triangles.ranges(parts.triangle_count)
    assert [part.first for part in ranges] == list(range(0, parts.triangle_count, 256))
    assert sum(part.count for part in ranges) == parts.triangle_count
    for found, expected in zip(read(parts), read(geometry), strict=True):
        np.testing.assert_array_equal(found, expected)
    parts.release()


def test_instances_are_gathered_as_numpy_does(geometry):
    rng = np.random.default_rng(4)
    ball, sheet = scenes.sphere("ball", 9, 5), scenes.rectangle("sheet", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))
    sheet.corner_uv = rng.random((4, 2), np.float32)
    ball.triangle_slots = rng.integers(0, 4, ball.triangle_count).astype(np.int32)
    instances = turned_instances(rng, 40)
    for index, instance in enumerate(instances):
        instance.mesh, instance.materials = index % 2, [1, 0, 2] if index % 2 == 0 else [2]
        instance.object_index = index
    scene = Scene(CAMERA, [ball, sheet], instances, [scenes.diffuse(1, 1, 1)] * 3)
    geometry.build(scene, 3)
    triangles, attributes = read(geometry)
    assert geometry.triangle_count == scene.triangle_count
    first = 0
    for number, instance in enumerate(instances):
        mesh = scene.meshes[instance.mesh]
        linear = instance.matrix[:3, :3]
        order = [0, 2, 1] if np.linalg.det(linear) < 0 else [0, 1, 2]
        corners = mesh.triangle_corners[:, order]
        world = mesh.positions[mesh.corner_vertices[corners]] @ linear.T + instance.matrix[:3, 3]
        part = slice(first, first + mesh.triangle_count)
        np.testing.assert_allclose(triangles[part], world, atol=3e-6)
        normals = mesh.corner_normals[corners] @ np.linalg.inv(linear)
        normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
        packed = np.stack([attributes[f"normal{k}"][part] for k in range(3)], 1)
        assert (unpack(packed) * normals).sum(-1).min() > 1 - 1e-6
        # the geometric normal stays outside, mirrored or not
        face = np.cross(triangles[part, 1] - triangles[part, 0], triangles[part, 2] - triangles[part, 0])
        local = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]]
        outside = np.cross(local[:, 1] - local[:, 0], local[:, 2] - local[:, 0]) @ np.linalg.inv(linear)
        assert ((face * outside).sum(-1) > 0).all()
        slots = np.minimum(mesh.triangle_slots, len(instance.materials) - 1)
        np.testing.assert_array_equal(attributes["material"][part], np.array(instance.materials)[slots])
        assert (attributes["instance"][part] == number).all()
        if mesh.corner_uv is not None:
            uv = np.stack([attributes[f"uv{k}"][part] for k in range(3)], 1)
            np.testing.assert_array_equal(uv, mesh.corner_uv[corners])
        first += mesh.triangle_count
    assert (triangles.reshape(-1, 3) >= geometry.bounds_low - 1e-5).all()
    assert (triangles.reshape(-1, 3) <= geometry.bounds_high + 1e-5).all()


def test_spoiled_input_leaves_the_rest_whole(geometry):
    sheet = scenes.rectangle("sheet", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))
    broken = scenes.rectangle("broken", (0, 0, 5), (1, 0, 5), (1, 1, 5), (0, 1, 5))
    broken.positions[3] = np.nan
    broken.corner_normals[:] = np.nan
    spoiled = [Instance(0, np.zeros((4, 4))), Instance(0, np.full((4, 4), np.inf))]
    instances = [Instance(0, np.eye(4)), Instance(1, np.eye(4), [7]), *spoiled]
    scene = Scene(CAMERA, [sheet, broken], instances, [scenes.diffuse(1, 1, 1)])
    geometry.build(scene, 1)
    triangles, attributes = read(geometry)
    assert np.isfinite(triangles).all()
    np.testing.assert_array_equal(triangles[0], sheet.positions[:3])
    np.testing.assert_array_equal(triangles[2], broken.positions[:3])  # its own corners are all finite
    for dead in (3, 4, 5, 6, 7):
        assert np.ptp(triangles[dead], axis=0).max() == 0
    assert (attributes["material"] == 1).all()  # no slot and a slot out of range take the default
    normal = unpack(attributes["normal0"][2:3])[0]
    np.testing.assert_allclose(normal, [0, 0, 1], atol=1e-4)
    np.testing.assert_allclose(geometry.bounds_high, [1, 1, 5])


def test_an_empty_scene_has_no_triangles(geometry):
    geometry.build(Scene(CAMERA), 0)
    assert geometry.triangle_count == 0 and geometry.radius > 0


@pytest.fixture
def written(monkeypatch):
    """Names of the buffers that are written to."""
    names = []
    plain = GrowingBuffer.write

    def write(self, array, offset=0):
        names.append(self.name.removeprefix("geometry "))
        plain(self, array, offset)

    monkeypatch.setattr(GrowingBuffer, "write", write)
    return names


def test_moving_instances_uploads_no_mesh(geometry, written):
    mesh = scenes.sphere("ball", 9, 5)
    scene = Scene(CAMERA, [mesh], [Instance(0, np.eye(4), [0])], [])
    geometry.build(scene, 0)
    before, _ = read(geometry)
    assert "Positions" in written
    written.clear()
    scene.instances = [Instance(0, scenes.placed(1, 2, 3), [0])]
    geometry.build(scene, 0)
    after, _ = read(geometry)
    assert written == ["Instances", "SlotMaterials"]
    np.testing.assert_allclose(after, before + np.float32([1, 2, 3]), atol=1e-6)
    np.testing.assert_allclose([geometry.bounds_low, geometry.bounds_high], [[0, 1, 2], [2, 3, 4]], atol=0.2)
    scene.meshes = [scenes.sphere("ball", 9, 7)]
    geometry.build(scene, 0)
    assert "Positions" in written and geometry.triangle_count == scene.triangle_count


def test_bending_a_mesh_uploads_its_positions_and_normals(geometry, context, library, written):
    meshes = [scenes.sphere("small", 9, 5), scenes.sphere("bent", 12, 7), scenes.sphere("last", 5, 4)]
    instances = [Instance(index, scenes.placed(3.0 * index, 0, 0), [0]) for index in (0, 1, 2, 1)]
    scene = Scene(CAMERA, meshes, instances, [])
    geometry.build(scene, 0)
    for changes in (
        {1: ("positions", "corner_normals")},
        {1: ("positions",), 2: ("positions",)},
        {0: ("positions",), 2: ("positions",)},
        {0: ("triangle_slots",)},
    ):
        for index, members in changes.items():
            arrays = {member: getattr(scene.meshes[index], member)[::-1].copy() for member in members}
            scene.meshes[index] = dataclasses.replace(scene.meshes[index], **arrays)
        written.clear()
        geometry.build(scene, 0)
        members = {member.title().replace("_", "") for members in changes.values() for member in members}
        assert set(written) == {"Instances", "SlotMaterials", *members}
        assert_as_built_anew(geometry, context, library, scene)


def test_meshes_that_come_and_go_find_their_places(geometry, context, library):
    chance = np.random.default_rng(7)
    meshes = [scenes.sphere(str(index), 5 + index, 4) for index in range(6)]
    meshes[3].corner_uv = chance.random((len(meshes[3].corner_vertices), 2)).astype(np.float32)
    for _ in range(12):
        chosen = [meshes[index] for index in chance.permutation(6)[: chance.integers(0, 7)]]
        instances = [
            Instance(int(chance.integers(len(chosen))), scenes.placed(*chance.random(3)), [0])
            for _ in range(chance.integers(0, 9) if chosen else 0)
        ]
        scene = Scene(CAMERA, chosen, instances, [])
        geometry.build(scene, 0)
        assert_as_built_anew(geometry, context, library, scene)


def test_too_many_triangles_are_named(context, geometry, monkeypatch):
    """With the objects that have the most of them."""
    ball = scenes.sphere("ball", 9, 5)
    instances = [Instance(0, np.eye(4), [0], name) for name in ["moss"] + ["grass"] * 9]
    scene = Scene(CAMERA, [ball], instances, [scenes.diffuse(1, 1, 1)])
    each = ball.triangle_count
    monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", 48 * each * 9)
    monkeypatch.setitem(context.__dict__, "max_texels", 64)
    most = f'{9 * each} of "grass", {each} of "moss"; {9 * each} have room'
    said = f"world triangles needs .*Simplify .*of {10 * each} triangles, .* {most}"
    with pytest.raises(DeviceError, match=said):
        geometry.build(scene, 1)


def test_what_a_failed_build_has_lost_is_gathered_again(context, geometry, monkeypatch):
    """Where there was room for world triangles, but not for their attributes."""
    ball = scenes.sphere("ball", 9, 5)
    few = Scene(CAMERA, [ball], turned_instances(np.random.default_rng(5), 2), [scenes.diffuse(1, 1, 1)])
    many = dataclasses.replace(few, camera=dataclasses.replace(CAMERA, width=256, height=256))

    def in_object_space() -> bytes:
        geometry.build(few, 0, instanced=lambda columns: np.ones(len(columns.meshes), bool))
        first, count = geometry.instanced.mesh_first_triangles[0], ball.triangle_count
        return geometry.triangles.read(np.float32, 12 * count, 48 * first).tobytes()

    before = in_object_space()
    with monkeypatch.context() as patched:
        whole = context.storage_block_limit
        held = property(lambda buffer: buffer.size if buffer is geometry.attributes else whole)
        patched.setattr(GrowingBuffer, "limit", held)
        with pytest.raises(DeviceError, match="triangle attributes needs"):
            geometry.build(many, 0, instanced=lambda columns: np.ones(len(columns.meshes), bool))
    assert in_object_space() == before

# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera paths that begin on a mesh, where textures are baked."""

import numpy as np
import pytest
from rendering import radiance_of
from support.floor import floor_scene

from rppm_addon.integrator.common import band
from rppm_addon.scene import AccelerationStructure, Camera, Instance, Instancing, Texels
from rppm_addon.scene.errors import SceneError
from rppm_addon.self_test.meshes import placed, sphere

WIDTH, HEIGHT = 12, 8
DATA = ("Position", "Normal", "UV")


def baked_scene(matrix=None, **values):
    """The floor, of which a texture shows the left half of its first triangle and beside it nothing."""
    scene = floor_scene()
    if matrix is not None:
        scene.instances[0].matrix = matrix
    mesh = scene.meshes[0]
    mesh.corner_uv = np.float32([[0, 0], [1, 0], [1, 1], [0, 1]])
    x, y = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH, (np.arange(HEIGHT) + 0.5) / HEIGHT)
    second, third = 0.5 * x, 0.5 * y
    texels = Texels(
        instance=0,
        triangles=np.where(x < 0.75, 0, -1).astype(np.int32),
        barycentrics=np.stack([second, third], axis=-1).astype(np.float32),
        differentials=np.tile(np.float32([0.25 / WIDTH, 0.0, 0.0, 0.25 / HEIGHT]), (HEIGHT, WIDTH, 1)),
    )
    for name, value in values.items():
        setattr(texels, name, value)
    scene.camera = Camera(
        scene.camera.matrix, (0.0, WIDTH, 0.0, HEIGHT), WIDTH, HEIGHT, orthographic=True, texels=texels
    )
    scene.settings = scene.settings.with_values(iterations=1, passes=DATA, seed=3)
    return scene


def places(scene):
    """(HEIGHT, WIDTH, 3) where the texels' middles lie in the world."""
    mesh, texels = scene.meshes[0], scene.camera.texels
    corners = mesh.positions[mesh.corner_vertices[mesh.triangle_corners[0]]]
    second, third = np.moveaxis(texels.barycentrics, -1, 0)
    weights = np.stack([1.0 - second - third, second, third], axis=-1)
    matrix = scene.instances[0].matrix
    return weights @ corners @ matrix[:3, :3].T + matrix[:3, 3], weights @ mesh.corner_uv[mesh.triangle_corners[0]]


MIRRORED = np.diag([1.0, -0.5, 1.0, 1.0])


@pytest.mark.parametrize("matrix", [None, MIRRORED], ids=["plain", "mirrored"])
def test_the_first_sample_is_of_the_texels_middles(renderer, matrix, monkeypatch):
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", 3 * WIDTH)  # three rows at once
    scene = baked_scene(matrix)
    passes = renderer.render(scene).frame.passes
    on_mesh = scene.camera.texels.triangles >= 0
    points, uv = places(scene)
    np.testing.assert_allclose(passes["Position"][on_mesh], points[on_mesh], atol=1e-5)
    np.testing.assert_allclose(passes["UV"][on_mesh][:, :2], uv[on_mesh], atol=1e-6)
    # Of a mirrored mesh Blender mirrors the normals with it, as Cycles does.
    np.testing.assert_allclose(passes["Normal"][on_mesh], [[0, 0, 1]] * on_mesh.sum(), atol=1e-4)
    for name in DATA:
        assert (passes[name][~on_mesh] == 0.0).all()


def test_later_samples_are_spread_over_the_texel(renderer):
    scene = baked_scene()
    scene.settings = scene.settings.with_values(iterations=64)
    uv = renderer.render(scene).frame.passes["UV"][..., :2]
    on_mesh = scene.camera.texels.triangles >= 0
    _, middles = places(scene)
    # Sobol points: their mean is that of the texel within the 64th part of its width, with some to spare.
    half = np.float32([0.25 / WIDTH, 0.25 / HEIGHT])
    off = np.abs(uv - middles)[on_mesh]
    assert (off < 0.05 * half.max()).all() and (off > 0.0).any()


def test_a_part_of_a_texture_is_the_same_part_of_it(renderer):
    scene = baked_scene()
    whole = renderer.render(scene).frame
    texels = scene.camera.texels
    scene.camera.crop = (2, 3, 7, 8)
    part = np.s_[3:8, 2:7]
    texels.triangles, texels.barycentrics = texels.triangles[part], texels.barycentrics[part]
    texels.differentials = texels.differentials[part]
    for name in DATA:
        np.testing.assert_array_equal(renderer.render(scene).frame.passes[name], whole.passes[name][part])


def test_light_is_that_of_the_places(renderer):
    """Under a point light, a diffuse floor of albedo 0.5: 10 W/sr cos / d^2, of which 0.5 / pi goes each way."""
    scene = baked_scene()
    scene.settings = scene.settings.with_values(iterations=1, passes=(), photons=64)
    combined = renderer.render(scene).frame.combined
    on_mesh = scene.camera.texels.triangles >= 0
    points, _ = places(scene)
    to_lamp = np.array([-1.0, 1.0, 2.0]) - points
    distance = np.linalg.norm(to_lamp, axis=-1)
    expected = 10.0 * to_lamp[..., 2] / distance**3 * 0.5 / np.pi
    np.testing.assert_allclose(combined[on_mesh][:, 0], expected[on_mesh], rtol=1e-3)
    assert (combined[on_mesh][:, 3] == 1.0).all() and (combined[~on_mesh][:, :3] == 0.0).all()


def test_an_object_without_faces_says_so(renderer):
    scene = baked_scene()
    scene.meshes[0].triangle_corners = np.zeros((0, 3), np.int32)
    scene.meshes[0].triangle_slots = np.zeros(0, np.int32)
    with pytest.raises(SceneError, match='"Floor" has no faces that can be baked'):
        renderer.render(scene)


@pytest.mark.parametrize("structure", [AccelerationStructure.BVH, AccelerationStructure.DEEP_CUBEMAP])
def test_instances_around_what_is_baked_share_their_mesh(mapper, structure):
    """The floor, of which there is another one, among balls that hide lights: all that is not baked is placed by
    rays."""

    def baked(instancing: Instancing) -> np.ndarray:
        scene = baked_scene()
        scene.meshes.append(sphere("ball", 16, 8))
        scene.instances.append(Instance(0, placed(0.0, 0.0, 4.0), scene.instances[0].materials))
        for place in np.random.default_rng(5).uniform((-1, -1, 0.2), (1, 1, 1), (30, 3)):
            scene.instances.append(Instance(1, placed(*place, 0.1), scene.instances[0].materials))
        scene.settings = scene.settings.with_values(
            passes=(), photons=500, instancing=instancing, acceleration_structure=structure
        )
        return radiance_of(mapper, scene, 2)

    expanded = baked(Instancing.EXPANDED)
    in_levels = baked(Instancing.TWO_LEVELS)
    instanced = mapper.device_scene.geometry.instanced
    assert instanced is not None and len(instanced.which) == 30
    assert expanded[..., :3].std() > 0.01
    np.testing.assert_array_equal(in_levels, expanded)

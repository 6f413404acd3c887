# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's scene in the light that its shading popover asks for."""

from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, export, set_world
from emission import HEIGHT, world_map
from node_trees import add_node, link

from rppm_addon.blender.engine import studio_lights
from rppm_addon.blender.export.shading.lights.view_lighting import ViewLighting, blurred_panorama, relit, view_lighting
from rppm_addon.scene import Image

SKY = 0.25


@pytest.fixture
def lit_twice(scene):
    """A scene with a light and a world that has a sun."""
    add_light(scene, "POINT")
    world = set_world(scene, (SKY, SKY, SKY))
    sky = add_node(world.node_tree, "ShaderNodeTexSky")
    link(world.node_tree, sky.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])
    exported = export(scene)
    assert [light.of_world for light in exported.lights] == [False, True]
    return exported


def panorama(seed=3):
    pixels = np.random.default_rng(seed).random((16, 32, 4)).astype(np.float32)
    pixels[..., 3] = 1.0
    return Image("studio.exr", pixels)


def test_lights_and_world_are_switched_apart(lit_twice):
    assert relit(lit_twice, ViewLighting(), None) is lit_twice
    without_lights = relit(lit_twice, ViewLighting(use_scene_lights=False), None)
    assert [light.of_world for light in without_lights.lights] == [True]
    assert without_lights.world is lit_twice.world and without_lights.images is lit_twice.images
    without_world = relit(lit_twice, ViewLighting(use_scene_world=False), None)
    assert [light.of_world for light in without_world.lights] == [False]
    assert not relit(lit_twice, ViewLighting(False, False), None).lights


def test_a_studio_light_shines_and_its_background_is_seen(lit_twice):
    """The maps are those of what surfaces and of what the camera sees: the background is mixed by the path."""
    image = panorama()
    dark = relit(lit_twice, ViewLighting(use_scene_world=False, path="studio.exr", intensity=2.0), image)
    assert len(dark.images) == len(lit_twice.images) + 1 and dark.images[-1] is image
    assert dark.world.mist is lit_twice.world.mist
    shining = world_map(dark)
    assert shining.mean() == pytest.approx(2.0 * image.pixels[..., :3].mean(), rel=0.02)
    turned = world_map(relit(lit_twice, ViewLighting(False, False, "x", rotation=np.pi / 2, intensity=2.0), image))
    quarter = 2 * HEIGHT // 4
    shifts = [abs(np.roll(shining, shift, axis=1) - turned).mean() for shift in (quarter, -quarter, 0)]
    assert min(shifts[:2]) < 1e-3 * shining.mean() < 0.1 * shifts[2]
    blurred = relit(lit_twice, ViewLighting(False, False, "x", alpha=1.0, blur=0.5), image)
    assert len(blurred.images) == len(lit_twice.images) + 2
    again = relit(lit_twice, ViewLighting(False, False, "x", alpha=0.5, blur=0.5), image)
    assert again.images[-1] is blurred.images[-1]  # which is not uploaded anew
    kinds = [node.kind for node in blurred.world.graph.nodes]
    assert kinds.count("tex_environment") == 2 and "light_path" in kinds


def test_blur_is_even_over_the_sphere():
    """It keeps what is the same everywhere, and spreads a spot at a pole as one at the horizon."""
    flat = blurred_panorama(np.full((64, 128, 4), 0.5, np.float32), 0.3)
    np.testing.assert_allclose(flat[..., :3], 0.5, rtol=1e-5)
    assert (flat[..., 3] == 1.0).all()
    heights = []
    latitude = np.pi * ((np.arange(64) + 0.5) / 64 - 0.5)
    for row in (2, 32):
        spot = np.zeros((64, 128, 4), np.float32)
        spot[row, 40, :3] = 1.0 / np.cos(latitude[row])  # as much light
        heights.append(blurred_panorama(spot, 0.3)[..., 0].max())
    assert heights[0] == pytest.approx(heights[1], rel=0.05)


def test_what_the_shading_says(scene):
    world = set_world(scene)
    world.color = (0.1, 0.2, 0.3)
    shading = SimpleNamespace(
        use_scene_lights_render=False, use_scene_world_render=True, selected_studio_light=SimpleNamespace(path="a.exr"),
        studiolight_rotate_z=1.0, studiolight_intensity=3.0, studiolight_background_alpha=0.5,
        studiolight_background_blur=0.123,
    )  # fmt: skip
    assert view_lighting(shading, world) == ViewLighting(False)
    shading.use_scene_world_render = False
    found = view_lighting(shading, world)
    assert found.background == pytest.approx((0.1, 0.2, 0.3))
    assert (found.path, found.rotation, found.intensity, found.alpha, found.blur) == ("a.exr", 1.0, 3.0, 0.5, 0.12)
    assert view_lighting(shading, None).background == (0.0, 0.0, 0.0)


def test_studio_lights_are_read_when_nothing_is_drawn(scene, caplog):
    folder = Path(bpy.utils.system_resource("DATAFILES", path="studiolights/world"))
    path = str(folder / "interior.exr")
    images = len(bpy.data.images)
    assert studio_lights.picture(path) is None and studio_lights.picture("") is None
    assert studio_lights.picture("/nothing.exr") is None
    try:
        assert studio_lights.load_wanted() and not studio_lights.load_wanted()
        image = studio_lights.picture(path)
        assert image.pixels.shape[1] == 2 * image.pixels.shape[0] and image.pixels[..., :3].max() > 0.5
        assert image is studio_lights.picture(path) and len(bpy.data.images) == images
        assert studio_lights.picture("/nothing.exr") is None and "/nothing.exr cannot be read" in caplog.text
    finally:
        studio_lights.forget()

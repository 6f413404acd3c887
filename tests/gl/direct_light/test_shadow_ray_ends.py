# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow rays go as far as the light that they are for, and do not end on its own surface."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Light, LightKind, Material, Mesh, RayVisibility, Scene

PIXELS = 24


def from_above(height: float, half: float) -> Camera:
    camera = Camera(scenes.placed(0, 0, height), (-half / height, half / height) * 2, PIXELS, PIXELS)
    return dataclasses.replace(camera, clip_start=min(camera.clip_start, 0.0133 * height))


def over_floor(camera: Camera, floor: Mesh, *others: tuple[Mesh, Material], hidden: bool = True, **settings) -> Scene:
    """A gray floor below meshes that may be hidden from the camera."""
    scene = scenes.scene_of(camera, (floor, scenes.diffuse(0.8, 0.8, 0.8)), *others, photons=64, **settings)
    for instance in scene.instances[1:] if hidden else ():
        instance.visibility = RayVisibility.ALL & ~RayVisibility.CAMERA
    return scene


def lamp(height: float, strength: float) -> Light:
    return Light("lamp", LightKind.POINT, scenes.placed(0, 0, height), np.full(3, strength))


@pytest.mark.parametrize("height", [0.004, 4.0, 400.0])
def test_a_card_just_below_a_lamp_shades_the_floor(renderer, height):
    card = scenes.square("card", 0.0625 * height, height - height * 0.3 / 4000.0), scenes.diffuse(0.8, 0.8, 0.8)
    camera, floor = from_above(0.75 * height, 0.1 * height), scenes.square("floor", 0.125 * height)
    scene = over_floor(camera, floor, card, hidden=False, lights=[lamp(height, 100.0)], iterations=4)
    assert not renderer.render(scene).frame.combined[..., :3].any()


@pytest.mark.parametrize("gap", [1e-5, 1e-3])
def test_a_floor_close_to_a_large_glowing_panel_gets_all_its_light(renderer, gap):
    """A shadow ray is far shorter there than the triangles that it goes to are wide."""
    glow = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)))
    square = scenes.square("square", 2.0)
    scene = over_floor(from_above(2.0, 0.5), square, (square, glow), iterations=8, use_final_gather=False)
    scene.instances[0].matrix, scene.instances[1].matrix = scenes.placed(0.1, -0.1, 0), scenes.placed(0.3, 0.2, gap)
    seen = renderer.render(scene).frame.combined[..., :3]
    # The light of a direction is 2 cos(angle) times the mean, of variance 1 / 3 and more by the choice of a triangle.
    assert seen.mean() == pytest.approx(0.8, rel=4.0 * np.sqrt(0.5 / (8 * PIXELS**2)))


def test_a_lamp_nearer_behind_a_transparent_card_than_rays_begin_off_it_shines_through(renderer):
    height, gap = 1e-3, 2e-6
    card = scenes.square("card", 5.0, height - gap), material("clear", Lobe(LobeKind.TRANSPARENT))
    camera, floor = from_above(0.75 * height, 0.1 * height), scenes.square("floor", 5.0)
    settings = {"lights": [lamp(height, 1e-6)], "iterations": 1, "filter_width": 0.0}
    with_card, without = (
        renderer.render(over_floor(camera, floor, *cards, **settings)).frame.combined[..., :3] for cards in ([card], [])
    )
    assert (without > 0.0).all()
    np.testing.assert_allclose(with_card, without, rtol=1e-4)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounces and transparent surfaces on the way of light to the camera, against closed forms."""

import numpy as np
import pytest
import scenes
from rendering import radiance_of
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common import stage_sizes
from rppm_addon.scene import DensityEstimation, Light, LightKind, Scene
from rppm_addon.scene.meshes import RayVisibility

ALBEDO = 0.8
INTENSITY = 2.0
ONCE = {"photons": 64, "iterations": 1, "filter_width": 0.0, "passes": (), "max_bounces": 0}


def ball_room(albedo: float = ALBEDO, **settings) -> Scene:
    """The inside of a diffuse sphere of radius 1 around a point light, seen from the middle."""
    light = Light("light", LightKind.POINT, np.eye(4), np.full(3, INTENSITY))
    ball = scenes.sphere("ball", 96, 64), scenes.diffuse(albedo, albedo, albedo)
    fixed = {"photons": 4096, "iterations": 4, "filter_width": 0.0, "passes": ()}
    return scenes.scene_of(scenes.camera((0, 0, 0.01), (0, 1, 0.01), 1.5, 32), ball, lights=[light], **fixed | settings)


@pytest.mark.parametrize(
    ("bounces", "gathers", "route"),
    [
        (0, True, "GRID"), (1, True, "GRID"), (2, True, "GRID"), (2, True, "RASTERIZED"), (5, True, "GRID"),
        (0, False, "GRID"), (2, False, "GRID"), (2, False, "RASTERIZED"),
    ],
)  # fmt: skip
def test_bounces_of_photons_and_of_the_gathering_ray_add_up(renderer, bounces, gathers, route):
    """Each bounce brings as much light as the one before, times the albedo. Disks are flat and the ball is round: where
    the camera looks at photons they are many. The standard error is 0.4 %."""
    scene = ball_room(
        max_bounces=bounces, use_final_gather=gathers, density_estimation=DensityEstimation[route],
        photons=4096 if gathers else 16384,
    )  # fmt: skip
    seen = renderer.render(scene).frame.combined[..., 0].mean(dtype=float)
    expected = INTENSITY * ALBEDO / np.pi * sum(ALBEDO**k for k in range(bounces + 1))
    assert seen == pytest.approx(expected, rel=0.02)


def test_behind_the_last_bounce_paths_see_what_shines(renderer):
    """A glowing wall seen in a mirror; as in Cycles, where a mirror shows lamps with 0 bounces."""
    mirror = scenes.square("mirror", 1.0), material("mirror", Lobe(LobeKind.GLOSSY))
    above = scenes.rectangle("glow", (-1, -1, 3), (-1, 1, 3), (1, 1, 3), (1, -1, 3))
    glow, camera = material("glow", Lobe(LobeKind.EMISSION, color=(2.0, 2.0, 2.0))), ((0, -0.01, 2), (0, 0, 0), 0.1, 4)
    scene = scenes.scene_of(scenes.camera(*camera), mirror, (above, glow), **ONCE)
    np.testing.assert_allclose(renderer.render(scene).frame.combined[..., 0], 2.0, rtol=1e-5)


def behind_cards(cards: int, most: int, shown: RayVisibility = RayVisibility.ALL, **settings) -> Scene:
    """A floor of 2 m that glows below transparent cards."""
    side, clear = scenes.square("side", 1.0), material("card", Lobe(LobeKind.TRANSPARENT))
    parts = [(side, material("glow", Lobe(LobeKind.EMISSION))), *[(side, clear)] * cards]
    camera = scenes.camera((0, -0.01, 4), (0, 0, 0), 0.15, 8)
    scene = scenes.scene_of(camera, *parts, transparent_max_bounces=most, **ONCE | settings)
    for number, card in enumerate(scene.instances[1:], 1):
        card.matrix, card.visibility = scenes.placed(0, 0, 0.1 * number), shown
    return scene


@pytest.mark.parametrize("cards", [0, 1, 8])
def test_transparent_surfaces_are_no_bounces(renderer, cards):
    seen = renderer.render(behind_cards(cards, cards)).frame.combined[..., 0]
    np.testing.assert_allclose(seen, 1.0, rtol=1e-5)
    if cards:
        assert not renderer.render(behind_cards(cards, cards - 1)).frame.combined[..., :3].any()


def test_what_is_hidden_from_the_camera_counts_nowhere(renderer):
    """Behind twelve such cards the floor glows as without them."""
    seen = renderer.render(behind_cards(12, 0, RayVisibility.ALL & ~RayVisibility.CAMERA)).frame.combined[..., 0]
    np.testing.assert_allclose(seen, 1.0, rtol=1e-5)


@pytest.mark.parametrize("gathers", [True, False])
def test_light_and_camera_share_the_limit_of_transparent_surfaces(renderer, gathers):
    """Two cards above a floor: sunlight passes them, and so does the camera, which is four."""
    seen = []
    for most in (4, 3, 2):
        scene = behind_cards(2, most, photons=8192, iterations=8, use_final_gather=gathers)
        scene.materials[0] = material("floor", Lobe(LobeKind.DIFFUSE, color=(0.8,) * 3))
        sun = scenes.looking((0, -0.01, 3), (0, 0, 0))
        scene.lights = [Light("sun", LightKind.SUN, sun, np.full(3, np.pi))]
        seen.append(renderer.render(scene).frame.combined[..., 0].mean(dtype=float))
    assert seen[0] == pytest.approx(0.8, rel=0.05)
    assert seen[1:] == [0.0, 0.0]


def test_photons_take_the_memory_of_those_that_live(mapper, other_mapper, monkeypatch):
    """In a white room more of them than there is room for at first; the picture is the same bit for bit."""
    scene = ball_room(0.95, max_bounces=60, iterations=2)
    mapper.build(scene)
    before = mapper.memory_bytes["photons"]
    mapper.iterate()
    mapper.iterate()
    assert before == 64 * 4096 * 4 < mapper.memory_bytes["photons"] < 64 * 4096 * 30
    monkeypatch.setattr(stage_sizes, "SEGMENTS_AT_ONCE", 61)
    other_mapper.build(scene)
    assert other_mapper.memory_bytes["photons"] == 64 * 4096 * 61
    other_mapper.iterate()
    other_mapper.iterate()
    np.testing.assert_array_equal(mapper.film.read_radiance(), other_mapper.film.read_radiance())


def test_limits_that_no_path_comes_to_change_nothing(mapper, other_mapper):
    pictures, settings = [], {"photons": 512, "radius_scale": 60.0}
    for rendered, most in ((mapper, 60), (other_mapper, 1024)):
        scene = scenes.room(12, max_bounces=most, transparent_max_bounces=most, **settings)
        pictures.append(radiance_of(rendered, scene))
        assert rendered.memory_bytes["photons"] == 64 * 512 * 4
    np.testing.assert_array_equal(*pictures)

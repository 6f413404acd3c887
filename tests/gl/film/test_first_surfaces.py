# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth, normal and alpha of surfaces that light passes through."""

import numpy as np
import pytest
import scenes
from rendering import iterated
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Light, LightKind, Material, Scene
from rppm_addon.session.render.frame_reading import read_combined
from rppm_addon.session.viewport.presenter import film_picture


def behind_a_pane(material: Material, floor: bool = True) -> Scene:
    """A camera 3 m above a floor, with a pane of a material 1 m above it."""
    ground = scenes.polygons("floor", np.array([(-2, -2, -1), (2, -2, 1), (2, 2, 1), (-2, 2, -1)]), [(0, 1, 2, 3)])
    parts = [(scenes.square("pane", 1.0, 1.0), material), *[(ground, scenes.diffuse(1, 1, 1))] * floor]
    camera, sun = scenes.camera((0, 0, 3), (0, 0, 0), 0.2, 16), Light("sun", LightKind.SUN, np.eye(4), np.ones(3))
    settings = {"iterations": 64, "photons": 256, "filter_width": 0.0, "film_transparent": not floor}
    return scenes.scene_of(camera, *parts, lights=[sun], **settings)


def see_through(share: float) -> Material:
    return material("pane", Lobe(LobeKind.PRINCIPLED, alpha=1 - share))


@pytest.mark.parametrize(("share", "passed"), [(0.0, False), (0.3, False), (0.7, True), (1.0, True)])
def test_depth_and_normal_of_the_first_solid_surface(renderer, share, passed):
    frame = renderer.render(behind_a_pane(see_through(share))).frame
    x = (np.arange(16) + 0.5) / 16 * 0.4 - 0.2
    floor_depth = np.broadcast_to(3 / (1 + 0.5 * x), (16, 16))  # the plane z = x / 2
    np.testing.assert_allclose(frame.passes["Depth"], floor_depth if passed else 2.0, rtol=1e-4)
    normal = np.array([-0.5, 0, 1]) / np.sqrt(1.25) if passed else np.array([0, 0, 1.0])
    np.testing.assert_allclose(frame.passes["Normal"].mean((0, 1)), normal, atol=0.02)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.7, 1.0])
def test_alpha_is_what_hides_the_background(renderer, share):
    frame = renderer.render(behind_a_pane(see_through(share), floor=False)).frame
    assert frame.combined[..., 3].mean() == pytest.approx(1 - share, abs=0.02)


def test_glass_hides_the_background(renderer):
    pane = material("pane", Lobe(LobeKind.REFRACTION, ior=1.5))
    frame = renderer.render(behind_a_pane(pane, floor=False)).frame
    assert (frame.combined[..., 3] == 1).all()


def test_a_viewport_shows_the_pass_of_its_settings(mapper):
    scene = behind_a_pane(see_through(0.0))
    scene.exposure, scene.settings.passes = 3.0, ("Depth",)
    iterated(mapper, scene)
    picture = film_picture(mapper.film, scene)
    np.testing.assert_allclose(picture[..., :3], 2.0, rtol=1e-4)  # as gray, and not exposed
    assert (picture[..., 3] == 1.0).all()
    scene.settings.passes = ("Normal",)
    iterated(mapper, scene)
    np.testing.assert_allclose(film_picture(mapper.film, scene)[8, 8], (0, 0, 1, 1), atol=1e-3)
    scene.settings.passes = ()
    iterated(mapper, scene)
    np.testing.assert_array_equal(film_picture(mapper.film, scene), read_combined(mapper.film, 3.0))

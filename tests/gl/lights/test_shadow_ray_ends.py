# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow rays go as far as the light that they are for, and do not end on its own surface."""

import numpy as np
import pytest
from scenes import diffuse
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Instance, Light, LightKind, RayVisibility, RenderSettings, Scene
from rppm_addon.self_test.meshes import placed, rectangle

PIXELS = 24


def _square(half: float):
    return rectangle("square", (-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0))


def _from_above(height: float, half: float) -> Camera:
    return Camera(placed(0, 0, height), (-half / height, half / height) * 2, PIXELS, PIXELS)


@pytest.mark.parametrize("height", [0.004, 4.0, 400.0])
def test_a_card_just_below_a_lamp_shades_the_floor(renderer, height):
    gap = height * 0.3 / 4000.0
    scene = Scene(
        _from_above(0.75 * height, 0.1 * height),
        [_square(0.125 * height), _square(0.0625 * height)],
        [Instance(0, np.eye(4), [0]), Instance(1, placed(0, 0, height - gap), [0])],
        [diffuse(0.8, 0.8, 0.8)],
        [Light("lamp", LightKind.POINT, placed(0, 0, height), np.full(3, 100.0))],
        settings=RenderSettings(iterations=4, photons=64),
    )
    scene.camera.clip_start = 0.01 * height
    assert not renderer.render(scene).frame.combined[..., :3].any()


@pytest.mark.parametrize("gap", [1e-5, 1e-3])
def test_a_floor_close_to_a_large_glowing_panel_gets_all_its_light(renderer, gap):
    """A shadow ray is far shorter there than the triangles that it goes to are wide."""
    glow = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)))
    panel = Instance(0, placed(0.3, 0.2, gap), [1], visibility=RayVisibility.ALL & ~RayVisibility.CAMERA)
    scene = Scene(
        _from_above(2.0, 0.5),
        [_square(2.0)],
        [Instance(0, placed(0.1, -0.1, 0.0), [0]), panel],
        [diffuse(0.5, 0.5, 0.5), glow],
        settings=RenderSettings(iterations=8, photons=64, use_final_gather=False),
    )
    seen = renderer.render(scene).frame.combined[..., :3]
    # The light of a direction is 2 cos(angle) times the mean, of variance 1 / 3 and more by the choice of a triangle.
    assert seen.mean() == pytest.approx(0.5, rel=4.0 * np.sqrt(0.5 / (8 * PIXELS**2)))


def test_a_lamp_nearer_behind_a_transparent_card_than_rays_begin_off_it_shines_through(renderer):
    height, gap = 1e-3, 2e-6
    clear = material("clear", Lobe(LobeKind.TRANSPARENT))
    camera = _from_above(0.75 * height, 0.1 * height)
    camera.clip_start = 0.01 * height
    card = Instance(0, placed(0, 0, height - gap), [1], visibility=RayVisibility.ALL & ~RayVisibility.CAMERA)
    with_card, without = (
        renderer.render(
            Scene(
                camera,
                [_square(5.0)],
                [Instance(0, np.eye(4), [0]), *cards],
                [diffuse(0.8, 0.8, 0.8), clear],
                [Light("lamp", LightKind.POINT, placed(0, 0, height), np.full(3, 1e-6))],
                settings=RenderSettings(iterations=1, photons=64, filter_width=0.0),
            )
        ).frame.combined[..., :3]
        for cards in ([card], [])
    )
    assert (without > 0.0).all()
    np.testing.assert_allclose(with_card, without, rtol=1e-4)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that media scatter once, against quadrature of the airlight integral along the pixels' rays."""

import boxes
import fog
import numpy as np
import pytest
import scenes
from boxes import Box
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import World

SCATTERING, ABSORPTION = np.array([0.3, 0.2, 0.05]), np.array([0.0, 0.1, 0.3])
LAMP = np.array([0.7, 0.4, 0.3])
FAR = 3000.0
"""Half of a box that stands for the world, meters."""


@pytest.mark.parametrize("g", [0.0, 0.8, -0.5])
def test_airlight_of_a_lamp(renderer, g):
    """In the infinite medium of the world."""
    camera = fog.camera((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 0.3)
    world = World(volume=fog.volume(SCATTERING, ABSORPTION, g))
    scene = fog.scene_of(camera, lights=[fog.lamp(*LAMP)], world=world, photons=64, iterations=64)
    infinite = Box((0.0, 0.0, 0.0), FAR, SCATTERING, ABSORPTION, g)
    expected = boxes.single_scattering([infinite], LAMP, *fog.rays(camera))
    fog.assert_expected(fog.pictures_of(renderer, scene), expected, 4e-3)


OUTSIDE, INSIDE = (0.3, -4.0, 0.5), (0.3, -0.4, 0.2)
THICK = Box((0.0, 0.0, 0.0), 1.0, (0.5, 0.3, 0.1), (0.0, 0.3, 0.8), 0.4)
SMALL = Box((0.1, 0.2, 0.05), 0.5, (0.1, 0.9, 0.4), (0.3, 0.0, 0.1), -0.3)
BESIDE = Box((0.7, 0.3, 0.4), 0.8, (0.2, 0.4, 0.6), (0.2, 0.1, 0.0), 0.0)


@pytest.mark.parametrize("lamp", [(0.5, -0.3, 2.5), (0.4, 0.3, 0.35)], ids=["lamp outside", "lamp inside"])
@pytest.mark.parametrize("eye", [OUTSIDE, INSIDE], ids=["camera outside", "camera inside"])
@pytest.mark.parametrize(
    "media",
    [
        [THICK],
        pytest.param([THICK, SMALL], id="one within the other"),
        pytest.param([THICK, BESIDE], id="overlapping", marks=pytest.mark.long),
    ],
)
def test_boxes(renderer, media, eye, lamp):
    """Shadow rays cross the surfaces of media."""
    camera = fog.camera(eye, (0.0, 0.0, 0.0), 0.15)
    scene = fog.scene_of(camera, *(box.part() for box in media), lights=[fog.lamp(*lamp)], photons=64, iterations=64)
    expected = boxes.single_scattering(media, np.array(lamp), *fog.rays(camera))
    fog.assert_expected(fog.pictures_of(renderer, scene), expected, 0.01)


def test_surfaces_of_volumes_are_no_transparent_surfaces(renderer):
    """Cycles does not count them."""
    camera, lamp = fog.camera(OUTSIDE, (0.0, 0.0, 0.0), 0.15), (0.5, -0.3, 2.5)
    settings = {"photons": 64, "iterations": 16, "transparent_max_bounces": 0}
    scene = fog.scene_of(camera, THICK.part(), lights=[fog.lamp(*lamp)], **settings)
    expected = boxes.single_scattering([THICK], np.array(lamp), *fog.rays(camera))
    fog.assert_expected(fog.pictures_of(renderer, scene), expected, 0.05)


def test_an_opaque_object_shades_fog(renderer):
    """Behind a card there is no light, and in front of it as if it were not there."""
    camera, lamp = fog.camera((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), 0.2), np.array([0.0, 0.0, 3.0])
    black = material("black", Lobe(LobeKind.DIFFUSE, color=(0.0, 0.0, 0.0)))
    scene = fog.scene_of(
        camera,
        THICK.part(),
        (scenes.square("card", 4.0), black, scenes.placed(0.0, 0.0, 0.0, 1.0)),
        lights=[fog.lamp(*lamp)],
        photons=64,
        iterations=64,
    )
    expected = boxes.single_scattering([THICK], lamp, *fog.rays(camera))
    found = fog.pictures_of(renderer, scene)
    assert (found[:, : fog.SIZE // 2] == 0.0).all()
    fog.assert_expected(found[:, fog.SIZE // 2 :], expected[fog.SIZE // 2 :], 0.01)


def test_light_through_glass(renderer):
    """Glass around fog that does not bend light changes nothing: photons bring the light that shadow rays cannot.

    A kernel of the radius r has .31 r / 2 of its photons beyond an even surface, on average of the depths up to r.
    """
    camera, lamp = fog.camera((0.3, -3.0, 0.3), (0.0, 0.0, 0.0), 0.15), (0.3, -0.2, 1.5)
    thin = Box((0.0, 0.0, 0.0), 1.0, 0.2, 0.0, 0.4)
    glass = material("glass", Lobe(LobeKind.GLASS, ior=1.0))
    scene = fog.scene_of(
        camera,
        thin.part(),
        (scenes.box("glass", 1.1), glass, scenes.placed(0.0, 0.0, 0.0, 1.0)),
        lights=[fog.lamp(*lamp)],
        photons=16384,
        iterations=8,
    )
    expected = boxes.single_scattering([thin], np.array(lamp), *fog.rays(camera))
    fog.assert_expected(fog.pictures_of(renderer, scene), expected, 0.02, bias=0.31 * 0.2)

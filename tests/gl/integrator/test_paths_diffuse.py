# SPDX-License-Identifier: GPL-3.0-or-later
"""Light paths over diffuse surfaces and mirrors are rendered once, by either way to direct light."""

import numpy as np
import path_quadrature as quadrature
import pytest
import scenes
from path_classes import Build, Case, corner, each_mode, mirror_then, straight, two_bounces
from path_comparison import compare, gathering
from path_constants import DOWN, FIRST, FLOOR, FLOOR_AXES, NARROW, PHOTONS, SECOND, THIRD, UP, WALL
from path_quadrature import Plane
from path_scenes import colored, facing_down, lobe, view
from support.lobes import material

from rppm_addon.scene import DirectLight

CLASSES: dict[str, Build] = {
    "LDE": lambda mode: straight("D", mode),
    "LDDE": lambda mode: two_bounces("D", "D", mode),
    "LSDE": lambda mode: mirror_then("D", mode),
    "LSSDE": lambda mode: two_mirrors(mode),
    "LDSE": lambda mode: then_mirror(mode),
}
FOUND = {"LDDE"}
"""Where the last surface gets indirect light: from one that stores photons."""


def two_mirrors(mode: DirectLight) -> Case:
    """LSSDE: a ceiling lit by way of the floor and the wall."""
    camera = view((-0.2, -0.2, 0.6), (0.0, -0.4, 2.0), 0.2)
    scene, light = corner("S", "S", camera, mode, (3, 1), half_angle=0.16)
    ceiling = Plane(np.array([0.0, 0.0, 2.0]), DOWN)
    scenes.add(scene, facing_down("ceiling", 2.0, -1.7, 1.19), material("ceiling", lobe("D", THIRD)))
    image = light.mirrored(FLOOR).mirrored(WALL)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = ceiling.hit(origin, directions)

    def expected(offset: np.ndarray) -> np.ndarray:
        picture = quadrature.lit(image, quadrature.diffuse, DOWN, points + offset, -directions)
        return colored(picture, FIRST, SECOND, THIRD)

    return Case(scene, expected, NARROW, FLOOR_AXES)


def then_mirror(mode: DirectLight) -> Case:
    """LDSE: the floor seen in the wall."""
    camera = view((0.0, -0.2, 2.0), (1.2, -0.1, 1.0), 0.08)
    scene, light = corner("D", "S", camera, mode, (1, 2), iterations=3)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = FLOOR.hit(WALL.mirrored(origin), WALL.mirrored_direction(directions))

    def expected(offset: np.ndarray) -> np.ndarray:
        viewers = -WALL.mirrored_direction(directions)
        return colored(quadrature.lit(light, quadrature.diffuse, UP, points + offset, viewers), FIRST, SECOND)

    return Case(scene, expected, NARROW if mode is PHOTONS else None, FLOOR_AXES)


@pytest.mark.parametrize(("name", "mode"), each_mode(CLASSES))
def test_diffuse_paths_are_rendered_once(mapper, name, mode):
    compare(mapper, f"{name} {mode.value}", CLASSES[name](mode))


@pytest.mark.parametrize(("name", "mode"), each_mode(CLASSES, lambda *case: case != ("LDDE", PHOTONS)))
def test_diffuse_paths_are_gathered_once(mapper, monkeypatch, name, mode):
    case = gathering(CLASSES[name](mode), monkeypatch, 64 if name in FOUND else None)
    compare(mapper, f"{name} gathered {mode.value}", case)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Light paths through an interface of glass and through a slab, to a diffuse floor, are rendered once."""

import numpy as np
import path_glass as glass
import path_quadrature as quadrature
import pytest
from path_classes import Build, Case, each_mode
from path_comparison import compare
from path_constants import FIRST, FLOOR_AXES, NARROW, PHOTONS
from path_quadrature import Spot
from path_scenes import colored, level, lobe, scene_of, spot, view

from rppm_addon.scene import DirectLight

CLASSES: dict[str, Build] = {
    "LSDE interface": lambda mode: refraction(True, False, False, mode),
    "LSSDE slab": lambda mode: refraction(True, False, True, mode),
    "LDSE interface": lambda mode: refraction(False, True, False, mode),
    "LDSSE slab": lambda mode: refraction(False, True, True, mode),
    "LSDSE interface": lambda mode: refraction(True, True, False, mode),
    "LSSDSSE slab": lambda mode: refraction(True, True, True, mode),
}


def refraction(light_above: bool, camera_above: bool, slab: bool, mode: DirectLight) -> Case:
    """LSDE, LSSDE; LDSE, LDSSE; LSDSE, LSSDSSE: light and camera each above or below the glass."""
    light = spot((-0.5, 0.1, 1.6), (0.0, 0.0, 0.3), 0.4) if light_above else spot((-0.3, 0.1, 0.5), (0, 0, 0), 0.4)
    camera = view((0.6, -0.3, 1.9), (0.0, 0.0, 0.0), 0.1) if camera_above else view((0.5, -0.2, 0.5), (0, 0, 0), 0.2)
    crossings = 2 if slab else 1
    lengths = 1 + crossings * light_above, 1 + crossings * camera_above
    surfaces = [(level("floor", 0.0), lobe("D", FIRST)), *glass.panes(slab)]
    scene = scene_of(surfaces, light, camera, mode, *lengths, iterations=3)
    origin, directions = quadrature.camera_rays(camera)
    points, _, share = glass.seen_through(glass.layers(origin[2], slab), origin, directions)
    downwards = glass.layers(light.matrix[2, 3], slab)

    def expected(offset: np.ndarray) -> np.ndarray:
        irradiance = glass.refracted_irradiance(Spot.of(light), downwards, points + offset)
        return colored(irradiance * share / np.pi, FIRST)

    gathers = NARROW if light_above or mode is PHOTONS else None
    return Case(scene, expected, gathers, FLOOR_AXES)


@pytest.mark.parametrize(("name", "mode"), each_mode(CLASSES))
def test_refracted_paths_are_rendered_once(mapper, name, mode):
    compare(mapper, f"{name} {mode.value}", CLASSES[name](mode))

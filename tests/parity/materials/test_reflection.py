# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors, rough metal and plastic, against Cycles."""

import pytest

from ..engines import compare_with_cycles
from ..scenes import DIFFUSE, GLOSSY, PRINCIPLED, ball, camera, light, material, new_scene, place, plane


def _floor_wall_and_light() -> None:
    plane(3.0, material(DIFFUSE, Color=(0.7, 0.7, 0.7)))
    plane(3.0, material(DIFFUSE, Color=(0.2, 0.4, 0.7)), place(at=(0.0, 2.0, 2.0), turn=(90.0, 0.0, 0.0)))
    light("AREA", 150.0, place(at=(0.5, -1.5, 3.5), turn=(15.0, 0.0, 0.0)), shape="SQUARE", size=1.5)
    camera((0.0, -4.5, 2.0), (0.0, 0.5, 0.9), 40.0)


@pytest.mark.long
@pytest.mark.parametrize("mode", ["RAYS", "PHOTONS"])
def test_mirror(renderer, mode):
    """A flat mirror that shows floor, wall and light, and throws light back onto the floor."""
    new_scene()
    _floor_wall_and_light()
    mirror = material(GLOSSY, Color=(0.9, 0.8, 0.7), Roughness=0.0)
    plane(0.9, mirror, place(at=(0.0, 1.0, 1.0), turn=(70.0, 0.0, 10.0)))
    settings = {"direct_light": mode, "photons": 32768, "photon_path_length": 6, "iterations": 64, "seeds": 2}
    compare_with_cycles(renderer, f"mirror_{mode.lower()}", 512, **settings)


@pytest.mark.parametrize("roughness", [0.2, *(pytest.param(more, marks=pytest.mark.long) for more in (0.5, 0.9))])
def test_rough_metal(renderer, roughness):
    """A metal ball: traced as specular at 0.2, storing photons at 0.5 and 0.9."""
    new_scene()
    _floor_wall_and_light()
    metal = material(PRINCIPLED, Base_Color=(0.9, 0.6, 0.3), Metallic=1.0, Roughness=roughness)
    ball(0.9, metal, place(at=(0.0, 0.3, 0.9)))
    compare_with_cycles(renderer, f"metal_{roughness}", 512, photons=16384, photon_path_length=6, iterations=12)


@pytest.mark.long
@pytest.mark.parametrize("roughness", [0.1, 0.5])
def test_plastic(renderer, roughness):
    new_scene()
    _floor_wall_and_light()
    ball(0.9, material(PRINCIPLED, Base_Color=(0.1, 0.6, 0.2), Roughness=roughness), place(at=(0.0, 0.3, 0.9)))
    compare_with_cycles(renderer, f"plastic_{roughness}", 512, photons=65536, photon_path_length=6, iterations=12)

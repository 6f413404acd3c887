# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors, rough metal and plastic, against Cycles."""

import pytest

from ..comparison import Tolerance
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


LAYERS = {
    "specular": {"Base_Color": (0.8, 0.8, 0.8), "Roughness": 0.5},
    "smooth": {"Base_Color": (0.8, 0.8, 0.8), "Roughness": 0.2, "IOR": 1.8},
    "coat": {"Base_Color": (0.0, 0.0, 0.0), "Coat_Weight": 1.0, "Coat_Roughness": 0.8, "Specular_IOR_Level": 0.0},
    "coated": {"Base_Color": (0.8, 0.8, 0.8), "Coat_Weight": 1.0, "Coat_Roughness": 0.5, "Specular_IOR_Level": 0.0},
}


@pytest.mark.parametrize("name", LAYERS)
def test_layers_that_light_comes_below(renderer, name):
    """A floor seen flatly under a sun: what the layers of the Principled BSDF reflect and leave, without noise."""
    new_scene()
    plane(20.0, material(PRINCIPLED, **LAYERS[name]))
    light("SUN", 1.0, place(turn=(20.0, 0.0, 0.0)), angle=0.0)
    camera((0.0, -4.0, 1.2), (0.0, 0.0, 0.0), 25.0)
    exact = Tolerance(mean=0.001, block=0.002, mode=0.001)
    compare_with_cycles(renderer, f"layers_{name}", 64, exact, direct_light="RAYS", photons=256, iterations=32)


@pytest.mark.parametrize("below", ["Transmission_Weight", "Specular_IOR_Level"])
def test_films_have_the_specular_tint(renderer, below):
    """A floor under a thin film, in which a sun is mirrored."""
    new_scene()
    tint, film = (0.9, 0.3, 0.6, 1.0), {"Thin_Film_Thickness": 280.0, "Thin_Film_IOR": 1.33}
    floor = {"Base_Color": (0.25, 0.25, 0.25), "Roughness": 0.1, "Specular_Tint": tint, **film, below: 1.0}
    plane(20.0, material(PRINCIPLED, **floor))
    light("SUN", 1.0, place(turn=(-45.0, 0.0, 0.0)), angle=0.0)
    camera((0.0, -4.0, 4.0), (0.0, 0.0, 0.0), 10.0)
    near = Tolerance(mean=0.06, block=0.07, mode=0.07)  # the film's color is that of the angle of view
    compare_with_cycles(renderer, f"film_{below}", 64, near, direct_light="RAYS", photons=256, iterations=32)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Translucent sheets, rough diffuse surfaces and sheen in whole scenes, against Cycles.

All of them scatter photons, light by shadow rays, gathering rays and importons alike.
"""

import pytest

from ..engines import compare_with_cycles
from ..scenes import DIFFUSE, ball, camera, light, material, new_scene, place, plane

TRANSLUCENT, SHEEN = "ShaderNodeBsdfTranslucent", "ShaderNodeBsdfSheen"
RED, GREEN, BLUE = (0.8, 0.4, 0.3), (0.3, 0.7, 0.4), (0.3, 0.4, 0.8)


SURFACES = {
    # name: the sheet's or ball's node, its color and roughness
    "translucent": (TRANSLUCENT, RED, 0.0),
    "rough": (DIFFUSE, RED, 1.0),
    "sheen": (SHEEN, RED, 0.6),
}


def sheet_in_a_corner(name: str) -> None:
    """A sheet above a floor, a wall beside it: light comes through, off the floor and off the wall."""
    kind, color, roughness = SURFACES[name]
    inputs = {"Color": color} | ({"Roughness": roughness} if roughness else {})
    plane(3.0, material(DIFFUSE, Color=GREEN))
    plane(3.0, material(DIFFUSE, Color=BLUE), place(at=(0.0, 2.0, 2.0), turn=(90.0, 0.0, 0.0)))
    sheet = material(kind, **inputs)
    plane(1.1, sheet, place(at=(0.0, 0.4, 1.4), turn=(35.0, 10.0, 0.0)))
    ball(0.5, sheet, place(at=(0.9, -0.6, 0.6)))
    light("AREA", 150.0, place(at=(0.5, 0.0, 4.5), turn=(5.0, 0.0, 0.0)), shape="SQUARE", size=1.5)
    camera((-0.8, -4.5, 1.2), (0.2, 0.3, 1.1), 45.0)


MODES = {
    "rays": {"direct_light": "RAYS", "photons": 8192, "iterations": 16},
    # Half of the usual radius, with which the wall's dim edge is still 11 % off after 10 iterations.
    "photons": {
        "direct_light": "PHOTONS",
        "photons": 65536,
        "iterations": 10,
        "radius_scale": 5.0,
        "use_final_gather": False,
    },
}


@pytest.mark.long
@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("name", SURFACES)
def test_scattering(renderer, name, mode):
    new_scene()
    sheet_in_a_corner(name)
    compare_with_cycles(renderer, f"scattering_{name}_{mode}", 256, seeds=2, photon_path_length=6, **MODES[mode])

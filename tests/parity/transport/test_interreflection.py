# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffuse interreflection in a closed box, against Cycles."""

import pytest

from ..engines import compare_with_cycles
from ..scenes import DIFFUSE, PRINCIPLED, box, camera, light, material, new_scene, place, plane


def _box_with_colored_side(shader: str, **inputs) -> None:
    color = "Base_Color" if shader == PRINCIPLED else "Color"
    box((1.0, 1.0, 1.0), material(shader, **{color: (0.7, 0.7, 0.7)}, **inputs))
    red = material(shader, **{color: (0.7, 0.1, 0.05)}, **inputs)
    plane(0.999, red, place(at=(-0.99, 0.0, 0.0), turn=(0.0, 90.0, 0.0)))
    camera((0.0, -0.95, 0.0), (0.0, 1.0, -0.1), 75.0)


@pytest.mark.long
@pytest.mark.parametrize("mode", ["RAYS", "PHOTONS"])
def test_closed_diffuse_box(renderer, mode):
    new_scene()
    _box_with_colored_side(DIFFUSE)
    light("AREA", 30.0, place(at=(0.2, 0.1, 0.9)), shape="SQUARE", size=0.6)
    settings = {"direct_light": mode, "photons": 65536, "photon_path_length": 32, "iterations": 12}
    compare_with_cycles(renderer, f"box_{mode.lower()}", 512, **settings)


@pytest.mark.long
def test_closed_principled_box(renderer):
    """Plastic walls: diffuse below a rough dielectric coat, light stored and gathered on both."""
    new_scene()
    _box_with_colored_side(PRINCIPLED, Roughness=0.6, IOR=1.5)
    light("AREA", 30.0, place(at=(0.2, 0.1, 0.9)), shape="SQUARE", size=0.6)
    compare_with_cycles(renderer, "box_principled", 512, photons=65536, photon_path_length=32, iterations=12)

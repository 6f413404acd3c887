# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflective and refractive caustics switched off, beside Cycles'."""

import pytest

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..scenes import GLASS, PRINCIPLED, ball, box, camera, light, material, new_scene, place
from .light_paths import compare_light_passes, limit

CLOSE = Tolerance(mean=0.01, block=0.06, mode=0.01)


def _room() -> None:
    """Build a closed room of varnished walls with a glass ball and a metal one."""
    new_scene()
    walls = material(PRINCIPLED, Base_Color=(0.8, 0.7, 0.6), Roughness=0.3, Coat_Weight=0.5, Coat_Roughness=0.1)
    box((1.0, 1.0, 1.0), walls)
    ball(0.35, material(GLASS, Roughness=0.0, IOR=1.45), place(at=(0.3, 0.3, -0.6)))
    metal = material(PRINCIPLED, Base_Color=(0.9, 0.7, 0.4), Roughness=0.2, Metallic=1.0)
    ball(0.3, metal, place(at=(-0.5, 0.3, -0.65)))
    lamp = light("AREA", 30.0, place(at=(0.2, 0.1, 0.9)), shape="SQUARE", size=0.6)
    lamp.visible_glossy = lamp.visible_transmission = False
    camera((0.0, -0.95, 0.0), (0.0, 1.0, -0.1), 75.0)


BRIGHT_VARNISH = Tolerance(mean=0.025, block=0.06, mode=0.01)
"""Glass shows varnished surfaces to diffuse ones too bright (docs/theory.md)."""
CASES = {
    ("reflective", "refractive"): CLOSE,
    ("reflective",): BRIGHT_VARNISH,
    ("refractive",): CLOSE,
}


@pytest.mark.parametrize("off", [pytest.param(off, marks=pytest.mark.long if len(off) < 2 else ()) for off in CASES])
def test_varnished_room(renderer, off):
    _room()
    switches = {f"caustics_{kind}": False for kind in off}
    limit(**switches)
    settings = {"photons": 16384, "max_bounces": 64, "iterations": 24, **switches}
    compare_with_cycles(renderer, f"caustics_off_{'_'.join(off)}", 512, CASES[off], **settings)


@pytest.mark.long
def test_passes_of_light(renderer):
    _room()
    switches = {"caustics_reflective": False, "caustics_refractive": False}
    limit(**switches)
    compare_light_passes(renderer, "caustics_off", 512, photons=16384, max_bounces=64, iterations=32, **switches)

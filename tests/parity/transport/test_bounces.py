# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounces of light, and transparent surfaces that it passes, with Cycles' limits."""

import bpy
import pytest

from ..engines import compare_with_cycles
from ..scenes import DIFFUSE, GLASS, ball, box, camera, light, material, new_scene, place, plane


def _limit(**bounces: int) -> None:
    cycles = bpy.context.scene.cycles
    for name, most in bounces.items():
        setattr(cycles, name, most)


@pytest.mark.parametrize(
    ("bounces", "gathers"),
    [(0, True), *(pytest.param(*case, marks=pytest.mark.long) for case in ((0, False), (3, True), (3, False)))],
)
def test_bounces_in_a_box_with_a_glass_ball(renderer, bounces, gathers):
    """Caustics take two of them, and what is seen through the ball too."""
    new_scene()
    box((1.0, 1.0, 1.0), material(DIFFUSE, Color=(0.85, 0.8, 0.7)))
    ball(0.4, material(GLASS, Roughness=0.0, IOR=1.45), place(at=(0.2, 0.2, -0.55)))
    light("AREA", 30.0, place(at=(0.2, 0.1, 0.9)), shape="SQUARE", size=0.6)
    camera((0.0, -0.95, 0.0), (0.0, 1.0, -0.1), 75.0)
    _limit(**{f"{kind}_bounces": bounces for kind in ("max", "diffuse", "glossy", "transmission")})
    settings = {"photons": 16384, "max_bounces": bounces, "use_final_gather": gathers, "iterations": 24}
    compare_with_cycles(renderer, f"bounces_{bounces}_{gathers}", 512, **settings)


@pytest.mark.parametrize("most", [pytest.param(8, marks=pytest.mark.long), 4])
def test_transparent_cards_above_a_floor(renderer, most):
    """Stairs of up to three cards, which the lamp's light passes and the camera sees through."""
    new_scene()
    plane(1.5, material(DIFFUSE, Color=(0.8, 0.7, 0.6)))
    for number in range(3):
        card = material("ShaderNodeBsdfTransparent", Color=(0.9, 0.7, 0.8))
        plane(0.8, card, place(at=(0.4 * number - 1.0, 0.2 * number - 0.4, 0.3 + 0.1 * number)))
    light("AREA", 60.0, place(at=(0.0, 0.0, 2.0)), shape="SQUARE", size=1.0)
    camera((0.0, -0.5, 4.0), (0.0, 0.0, 0.0), 40.0)
    _limit(transparent_max_bounces=most)
    settings = {"photons": 32768, "transparent_max_bounces": most, "iterations": 24}
    compare_with_cycles(renderer, f"transparent_cards_{most}", 256, **settings)

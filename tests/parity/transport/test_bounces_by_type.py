# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of diffuse, glossy and transmission bounces, beside Cycles'."""

import pytest

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..scenes import DIFFUSE, GLASS, GLOSSY, ball, box, camera, light, material, new_scene, place, plane
from .light_paths import compare_light_passes, limit

KINDS = ("diffuse", "glossy", "transmission")
CLOSE = Tolerance(mean=0.01, block=0.06, mode=0.01)


def _room(mirror_height: float = 0.1) -> None:
    """Build a closed room with a glass ball, a rough ball, a mirror and a translucent sheet."""
    new_scene()
    box((1.0, 1.0, 1.0), material(DIFFUSE, Color=(0.85, 0.8, 0.7)))
    ball(0.35, material(GLASS, Roughness=0.0, IOR=1.45), place(at=(0.3, 0.3, -0.6)))
    ball(0.3, material(GLOSSY, Color=(0.9, 0.7, 0.4), Roughness=0.6), place(at=(-0.5, 0.3, -0.65)))
    plane(
        0.5,
        material(GLOSSY, Color=(0.8, 0.9, 0.9), Roughness=0.0),
        place(at=(0.0, 0.95, mirror_height), turn=(90.0, 0, 0)),
    )
    sheet = material("ShaderNodeBsdfTranslucent", Color=(0.8, 0.6, 0.7))
    plane(0.3, sheet, place(at=(-0.6, 0.4, 0.2), turn=(60.0, 20.0, 0.0)))
    light("AREA", 30.0, place(at=(0.2, 0.1, 0.9)), shape="SQUARE", size=0.6)
    camera((0.0, -0.95, 0.0), (0.0, 1.0, -0.1), 75.0)


CASES = {
    "diffuse_0": (0, 64, 64),
    "glossy_0": (64, 0, 64),
    "transmission_0": (64, 64, 0),
    "diffuse_1": (1, 64, 64),
    "glossy_1": (64, 1, 64),
    "transmission_2": (64, 64, 2),
    "cycles_default": (4, 4, 12),
    "mixed": (1, 1, 2),
}
IN_SHORT = {"diffuse_0", "mixed"}


@pytest.mark.parametrize("name", [n if n in IN_SHORT else pytest.param(n, marks=pytest.mark.long) for n in CASES])
@pytest.mark.parametrize("gathers", [True, pytest.param(False, marks=pytest.mark.long)])
def test_limits_of_a_room(renderer, name, gathers):
    _room()
    limits = {f"{kind}_bounces": most for kind, most in zip(KINDS, CASES[name])}
    limit(**limits)
    settings = {"photons": 16384, "max_bounces": 64, "use_final_gather": gathers, "iterations": 24, **limits}
    compare_with_cycles(renderer, f"by_type_{name}_{gathers}", 1024, CLOSE, **settings)


@pytest.mark.long
def test_passes_of_light_within_limits(renderer):
    """The mirror does not show the lamp, whose edges differ from those of the color that the pass is divided by."""
    _room(mirror_height=-0.4)
    limits = {f"{kind}_bounces": most for kind, most in zip(KINDS, CASES["mixed"])}
    limit(**limits)
    settings = {"photons": 16384, "max_bounces": 64, "iterations": 32, **limits}
    compare_light_passes(renderer, "by_type", 512, **settings)

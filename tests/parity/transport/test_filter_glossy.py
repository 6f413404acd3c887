# SPDX-License-Identifier: GPL-3.0-or-later
"""Filter Glossy, beside Cycles'."""

import pytest

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..scenes import DIFFUSE, GLASS, GLOSSY, ball, box, camera, light, material, new_scene, place
from .light_paths import compare_light_passes, limit

CLOSE = Tolerance(mean=0.01, block=0.04, mode=0.01)
MEAN_BLUR = Tolerance(mean=0.02, block=0.05, mode=0.02)
"""A weak filter, of which photons and the final gather know the mean only."""
SETTINGS = {"photons": 8192, "max_bounces": 64}


def _room(seen: str, roughness: float) -> None:
    """Build a closed room with a ball that makes caustics."""
    new_scene(32)
    box((1.0, 1.0, 1.0), material(DIFFUSE, Color=(0.8, 0.7, 0.6)))
    shiny = material(seen, Color=(0.9, 0.8, 0.9), Roughness=roughness)
    ball(0.4, shiny, place(at=(0.2, 0.3, -0.5)))
    lamp = light("AREA", 30.0, place(at=(0.2, 0.1, 0.9)), shape="SQUARE", size=0.6)
    lamp.visible_glossy = lamp.visible_transmission = False
    camera((0.0, -0.95, 0.0), (0.0, 1.0, -0.1), 75.0)


CASES = {
    "mirror": (GLOSSY, 0.0, 1.0, CLOSE),
    "rough": (GLOSSY, 0.3, 1.0, CLOSE),
    "glass": (GLASS, 0.0, 1.0, CLOSE),
    "weak": (GLOSSY, 0.0, 0.5, MEAN_BLUR),
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.long if name != "glass" else ()) for name in CASES]
)
def test_blurred_bounces_blur_what_they_see(renderer, name):
    seen, roughness, strength, tolerance = CASES[name]
    _room(seen, roughness)
    limit(blur_glossy=strength)
    compare_with_cycles(
        renderer, f"filter_glossy_{name}", 1024, tolerance, seeds=2, iterations=32, blur_glossy=strength, **SETTINGS
    )


@pytest.mark.long
def test_passes_of_light(renderer):
    _room(GLOSSY, 0.3)
    limit(blur_glossy=1.0)
    compare_light_passes(renderer, "filter_glossy", 1024, iterations=48, blur_glossy=1.0, **SETTINGS)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that some rays do not see, between a smooth floor and the lamp that it mirrors, against Cycles."""

import pytest

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..scenes import DIFFUSE, PRINCIPLED, camera, light, material, new_scene, place, plane

NEAR = Tolerance(mean=0.01, block=0.03, mode=0.01)


@pytest.mark.parametrize(
    ("rays", "iterations"), [("shadow", 256), ("camera", 256), pytest.param("glossy", 2048, marks=pytest.mark.long)]
)
def test_cards_before_mirrored_lamps(renderer, rays, iterations):
    """A mirror meets the lamp by a glossy ray, which is what counts on the way there."""
    new_scene(32)
    plane(2.5, material(PRINCIPLED, Base_Color=0.8, Roughness=0.0))
    card = plane(1.2, material(DIFFUSE, Color=0.8), place(at=(0.0, 0.5, 0.9)))
    setattr(card, f"visible_{rays}", False)
    light("AREA", 100.0, place(at=(0.0, 3.25, 2.6), turn=(-50.0, 0.0, 0.0)), shape="SQUARE", size=1.0)
    camera((0.0, -5.0, 2.5), (0.0, 0.0, 0.2), 38.0)
    compare_with_cycles(renderer, f"hidden_from_{rays}", 512, NEAR, seeds=2, iterations=iterations, photons=512)

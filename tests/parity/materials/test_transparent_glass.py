# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass through which a transparent film shows the background."""

import bpy
import numpy as np
import pytest

from ..comparison import Tolerance, compare
from ..engines import render_cycles_over, render_frame
from ..scenes import DIFFUSE, GLASS, ball, box, camera, light, material, new_scene, place, plane

BACKGROUND = 0.8
WITHIN = Tolerance(mean=0.01, block=0.03, mode=0.01)


def _panes_and_balls() -> None:
    """Clear, tinted, a little rough and very rough glass, one before the other, over half a floor."""
    new_scene(world=0.3)
    plane(0.8, material(DIFFUSE, Color=(0.7, 0.5, 0.3)), place(at=(0.0, 0.9, 0.0)))
    ball(0.45, material(GLASS, Color=(0.9, 0.6, 0.5), Roughness=0.0, IOR=1.4), place(at=(-0.6, 0.0, 0.45)))
    box((0.4, 0.05, 0.5), material(GLASS, Color=1.0, Roughness=0.09, IOR=1.5), place(at=(0.55, -0.3, 0.5)))
    rough = material("ShaderNodeBsdfPrincipled", Transmission_Weight=1.0, Roughness=0.3, Base_Color=(0.6, 0.8, 1.0))
    ball(0.3, rough, place(at=(0.4, 0.5, 0.3)))
    light("AREA", 60.0, place(at=(0.0, 0.0, 3.0)), shape="SQUARE", size=1.5)
    camera((0.0, -4.0, 1.4), (0.0, 0.0, 0.4), 45.0)


@pytest.mark.parametrize("threshold", [0.1, pytest.param(0.5, marks=pytest.mark.long)])
def test_the_background_shows_through_glass(renderer, threshold):
    _panes_and_balls()
    cycles = bpy.context.scene.cycles
    cycles.film_transparent_glass, cycles.film_transparent_roughness = True, threshold
    reference = render_cycles_over(BACKGROUND, samples=1024)
    cycles.film_transparent_glass = False
    frames = [
        render_frame(
            renderer, seed=seed, iterations=12, photons=2048, film_transparent=True, film_transparent_glass=True,
            film_transparent_roughness=threshold, camera_path_length=12, photon_path_length=12,
        ).combined.astype(np.float64)
        for seed in range(3)
    ]  # fmt: skip
    pictures = np.array([frame[..., :3] + BACKGROUND * (1.0 - frame[..., 3:]) for frame in frames])
    compare(f"transparent_glass_{threshold}", pictures, reference, WITHIN)

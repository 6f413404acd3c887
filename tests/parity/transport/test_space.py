# SPDX-License-Identifier: GPL-3.0-or-later
"""The same scene at the origin and away from it against Cycles at the origin."""

import math

import bpy
import pytest

from ..comparison import CAUSTIC, compare
from ..engines import render_cycles, render_rppm
from ..scenes import DIFFUSE, GLASS, camera, light, material, mesh_object, new_scene, place, plane

PATHS = {"photon_path_length": 12, "camera_path_length": 12}


def _tumbler(turns: int = 48) -> None:
    """A glass of 4 cm radius with walls of 2 mm."""
    profile = [(0, 0.001), (0.04, 0.001), (0.04, 0.1), (0.038, 0.1), (0.038, 0.006), (0, 0.006)]
    angles = [2 * math.pi * i / turns for i in range(turns)]
    vertices = [(r * math.cos(angle), r * math.sin(angle), z) for r, z in profile for angle in angles]
    faces = [
        (k * turns + i, k * turns + (i + 1) % turns, (k + 1) * turns + (i + 1) % turns, (k + 1) * turns + i)
        for k in range(len(profile) - 1)
        for i in range(turns)
    ]
    mesh_object(vertices, faces, material(GLASS, Color=1.0, Roughness=0.0, IOR=1.5), name="Tumbler")


def _scene() -> None:
    new_scene(world=0.05)
    _tumbler()
    plane(0.3, material(DIFFUSE, Color=0.8))
    light("AREA", 1.2, place(at=(0.15, 0.12, 0.3), turn=(23.0, 23.0, 0.0)), shape="SQUARE", size=0.06)
    camera((0.0, -0.4, 0.25), (0.0, 0.03, 0.0), 40.0)


@pytest.mark.long
@pytest.mark.parametrize("away", [0.0, 150.0])
def test_thin_walls_of_glass(renderer, away):
    _scene()
    reference = render_cycles(samples=256)
    for thing in bpy.context.scene.objects:
        thing.matrix_world.translation.x += away
        thing.matrix_world.translation.y += away
    compare(f"tumbler_{away:g}", render_rppm(renderer, photons=32768, iterations=16, **PATHS), reference, CAUSTIC)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays that leave surfaces of any size anywhere meet no neighbor in the same plane, and pass over no thin wall."""

import dataclasses
import math

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Light, LightKind

TURN = scenes.looking((0.0, 0.0, 0.0), (0.3, 0.8, -0.5))[:3, :3]
WAY = np.array([0.62, -0.47, 0.63])
"""Along which scenes lie away from the origin."""


def grid(squares: int):
    """A square of side 1 in XY, of squares x squares quads."""
    at = np.linspace(-0.5, 0.5, squares + 1)
    positions = [(x, y, 0.0) for y in at for x in at]
    row = squares + 1
    corners = [(j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i)
               for j in range(squares) for i in range(squares)]  # fmt: skip
    return scenes.polygons("grid", np.array(positions), corners)


def placed(center: np.ndarray, size: float, turn: np.ndarray = TURN) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = size * turn, center
    return matrix


def camera(center: np.ndarray, from_center: np.ndarray) -> Camera:
    distance = np.linalg.norm(from_center)
    seen = scenes.camera(center + from_center, center, 0.2, 48)
    return dataclasses.replace(seen, clip_start=0.01 * distance, clip_end=100.0 * distance)


@pytest.mark.parametrize(
    ("size", "distance"), [(1e-4, 0.0), (0.01, 10.0), (4.0, 0.0), (40.0, 300.0), (10.0, 5000.0), (1e5, 0.0)]
)
@pytest.mark.parametrize("squares", [1, 60])
def test_no_dots_on_a_turned_plane_in_grazing_light(renderer, size, distance, squares):
    center = distance * WAY / np.linalg.norm(WAY)
    across, up, normal = TURN.T
    grazing = 0.05 * normal + 0.8 * up + 0.6 * across
    sun = Light("sun", LightKind.SUN, scenes.looking(tuple(grazing), (0, 0, 0)), np.full(3, math.pi))
    view, plane = camera(center, size * (1.2 * normal - 0.4 * up)), (grid(squares), scenes.diffuse(0.5, 0.5, 0.5))
    scene = scenes.scene_of(view, plane, lights=[sun], iterations=4, photons=64, photon_path_length=1)
    scene.instances[0].matrix = placed(center, size)
    seen = renderer.render(scene).frame.combined[..., :3]
    expected = 0.5 * 0.05 / np.linalg.norm(grazing)
    np.testing.assert_allclose(seen, expected, rtol=2e-3)


@pytest.mark.parametrize(
    ("thickness", "distance"), [(2e-6, 0.001), (2e-4, 12.0), (2e-3, 150.0), (0.1, 5000.0), (1000.0, 0.0)]
)
def test_both_faces_of_a_thin_film_are_met(renderer, thickness, distance):
    """Absorption through a film that does not refract tells how far apart its faces are."""
    center = distance * WAY / np.linalg.norm(WAY)
    normal, size = TURN[:, 2], 20.0 * thickness
    film = material("film", Lobe(LobeKind.GLASS, ior=1.0), absorption=np.full(3, 1.0 / thickness))
    glow = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)))
    parts = [(grid(1), surface) for surface in (film, film, glow)]
    scene = scenes.scene_of(camera(center, size * normal), *parts, iterations=2, photons=64)
    scene.instances[1].materials = [0]  # both faces are of one body
    back = placed(center - thickness * normal, size, TURN @ np.diag([-1.0, 1.0, -1.0]))
    places = placed(center, size), back, placed(center - 5.0 * thickness * normal, size)
    for instance, matrix in zip(scene.instances, places, strict=True):
        instance.matrix = matrix
    seen = renderer.render(scene).frame.combined[..., :3]
    passed = -np.log(np.maximum(seen, 1e-10)).mean()
    # Neither film nor glow is where it should be by more than float coordinates can say.
    assert passed == pytest.approx(1.0, rel=0.02 + distance * 2.0**-20 / thickness)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays that leave surfaces of any size anywhere meet no neighbor in the same plane, and pass over no thin wall."""

import math

import numpy as np
import pytest
from scenes import diffuse
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Instance, Light, LightKind, RenderSettings, Scene
from rppm_addon.self_test.meshes import looking, polygons

PIXELS = 48
WAY = np.array([0.62, -0.47, 0.63])
"""Along which scenes lie away from the origin."""


def _grid(squares: int):
    """A square of side 1 in XY, of squares x squares quads."""
    at = np.linspace(-0.5, 0.5, squares + 1)
    positions = [(x, y, 0.0) for y in at for x in at]
    row = squares + 1
    corners = [(j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i)
               for j in range(squares) for i in range(squares)]  # fmt: skip
    return polygons("grid", np.array(positions), corners)


def _frame(turn: np.ndarray, size: float, center: np.ndarray) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = size * turn, center
    return matrix


def _camera(center: np.ndarray, from_center: np.ndarray) -> Camera:
    distance = np.linalg.norm(from_center)
    return Camera(
        looking(center + from_center, center),
        (-0.2, 0.2, -0.2, 0.2),
        PIXELS,
        PIXELS,
        clip_start=0.01 * distance,
        clip_end=100.0 * distance,
    )


@pytest.mark.parametrize(
    ("size", "distance"), [(1e-4, 0.0), (0.01, 10.0), (4.0, 0.0), (40.0, 300.0), (10.0, 5000.0), (1e5, 0.0)]
)
@pytest.mark.parametrize("squares", [1, 60])
def test_no_dots_on_a_turned_plane_in_grazing_light(renderer, size, distance, squares):
    turn = looking((0.0, 0.0, 0.0), (0.3, 0.8, -0.5))[:3, :3]
    center = distance * WAY / np.linalg.norm(WAY)
    across, up, normal = turn.T
    grazing = 0.05 * normal + 0.8 * up + 0.6 * across
    sun = Light("sun", LightKind.SUN, looking(tuple(grazing), (0, 0, 0)), np.full(3, math.pi))
    scene = Scene(
        _camera(center, size * (1.2 * normal - 0.4 * up)),
        [_grid(squares)],
        [Instance(0, _frame(turn, size, center), [0])],
        [diffuse(0.5, 0.5, 0.5)],
        [sun],
        settings=RenderSettings(iterations=4, photons=64, photon_path_length=1),
    )
    seen = renderer.render(scene).frame.combined[..., :3]
    expected = 0.5 * 0.05 / np.linalg.norm(grazing)
    np.testing.assert_allclose(seen, expected, rtol=2e-3)


@pytest.mark.parametrize(
    ("thickness", "distance"), [(2e-6, 0.001), (2e-4, 12.0), (2e-3, 150.0), (0.1, 5000.0), (1000.0, 0.0)]
)
def test_both_faces_of_a_thin_film_are_met(renderer, thickness, distance):
    """Absorption through a film that does not refract tells how far apart its faces are."""
    turn = looking((0.0, 0.0, 0.0), (0.3, 0.8, -0.5))[:3, :3]
    center = distance * WAY / np.linalg.norm(WAY)
    normal, size = turn[:, 2], 20.0 * thickness
    film = material("film", Lobe(LobeKind.GLASS, ior=1.0), absorption=np.full(3, 1.0 / thickness))
    glow = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)))
    scene = Scene(
        _camera(center, size * normal),
        [_grid(1)],
        [
            Instance(0, _frame(turn, size, center), [0]),
            Instance(0, _frame(turn @ np.diag([-1.0, 1.0, -1.0]), size, center - thickness * normal), [0]),
            Instance(0, _frame(turn, size, center - 5.0 * thickness * normal), [1]),
        ],
        [film, glow],
        settings=RenderSettings(iterations=2, photons=64),
    )
    seen = renderer.render(scene).frame.combined[..., :3]
    passed = -np.log(np.maximum(seen, 1e-10)).mean()
    # Neither film nor glow is where it should be by more than float coordinates can say.
    assert passed == pytest.approx(1.0, rel=0.02 + distance * 2.0**-20 / thickness)

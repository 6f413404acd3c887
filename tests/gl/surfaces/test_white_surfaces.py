# SPDX-License-Identifier: GPL-3.0-or-later
"""White surfaces that absorb nothing in a sky of radiance 1: whatever scatters there, radiance is 1."""

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Mesh, World


def seen(renderer, mesh: Mesh, lobe: Lobe, eye: tuple, iterations: int) -> np.ndarray:
    """(H, W) radiance of the surface alone in the sky, seen from a point that looks at the origin."""
    scene = scenes.scene_of(
        scenes.camera(eye, (0, 0, 0), 0.3, 16), (mesh, material("white", lobe)), world=World(np.ones(3)),
        iterations=iterations, photons=64, photon_path_length=2, camera_path_length=8, filter_width=0.0,
        specular_roughness=1.0,
    )  # fmt: skip
    return renderer.render(scene).frame.combined[..., 0].astype(np.float64)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("roughness", [0.0, 0.4])
def test_a_pane_without_an_inside_shows_the_sky(renderer, side, roughness):
    """From either side, though what is seen through it is of another index."""
    pane = scenes.square("pane", 9.0)
    lobe = Lobe(LobeKind.GLASS, roughness=roughness)
    picture = seen(renderer, pane, lobe, (0, -1, 2 * side), 64 if roughness else 2)
    error = picture.std() / np.sqrt(picture.size)
    assert error < 2e-3
    assert abs(picture.mean() - 1.0) < 4 * error + 2e-3  # the tables of albedos


def test_smooth_normals_of_few_faces_lose_no_reflection(renderer):
    """Mirrored directions that smooth normals send below the surface are lifted above it, as in Cycles."""
    ball = scenes.sphere("ball", 8, 6)
    picture = seen(renderer, ball, Lobe(LobeKind.GLOSSY), (0, -5, 1), 2)
    np.testing.assert_allclose(picture, 1.0, atol=1e-5)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass Ambient Occlusion against closed forms, and the pass Roughness."""

import numpy as np
import pytest
import scenes

from rppm_addon.scene import DirectLight

SIZE, HEIGHT = 16, 0.5


def beneath_a_lid(**settings: object):
    """A floor, seen from below a lid that hides the sky as a disk would, in the middle of the picture."""
    camera = scenes.camera((0.0, -0.3, 0.3), (0.0, 0.0, 0.0), 0.05, SIZE)
    scene = scenes.scene_of(camera, passes=("Ambient Occlusion", "Roughness"), iterations=64, photons=64, **settings)
    scenes.add(scene, scenes.square("floor", 20.0), scenes.diffuse(0.5, 0.5, 0.5))
    scenes.add(scene, scenes.square("lid", HEIGHT, HEIGHT), scenes.diffuse(0.5, 0.5, 0.5))
    return scene


def square_form_factor() -> float:
    """Cosine-weighted fraction of the sky that a square of half its side above the middle of the floor hides."""
    x = np.linspace(-HEIGHT, HEIGHT, 801)
    x = 0.5 * (x[1:] + x[:-1])
    squared = x[:, None] ** 2 + x[None, :] ** 2 + HEIGHT**2
    return float((HEIGHT**2 / squared**2).mean() * (2.0 * HEIGHT) ** 2 / np.pi)


@pytest.mark.parametrize("direct_light", DirectLight)
@pytest.mark.parametrize("distance", [0.4, 100.0])
def test_rays_meet_what_is_within_the_distance(mapper, direct_light, distance):
    scene = beneath_a_lid(direct_light=direct_light)
    scene.world.ambient_occlusion_distance = distance
    mapper.build(scene)
    for _ in range(64):
        mapper.iterate()
    passes = mapper.film.read_passes()
    expected = 1.0 if distance < HEIGHT else 1.0 - square_form_factor()
    assert passes["Ambient Occlusion"].mean() == pytest.approx(expected, abs=0.02)
    assert (passes["Roughness"] == 1.0).all()

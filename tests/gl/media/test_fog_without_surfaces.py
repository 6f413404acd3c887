# SPDX-License-Identifier: GPL-3.0-or-later
"""Fog that fills the world, with nothing else in it but a lamp: light that is scattered twice or more."""

import fog
import numpy as np
import pytest
import scenes

from rppm_addon.scene import LightKind, World

SIGMA = 0.5


def fog_alone(renderer, *parts: tuple, density: float = SIGMA) -> np.ndarray:
    """(seeds, H, W, 3) pictures of a lamp's surroundings, which the camera sees at the height of the lamp."""
    camera = fog.camera((0.0, -4.0, 0.0), (0.6, 0.0, 0.0), 0.3, 16)
    scene = fog.scene_of(
        camera,
        *parts,
        lights=[fog.lamp(0.0, 0.0, 0.0)],
        world=World(volume=fog.volume(density)),
        photons=8192,
        iterations=16,
        volume_bounces=3,
    )
    return fog.pictures_of(renderer, scene, 3)


@pytest.mark.parametrize("density", [0.2, 1.5], ids=["beams", "points"])
def test_far_surfaces_change_nothing(renderer, density):
    """A card that is out of sight makes the scene larger; without it, there is no surface at all."""
    card = scenes.square("card", 1.0), scenes.diffuse(0.0, 0.0, 0.0), scenes.placed(0.0, -10.0, 6.0, 1.0)
    alone, beside = (fog_alone(renderer, *parts, density=density) for parts in ((), (card,)))
    print(f"\n{density}: {alone.mean() / beside.mean():.4f}")
    assert alone.mean() == pytest.approx(beside.mean(), rel=0.1)
    noise = [(found.std(axis=0) / found.mean(axis=0)).mean() for found in (alone, beside)]
    assert noise[0] < 3.0 * noise[1]


def test_nothing_comes_through_fog_without_end(renderer):
    """A sun lights neither the fog nor what is in it."""
    floor = scenes.square("floor", 3.0), scenes.diffuse(0.8, 0.8, 0.8), scenes.placed(0.0, 0.0, -1.0, 1.0)
    sun = fog.lamp(0.0, 0.0, 3.0)
    sun.kind = LightKind.SUN
    camera = fog.camera((0.0, -4.0, 0.5), (0.0, 0.0, -0.5), 0.3)
    world = World(volume=fog.volume((0.2, 0.2, 0.0)))
    scene = fog.scene_of(camera, floor, lights=[sun], world=world, iterations=4, volume_bounces=3)
    found = fog.pictures_of(renderer, scene, 1)[0].mean(axis=(0, 1))
    assert found[0] == found[1] == 0.0
    assert found[2] > 0.1

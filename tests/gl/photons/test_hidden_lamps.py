# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps whose light does not come to the picture: photons of the others are as many as without them."""

import numpy as np
import pytest
import scenes
from rendering import iterated

from rppm_addon.scene import Instance, Light, LightKind, Scene

LAMPS = 20
COLUMNS, ROWS = 144, 64
"""More pixels than the fewest automatic photons."""


def caustic_scene(lamps: int, shut: bool = True) -> Scene:
    """The room with a glass and a mirror ball; lamps of 40 times the power are in a box, closed or without a floor,
    above."""
    scene = scenes.room(8, photons=0, filter_width=0.0)
    scene.materials[:3] = [scenes.diffuse(0.2, 0.2, 0.2)] * 3
    scene.camera.width, scene.camera.height = COLUMNS, ROWS
    walls = scenes.box_sides()
    for wall in walls if shut else walls[1:]:
        scene.instances.append(Instance(len(scene.meshes), scenes.placed(0, 0, 2.5), [0]))
        scene.meshes.append(wall)
    if not shut:  # nor has the room a ceiling
        scene.instances = [each for each in scene.instances if each.mesh != 1]
    scene.lights += [
        Light(f"lamp {k}", LightKind.POINT, scenes.placed(0.08 * k - 0.8, 0, 2.5), np.full(3, 2.0))
        for k in range(lamps)
    ]
    return scene


def photons_of_lamps(mapper) -> int:
    return sum(count for name, count in mapper.source_photons.items() if "lamp" in name)


def test_the_light_that_is_seen_keeps_its_photons(mapper):
    noises, counts = [], []
    for lamps in (0, LAMPS):
        iterated(mapper, caustic_scene(lamps), 3)
        noise = mapper.learning.photon_noise
        noises.append(noise.photon_sum / noise.photons)
        counts.append(mapper.learning.photon_counts.latest)
    assert counts[0] > 0.3 * COLUMNS * ROWS  # caustics ask for many
    # A seventh of the second iteration's photons still goes to the lamps, of which nobody sees any.
    assert noises[1] == pytest.approx(noises[0], rel=0.25)
    # Shadow rays to the lamps make more noise than all photons do.
    assert 512 < counts[1] < counts[0]
    assert photons_of_lamps(mapper) < 0.2 * counts[1]


def test_lamps_that_the_next_frame_shows_are_found(mapper):
    iterated(mapper, caustic_scene(LAMPS))
    mapper.update(caustic_scene(LAMPS, shut=False))
    for _ in range(3):
        mapper.iterate()
    assert photons_of_lamps(mapper) > 0.8 * mapper.learning.photon_counts.latest

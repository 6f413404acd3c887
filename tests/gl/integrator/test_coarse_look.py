# SPDX-License-Identifier: GPL-3.0-or-later
"""The radii that a coarse look at the view finds are those that all of its pixels would find."""

import dataclasses

import numpy as np
import pytest
import scenes
from rendering import iterated

from rppm_addon.integrator import pilot_view
from rppm_addon.scene.camera import Aperture


def camera_of(scene, name: str):
    camera = scene.camera
    if name == "aperture":
        return dataclasses.replace(camera, aperture=Aperture(0.02, 3.0))
    if name == "orthographic":
        return dataclasses.replace(camera, orthographic=True, window=(-1.2, 1.2, -1.2, 1.2))
    if name == "crop":
        return dataclasses.replace(camera, crop=(20, 40, 210, 190))
    return camera


def radii(mapper, scene) -> tuple[float, float, float]:
    iterated(mapper, scene)
    schedule = mapper.learning.radius_schedule
    return (*schedule.limits, schedule.widest_radius)


@pytest.mark.parametrize("name", ["perspective", "orthographic", "aperture", "crop"])
def test_a_coarse_look_finds_the_radii_of_all_pixels(mapper, monkeypatch, name):
    scene = scenes.room(240, photons=1024, camera_path_length=2, photon_path_length=2)
    scene.camera = camera_of(scene, name)
    coarse = radii(mapper, scene)
    looked = mapper.learning.leaves_importon.size
    assert looked < 0.6 * np.prod(scene.camera.resolution)
    monkeypatch.setattr(pilot_view, "MOST_PIXELS", 1 << 20)
    full = radii(mapper, scene)
    assert mapper.learning.leaves_importon.size == np.prod(scene.camera.resolution)
    np.testing.assert_allclose(coarse, full, rtol=0.01)


def test_all_pixels_look_for_what_is_small(mapper):
    scene = scenes.room(240, photons=1024, camera_path_length=2, photon_path_length=2)
    scene.instances = scene.instances[-1:]
    scene.camera = dataclasses.replace(scene.camera, matrix=scenes.looking((0.0, -60.0, 0.0), (0.0, 0.0, 0.0)))
    mapper.build(scene)
    assert mapper.learning.leaves_importon.shape == (240, 240)

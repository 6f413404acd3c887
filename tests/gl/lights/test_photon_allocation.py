# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics of the power and the photons of each light source."""

import dataclasses
import math

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.lights.sources import ENVIRONMENT, SURFACES, source_name
from rppm_addon.scene import Light, LightKind, Scene, World

SETTINGS = {
    "photons": 4000,
    "iterations": 1,
    "photon_path_length": 1,
    "camera_path_length": 1,
    "use_final_gather": False,
}


def told(renderer, scene: Scene) -> tuple[dict[str, float], dict[str, int]]:
    """Watts and photons of each source."""
    statistics = renderer.render(scene).statistics.photon_statistics
    return statistics.source_watts, statistics.source_photons


def test_sources_have_their_power_and_photons(renderer):
    """An area light of 12 pi / 4 W, a point light of half with four times its photons, a glowing ball and the sky."""
    scene = scenes.room(8, **SETTINGS)
    point = Light("light", LightKind.POINT, np.eye(4), np.full(3, 12 / 32), photon_weight=4.0)
    scene.lights.append(dataclasses.replace(point, name="point"))
    scene.lights.append(dataclasses.replace(point, name="point", strength=np.zeros(3)))  # gives no light
    scene.materials[3] = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)))
    scene.world = World(np.full(3, 0.01))
    watts, photons = told(renderer, scene)
    assert set(watts) == set(photons) == {source_name("light"), source_name("point"), SURFACES, ENVIRONMENT}
    assert watts[source_name("light")] == pytest.approx(math.pi * 12 * 0.25, rel=1e-3)
    assert watts[source_name("point")] == pytest.approx(4 * math.pi * 12 / 32, rel=1e-6)
    # The ball's facets have slightly less area than the sphere; both of their sides emit.
    assert watts[SURFACES] == pytest.approx(2 * math.pi * 4 * math.pi * 0.35**2, rel=0.05)
    assert watts[ENVIRONMENT] == pytest.approx(4 * math.pi**2 * 3.0 * 0.01, rel=0.01)
    assert sum(photons.values()) == 4000
    weights = {name: 4.0 if name == source_name("point") else 1.0 for name in watts}
    power = sum(value * weights[name] for name, value in watts.items())
    for name, count in photons.items():
        share = weights[name] * (0.875 * watts[name] / power + 0.125 / 7.0)
        assert count == pytest.approx(4000 * share, abs=1.0)


def test_a_lamp_keeps_photons_beside_a_far_larger_world(renderer):
    """The room in a world a million times as powerful: half of an eighth of the photons is the lamp's."""
    scene = scenes.room(8, **SETTINGS)
    scene.world = World(np.full(3, 1e5))
    watts, photons = told(renderer, scene)
    assert watts[ENVIRONMENT] > 1e6 * watts[source_name("light")]
    assert photons[source_name("light")] == pytest.approx(4000 / 16, abs=1.0)


def test_lights_of_one_name_are_one_source(renderer):
    scene = scenes.room(8, **SETTINGS)
    scene.lights.append(scene.lights[0])
    watts, photons = told(renderer, scene)
    assert photons == {source_name("light"): 4000}
    assert watts[source_name("light")] == pytest.approx(2 * math.pi * 12 * 0.25, rel=1e-3)


def test_a_dark_scene_has_no_sources(renderer):
    scene = scenes.room(8, **SETTINGS)
    scene.lights.clear()
    assert told(renderer, scene) == ({}, {})

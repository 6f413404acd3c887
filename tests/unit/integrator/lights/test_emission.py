# SPDX-License-Identifier: GPL-3.0-or-later
"""Powers of lights and shares of photons."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.lights.environment import distribution_of
from rppm_addon.integrator.lights.light_entry import (
    light_entry,
    spot_solid_angle,
    spread_constants,
    spread_integral,
)
from rppm_addon.integrator.lights.photon_allocation import apportion
from rppm_addon.materials.traits.emitted import Emits, emits
from rppm_addon.scene import Light, LightKind


@settings(deadline=None, derandomize=True)
@given(st.lists(st.floats(0, 1e6), min_size=1, max_size=20), st.integers(1, 100000))
def test_shares_add_up(weights, photons):
    weights = np.array(weights)
    counts = apportion(weights, photons)
    assert (counts >= 0).all()
    if weights.sum() <= 0:
        assert counts.sum() == 0
        return
    assert counts.sum() == photons
    assert (counts[weights == 0] == 0).all()
    if photons >= len(weights):
        assert (counts[weights > 0] >= 1).all()
        np.testing.assert_allclose(counts, photons * weights / weights.sum(), atol=len(weights) + 1)


@pytest.mark.parametrize("angle", [0.1, 0.8, 2.5])
def test_hard_spot_has_the_flux_of_its_cone(angle):
    cosine = math.cos(angle / 2)
    assert spot_solid_angle(cosine, 0.0) == pytest.approx(2 * math.pi * (1 - cosine), rel=1e-3)


def test_the_cone_of_a_sheared_spot_is_round_in_its_own_space():
    matrix = np.eye(4)
    matrix[:3, :3] = [[1.3, 0.2, -0.1], [0.0, 0.7, 0.4], [0.3, -0.2, 1.1]]
    entry, _ = light_entry(Light("spot", LightKind.SPOT, matrix, np.ones(3), spot_angle=1.0), 1.0)
    generator = np.random.default_rng(3)
    directions = generator.normal(size=(500, 3))
    local = directions @ np.linalg.inv(matrix[:3, :3]).T
    cosines = -local[:, 2] / np.linalg.norm(local, axis=1)
    seen = directions @ np.stack([entry["axis_u"], entry["axis_v"], entry["normal"]], axis=-1)
    np.testing.assert_allclose(seen[:, 2] / np.linalg.norm(seen, axis=1), cosines, rtol=0, atol=1e-5)
    within = directions[cosines >= entry["cosine_cone"]]
    along = within @ entry["normal"] / np.linalg.norm(within, axis=1)
    assert len(within) > 10
    assert along.min() >= 1.0 - entry["spread_scale"]


def test_soft_spot_has_the_flux_of_the_smooth_step():
    # the integral of 3x^2 - 2x^3 over [0, 1] is 1/2
    assert spot_solid_angle(0.5, 1.0) == pytest.approx(math.pi * 0.5, rel=1e-3)


@pytest.mark.parametrize("degrees", [170, 120, 90, 60, 20, 5])
def test_spread_keeps_the_flux_of_an_area_light(degrees):
    assert spread_integral(*spread_constants(math.radians(degrees))) == pytest.approx(math.pi, rel=2e-3)
    assert spread_constants(math.pi) == (0.0, 1.0)


def principled(**inputs):
    return Lobe(LobeKind.PRINCIPLED, emission_color=(4, 0, 0), **inputs)


@pytest.mark.parametrize(
    ("lobes", "expected"),
    [
        ([], Emits.NOTHING),
        ([Lobe(LobeKind.DIFFUSE, color=(9, 9, 9))], Emits.NOTHING),
        ([Lobe(LobeKind.EMISSION, color=(0, 0, 0))], Emits.NOTHING),
        ([Lobe(LobeKind.EMISSION, color=(0, 2, 0), strength=0.0)], Emits.NOTHING),
        ([Lobe(LobeKind.DIFFUSE), Lobe(LobeKind.EMISSION, color=(0, 2, 0))], Emits.EVENLY),
        ([Lobe(LobeKind.EMISSION, weight=0.5, color=(2, 2, 2), color_image=0)], Emits.VARYING),
        ([principled(emission_strength=0.0)], Emits.NOTHING),
        ([principled(emission_strength=1.0, coat_weight=0.5)], Emits.VARYING),
    ],
)
def test_what_emits(lobes, expected):
    assert emits(material("m", *lobes).graph) is expected


def test_environment_distribution_is_the_image_by_solid_angle():
    rng = np.random.default_rng(2)
    brightness = rng.random((16, 32)) ** 4
    listed = distribution_of(brightness)
    rows, cells = listed[:16], listed[16:].reshape(16, 32)
    share = np.diff(rows, prepend=0)[:, None] * np.diff(cells, axis=1, prepend=0)
    expected = (brightness + 0.01 * brightness.mean()) * np.sin(np.pi * (np.arange(16) + 0.5) / 16)[:, None]
    np.testing.assert_allclose(share, expected / expected.sum(), atol=2e-6)
    assert rows[-1] == 1 and (cells[:, -1] == 1).all()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Portals: what passes them, and how shadow rays and photons are shared out."""

import math

import numpy as np
import pytest

from rppm_addon.integrator.lights import portals
from rppm_addon.integrator.lights.light_records import LIGHT
from rppm_addon.scene import Light, LightKind


def portal(shape: str = "RECTANGLE", z: float = 1.0, **members: object) -> Light:
    """2 m along X and 1 m along Y, facing down."""
    matrix = np.eye(4)
    matrix[2, 3] = z
    values = {"size": (2.0, 1.0), "is_portal": True} | members
    return Light("portal", LightKind.AREA, matrix, np.zeros(3), shape=shape, **values)


def test_only_portals_with_an_area_are_taken():
    shining = Light("area", LightKind.AREA, np.eye(4), np.ones(3))
    (entry,) = portals.portal_entries([shining, portal(size=(0.0, 1.0)), portal()], 1.0)
    assert entry["area"] == pytest.approx(2.0) and entry["normal"] == pytest.approx((0, 0, -1))
    assert portals.portal_entries([shining], 1.0).dtype == LIGHT.dtype


@pytest.mark.parametrize(("shape", "area"), [("RECTANGLE", 2.0), ("ELLIPSE", math.pi / 2)])
def test_an_even_world_sends_its_irradiance(shape, area):
    """Pi times the radiance and the area, from one side; each cell has its largest light."""
    passed = portals.light_through(portals.portal_entries([portal(shape)], 1.0), None)
    assert portals.power_through(passed, 3.0) == pytest.approx(3.0 * math.pi * area, rel=0.04)
    assert (passed[: len(passed) // 2 - 1] == 0.0).all() and (passed[len(passed) // 2 + 1 :] > 0.0).all()


def test_a_map_counts_by_its_brightness():
    brightness = np.zeros((64, 128))
    brightness[-2:] = 5.0
    passed = portals.light_through(portals.portal_entries([portal(), portal(z=2.0)], 1.0), brightness)
    assert passed[-1] == pytest.approx(np.full(128, 5.0 * 4.0), rel=2e-3) and (passed[:-3] == 0.0).all()
    assert passed[-3] == pytest.approx(np.full(128, 5.0 * 4.0 / 8), rel=0.02)  # linear between cells


def test_a_sun_goes_on_at_the_seam():
    brightness = np.zeros((64, 128))
    brightness[-2, 0] = 64.0
    passed = portals.light_through(portals.portal_entries([portal()], 1.0), brightness)
    assert passed[-2, [-1, 0, 1]] == pytest.approx(2.0 * np.array([6.0, 36.0, 6.0]), rel=0.01)


def test_bright_spots_have_shadow_rays_of_their_own():
    sky = np.ones((32, 64))
    sun = sky.copy()
    sun[20, 10] = 1e6
    assert portals.shadow_ray_fractions(None) == portals.shadow_ray_fractions(sky) == (0.9, 0.0)
    assert portals.shadow_ray_fractions(sun) == pytest.approx((0.4, 0.5))


def test_openings_without_portals_keep_photons():
    assert portals.photon_fraction(np.array([4.0, 3.0])) == 0.75
    assert portals.photon_fraction(np.array([4.0, 0.0])) == 0.1 and portals.photon_fraction(np.array([4.0, 5.0])) == 0.9

# SPDX-License-Identifier: GPL-3.0-or-later
"""Eq. 2 and 3 and the limits of the radii."""

import math

import numpy as np
import pytest

from rppm_addon.integrator.density_estimation import radii
from rppm_addon.scene import Camera, RenderSettings


@pytest.mark.parametrize("alpha", [0.5, 0.7, 2 / 3])
def test_shrinkage_is_the_product_of_equation_2(alpha):
    radius = 1.0
    for iteration in range(1, 200):
        assert radii.shrinkage(iteration, alpha) == pytest.approx(radius, rel=1e-12)
        radius *= math.sqrt((iteration + alpha) / (iteration + 1))


@pytest.mark.parametrize("alpha", [0.5, 0.7])
def test_shrinkage_falls_at_the_theoretical_rate(alpha):
    # the product is Gamma(i + alpha) / (Gamma(i + 1) Gamma(1 + alpha)), so r_i / r_1 ~ i^((alpha - 1) / 2)
    ratio = radii.shrinkage(100000, alpha) / radii.shrinkage(1000, alpha)
    assert ratio == pytest.approx(100 ** ((alpha - 1) / 2), rel=1e-3)


def test_radius_follows_the_frame():
    def pixels(width, height):
        return radii.radius_in_pixels(RenderSettings(radius_scale=10), Camera(np.eye(4), (-1, 1, -1, 1), width, height))

    assert pixels(1024, 1024) == pytest.approx(10)
    assert pixels(128, 128) == pytest.approx(1.25)


def test_radii_that_the_user_gives_are_exact():
    assert radii.maximum_radius_factor(RenderSettings()) > 1.0
    for exact in ({"use_adaptive_radius": False}, {"radius_minimum": 0.1}, {"radius_maximum": 0.1}):
        assert radii.maximum_radius_factor(RenderSettings(**exact)) == 1.0


def test_limits_follow_the_view_and_the_user():
    footprints = np.concatenate([np.linspace(0.01, 0.02, 99), [0.0, np.nan, np.inf, 5.0]])
    low, high = radii.radius_limits(RenderSettings(), footprints, 10.0)
    assert 0 < low < 0.01 < high < 0.03
    assert radii.radius_limits(RenderSettings(radius_minimum=0.5, radius_maximum=0.7), footprints, 10.0) == (0.5, 0.7)
    low, high = radii.radius_limits(RenderSettings(), np.zeros(5), 10.0)
    assert 0 < low <= high < 10


def test_wide_radius_holds_the_expected_photons():
    cube = np.zeros(3), np.full(3, 10.0)
    radius = radii.wide_radius(60000, radii.EXPECTED_PHOTONS, *cube)
    assert 60000 / 600 * math.pi * radius**2 == pytest.approx(radii.EXPECTED_PHOTONS)


def test_fitted_radius_would_find_the_expected_photons():
    generator = np.random.default_rng(5)
    density = 900.0  # photons per m^2
    counts = generator.poisson(density * math.pi * 0.2**2, 4000)
    fitted = radii.fitted_wide_radius(0.2, radii.EXPECTED_PHOTONS, radii.photons_found(counts))
    assert density * math.pi * fitted**2 == pytest.approx(radii.EXPECTED_PHOTONS, rel=0.02)
    sparse = generator.poisson(0.2, 4000)
    fitted = radii.fitted_wide_radius(0.2, radii.EXPECTED_PHOTONS, radii.photons_found(sparse))
    assert fitted == pytest.approx(0.2 * math.sqrt(2 * radii.EXPECTED_PHOTONS / 0.2), rel=0.05)
    assert radii.fitted_wide_radius(0.2, radii.EXPECTED_PHOTONS, radii.photons_found(np.zeros(9))) == math.inf


def test_rays_that_find_nothing_do_not_widen_the_radius_of_those_that_do():
    counts = np.random.default_rng(6).poisson(200, 4000) * (np.arange(4000) % 50 == 0)
    assert radii.photons_found_by_gathering(counts) == pytest.approx(200, rel=0.02)
    assert radii.photons_found_by_gathering(np.zeros(9)) == 0


def test_widest_radius_follows_scene_and_view():
    cube = np.zeros(3), np.full(3, 10.0)
    assert radii.widest_radius(np.zeros(4), *cube) == pytest.approx(0.05 * math.sqrt(300))
    assert radii.widest_radius(np.array([0.0, 0.01, 0.02, 0.5, np.inf]), *cube) == pytest.approx(0.2)

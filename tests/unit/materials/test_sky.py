# SPDX-License-Identifier: GPL-3.0-or-later
"""Skies without Blender: closed forms and symmetries; tests/parity/skies/test_sky_values.py compares them to Cycles."""

import math

import numpy as np
import pytest

from rppm_addon.materials.colorimetry import black_body
from rppm_addon.materials.sky.picture import sky_picture, sky_radiance, sun_disc
from rppm_addon.materials.sky.single_scattering import SUN_SOLID_ANGLE, SUN_TEMPERATURE
from rppm_addon.scene.sky import Sky

SCATTERING = ["SINGLE_SCATTERING", "MULTIPLE_SCATTERING"]


def _directions(count: int = 100) -> np.ndarray:
    directions = np.random.default_rng(7).normal(size=(count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


@pytest.mark.parametrize("sky_type", SCATTERING)
def test_no_air_no_sky(sky_type):
    """In a vacuum the sky is black, and the sun gives the same light low and high."""
    sky = Sky(sky_type, math.radians(40.0), air_density=0.0, aerosol_density=0.0, ozone_density=0.0)
    assert not sky_radiance(sky, _directions()).any()
    high = Sky(sky_type, math.radians(90.0), sun_size=0.1, air_density=0.0, aerosol_density=0.0, ozone_density=0.0)
    low = Sky(sky_type, math.radians(10.0), sun_size=0.1, air_density=0.0, aerosol_density=0.0, ozone_density=0.0)
    assert np.allclose(sun_disc(high).irradiance(), sun_disc(low).irradiance(), rtol=1e-6)


def test_a_black_body_gives_the_solar_constant():
    """All wavelengths together give sigma T^4 / pi, and the sun's disk about 1361 W/m^2 of it."""
    wavelength = np.geomspace(5e-8, 1e-3, 20001)
    between = 0.5 * (black_body(wavelength[1:], SUN_TEMPERATURE) + black_body(wavelength[:-1], SUN_TEMPERATURE))
    radiance = (between * np.diff(wavelength)).sum()
    assert radiance == pytest.approx(5.670374e-8 * SUN_TEMPERATURE**4 / math.pi, rel=1e-4)
    assert radiance * SUN_SOLID_ANGLE == pytest.approx(1361.0, rel=0.01)


@pytest.mark.parametrize("sky_type", SCATTERING)
def test_limb_darkening_takes_a_fifth(sky_type):
    """The mean of 1 - 0.6 (1 - sqrt(1 - x^2)) over a disk is 0.8, and size does not change the irradiance."""
    elevation = math.radians(90.0)
    small = sun_disc(Sky(sky_type, elevation, sun_size=0.02))
    large = sun_disc(Sky(sky_type, elevation, sun_size=0.04))
    solid_angle = 2.0 * math.pi * (1.0 - math.cos(0.01))
    assert np.allclose(small.irradiance(), 0.8 * solid_angle * small.top, rtol=1e-3)
    assert np.allclose(small.irradiance(), large.irradiance(), rtol=2e-3)


@pytest.mark.parametrize("sky_type", SCATTERING)
def test_the_sun_turns_with_its_rotation(sky_type):
    """The sky of a sun turned by an angle, looked at as much turned, is the same; angles past the zenith mean the same
    sun as those on the other side."""
    directions = _directions()
    reference = sky_radiance(Sky(sky_type, math.radians(20.0)), directions)
    angle = math.radians(70.0)
    turn = np.array([[math.cos(angle), math.sin(angle), 0], [-math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
    turned = sky_radiance(Sky(sky_type, math.radians(20.0), angle), directions @ turn.T)
    assert np.allclose(turned, reference, rtol=1e-4, atol=1e-6)
    beyond = Sky(sky_type, math.radians(160.0), angle - math.pi)
    assert np.allclose(sky_radiance(beyond, directions @ turn.T), reference, rtol=1e-4, atol=1e-6)
    assert np.allclose(beyond.direction_to_sun(), Sky(sky_type, math.radians(20.0), angle).direction_to_sun())


def test_sun_disc_is_where_it_is_wanted():
    assert sun_disc(Sky("PREETHAM")) is None
    assert sun_disc(Sky(sun_disc=False)) is None
    assert sun_disc(Sky(sun_intensity=0.0)) is None
    disk = sun_disc(Sky(sun_elevation=0.5, sun_rotation=1.0))
    assert np.allclose(disk.direction, [math.sin(1) * math.cos(0.5), math.cos(1) * math.cos(0.5), math.sin(0.5)])
    assert disk.radiance(disk.direction[None]).min() > 1e5
    assert not disk.radiance(-disk.direction[None]).any()


def test_unknown_types_are_refused():
    with pytest.raises(ValueError, match="NISHITA"):
        sky_radiance(Sky("NISHITA"), np.array([[0.0, 0.0, 1.0]]))


def test_picture_is_laid_out_as_environments_are():
    """u = 1/2 - azimuth / 2 pi from +X toward +Y: +Y is a quarter across. Rows go up."""
    height = 64
    sky = Sky(sun_elevation=0.6, sun_rotation=0.0)
    picture = sky_picture(sky, height)
    assert picture.shape == (height, 2 * height, 4) and picture.dtype == np.float32
    row, column = np.unravel_index(picture[height // 2 + 8 :, :, 0].argmax(), (height // 2 - 8, 2 * height))
    assert abs(column + 0.5 - height / 2) <= 1.0
    assert abs((row + 8.5) / height * np.pi - 0.6) <= 2.0 * np.pi / height
    assert picture[height // 2 :, :, :3].mean() > 10.0 * picture[: height // 2, :, :3].mean()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The Sky Texture's values against those of Cycles, direction by direction."""

import math
from dataclasses import replace

import bpy
import numpy as np
import pytest

from rppm_addon.materials.sky.picture import sky_radiance, sun_disc
from rppm_addon.scene.sky import Sky

from .skies import close_ups, panorama

if "MULTIPLE_SCATTERING" not in bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items:
    pytest.skip("the skies of Blender before 5.0 have other names and values", allow_module_level=True)

SINGLE, MULTIPLE = "SINGLE_SCATTERING", "MULTIPLE_SCATTERING"


def _sky(sky_type: str, elevation: float, altitude: float = 100.0, densities=(1.0, 1.0, 1.0), **more) -> Sky:
    """Angles in degrees, densities of air, aerosols and ozone."""
    air, aerosol, ozone = densities
    return Sky(
        sky_type,
        math.radians(elevation),
        math.radians(more.pop("rotation", 0.0)),
        altitude=altitude,
        air_density=air,
        aerosol_density=aerosol,
        ozone_density=ozone,
        **more,
    )


def _toward(elevation: float, azimuth: float) -> tuple[float, float, float]:
    elevation, azimuth = math.radians(elevation), math.radians(azimuth)
    along = math.cos(elevation)
    return along * math.sin(azimuth), along * math.cos(azimuth), math.sin(elevation)


def _both_types(rows: dict[str, tuple], each_time: set[tuple[str, str]]) -> list:
    """Rows as parameters, with each type of sky; with the long tests but for those that are named."""
    return [
        pytest.param(
            sky_type, *row, id=f"{name}-{sky_type}", marks=[] if (name, sky_type) in each_time else [pytest.mark.long]
        )
        for sky_type in (SINGLE, MULTIPLE)
        for name, row in rows.items()
    ]


EACH_TIME = {
    ("night", MULTIPLE), ("sunset", SINGLE), ("noon", SINGLE), ("past_zenith", MULTIPLE), ("air", SINGLE),
    ("haze", MULTIPLE), ("ozone", SINGLE), ("airplane", MULTIPLE),
}  # fmt: skip
SCATTERING = {
    "night": (-5.0, 100.0, (1, 1, 1), 0.0),
    "sunset": (2.0, 100.0, (1, 1, 1), 70.0),
    "noon": (60.0, 2000.0, (1, 1, 1), -30.0),
    "past_zenith": (130.0, 100.0, (1, 1, 1), 20.0),
    "air": (30.0, 100.0, (1, 0, 0), 0.0),
    "haze": (10.0, 100.0, (0.1, 10, 1), 0.0),
    "ozone": (5.0, 100.0, (2, 0, 5), 0.0),
    "airplane": (20.0, 12000.0, (1, 1, 1), 0.0),
}


@pytest.mark.parametrize("sky_type, elevation, altitude, densities, rotation", _both_types(SCATTERING, EACH_TIME))
def test_scattering(sky_type, elevation, altitude, densities, rotation):
    sky = _sky(sky_type, elevation, altitude, densities, rotation=rotation, sun_disc=False)
    _compare(sky, mean=5e-4, pixel=0.005)


@pytest.mark.parametrize("elevation, azimuth, turbidity", [(30, 0, 2.2), (90, 0, 3), (10, 50, 5), (2, -100, 1.5)])
def test_preetham(elevation, azimuth, turbidity):
    sky = Sky("PREETHAM", sun_direction=_toward(elevation, azimuth), turbidity=turbidity)
    _compare(sky, mean=1e-4, pixel=1e-3)


@pytest.mark.parametrize(
    "elevation, azimuth, turbidity, albedo",
    [
        (30, 0, 2.2, 0.3),
        (90, 0, 3, 1),
        (10, 50, 5.7, 0.8),
        (2, -100, 1.4, 0.1),
        (0.3, 0, 9.9, 0.5),
        (-20, 30, 3.3, 0.3),
    ],
)
def test_hosek_wilkie(elevation, azimuth, turbidity, albedo):
    """None of them among the renders that the coefficients come from."""
    sky = Sky("HOSEK_WILKIE", sun_direction=_toward(elevation, azimuth), turbidity=turbidity, ground_albedo=albedo)
    _compare(sky, mean=1e-3, pixel=0.005)


def _compare(sky: Sky, mean: float, pixel: float) -> None:
    """mean: allowed difference of each channel's mean; pixel: of each pixel's channel, and a hundredth of it of the
    mean and of the pixel's brightest channel. They cover Cycles' single precision: heights above the sea are whole half
    meters, and a channel near the end of Rec.709's gamut is a small difference of X, Y and Z."""
    reference, directions = panorama(sky)
    ours = sky_radiance(sky, directions)
    level, brightest = reference.mean(axis=0), reference.max(axis=1, keepdims=True)
    assert level.min() > 0.0
    figures = (
        np.abs(ours.mean(axis=0) / level - 1.0).max(),
        (np.abs(ours - reference) / (reference + 0.01 * np.maximum(level, brightest))).max(),
    )
    print(f"{sky.sky_type}: means differ by {figures[0]:.6f}, pixels by {figures[1]:.5f}")
    assert figures[0] < mean and figures[1] < pixel


SUNS_EACH_TIME = {
    ("day", SINGLE), ("red", MULTIPLE), ("half_set", MULTIPLE), ("below_level", SINGLE), ("dense", SINGLE),
}  # fmt: skip
SUNS = {
    "day": (30.0, 0.545, 100.0, (1, 1, 1)),
    "red": (2.0, 4.0, 100.0, (1, 1, 1)),
    "half_set": (0.3, 4.0, 100.0, (1, 1, 0)),
    "below_level": (-1.0, 4.0, 20000.0, (1, 1, 1)),
    "dense": (45.0, 1.0, 100.0, (2, 3, 4)),
}


@pytest.mark.parametrize("sky_type, elevation, size, altitude, densities", _both_types(SUNS, SUNS_EACH_TIME))
def test_sun_disc(sky_type, elevation, size, altitude, densities):
    """Cycles with the disk less Cycles without it."""
    sky = _sky(sky_type, elevation, altitude, densities, rotation=25.0, sun_size=math.radians(size), sun_intensity=1.5)
    angle = 1.2 * sky.sun_size
    (with_disk, without), directions = close_ups((sky, replace(sky, sun_disc=False)), angle)
    reference = with_disk - without
    disk = sun_disc(sky)
    ours = disk.radiance(directions)
    level = reference.mean(axis=0)
    at_edge = np.any(reference > 0.0, axis=1) != np.any(ours > 0.0, axis=1)
    assert at_edge.mean() < 0.01
    difference = (np.abs(ours - reference) / level.max())[~at_edge]
    print(f"{sky.sky_type}: {at_edge.sum()} pixels at the edge, others differ by {difference.max():.5f} of the mean")
    assert difference.max() < 0.002
    # The sun light that stands in: the picture's sum over solid angle, whose rim a pixel grid knows to a percent.
    forward = directions @ sky.direction_to_sun()
    solid_angle = (2.0 * math.tan(angle / 2) / math.sqrt(len(directions))) ** 2 * forward**3
    irradiance = (reference * solid_angle[:, None]).sum(axis=0)
    assert np.allclose(disk.irradiance(), irradiance, rtol=0.01, atol=1e-3 * irradiance.max())


@pytest.mark.parametrize("sky_type, elevation, altitude", [(SINGLE, -0.4, 20000.0), (MULTIPLE, -0.9, 100.0)])
def test_no_disk_below_the_horizon(sky_type, elevation, altitude):
    sky = _sky(sky_type, elevation, altitude)
    assert sun_disc(sky) is None
    assert np.array_equal(*close_ups((sky, replace(sky, sun_disc=False)), 0.02)[0])

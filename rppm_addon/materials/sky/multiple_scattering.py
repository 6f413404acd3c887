# SPDX-License-Identifier: GPL-3.0-or-later
"""A sky of light that was scattered many times, as Cycles computes it since Blender 5.0.

Light scattered once is summed along each direction, in four wavelengths. The light that reaches a place from the
rest of the atmosphere is a fitted function of the sun's height there, that from the ground is that of a diffuse
plane below (after Hillaire 2020; fits and constants are those of Fernando Garcia Linan's spectral sky, 2023, on
which Cycles' is built: spectra of the sun by the NREL, Rayleigh scattering by Bucholtz 1995, ozone by Gorshelev 2014,
a city's aerosols by Hess 1998). Lengths here are in kilometers.
"""

import numpy as np

from ...scene.common.working_space import REC709, WorkingSpace
from ...scene.sky import Sky
from ..colorimetry import XYZ_TO_REC709
from .table import COLUMNS, ROWS, azimuths_from_sun, mirrored, row_elevations

EARTH_RADIUS = 6371.0
THICKNESS = 100.0
ATMOSPHERE_RADIUS = EARTH_RADIUS + THICKNESS
STEPS = 64
GROUND_ALBEDO = 0.3
AEROSOL_ASYMMETRY = 0.8
LOWEST, HIGHEST = 1e-3, THICKNESS - 1e-3
"""Where the viewer is held, km above the sea."""

SUN_IRRADIANCE = np.array([1.679, 1.828, 1.986, 1.307])
"""W/m^2 per nm above the atmosphere, at 630, 560, 490 and 430 nm as all that follows."""
AIR_SCATTERING = np.array([6.605e-3, 1.067e-2, 1.842e-2, 3.156e-2])
"""1/km at sea level."""
OZONE_CROSS_SECTION = np.array([3.472e-25, 3.914e-25, 1.349e-25, 11.03e-27])
OZONE_DOBSON = 334.5
OZONE_DENSITY = 3.78547397e20
AEROSOL_SCATTERING = np.array([1.5908e-22, 1.7711e-22, 2.0942e-22, 2.4033e-22])
AEROSOL_ABSORPTION = np.array([2.8722e-24, 4.6168e-24, 7.9706e-24, 1.3578e-23])
AEROSOL_DENSITY = 1.3681e20
AEROSOL_BACKGROUND = 2e6
AEROSOL_SCALE_HEIGHT = 0.73
SCATTERED_AGAIN = 0.02 * np.array([0.217, 0.347, 0.594, 1.0])
"""Radiance from all around that reaches a place in daylight, for a sun of irradiance 1; 1/sr."""

_LINAN_TO_REC709 = np.array(
    [
        (137.672389239975, -8.632904716299537, -1.7181567391931372),
        (32.549094028629234, 91.29801417199785, -12.005406444382531),
        (-38.91428392614275, 34.31665471469816, 29.89044807197628),
        (8.572844237945445, -11.103384660054624, 117.47585277566478),
    ]
)
"""(4, 3) weights of the four wavelengths in Rec.709, fitted to colors of spectra."""
_HIS_XYZ_TO_REC709 = np.array(
    [
        (3.2404542, -1.5371385, -0.4985314),
        (-0.9692660, 1.8760108, 0.0415560),
        (0.0556434, -0.2040259, 1.0572252),
    ]
)
"""The fit is to these primaries, whose white is a little off that of Rec.709 in Blender."""
TO_REC709 = _LINAN_TO_REC709 @ np.linalg.inv(_HIS_XYZ_TO_REC709).T @ XYZ_TO_REC709.T

COSINES, HEIGHTS = 256, 64
"""Size of the table of the sun's transmittance, linear in the cosine to the zenith and in height, ends included."""


def _coefficients(height: np.ndarray, sky: Sky) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Scattering of air, scattering of aerosols and extinction in 1/km, each (..., 4), at heights in km."""
    height = np.maximum(height, 0.0)[..., None]
    air = sky.air_density * AIR_SCATTERING * np.exp(-0.07771971 * height**1.16364243)
    particles = sky.aerosol_density * (AEROSOL_DENSITY * np.exp(height / -AEROSOL_SCALE_HEIGHT) + AEROSOL_BACKGROUND)
    above = height + 1e-4
    layer = np.exp(-5.55555555 * (np.log(above) - 3.22261) ** 2) / above
    ozone = sky.ozone_density * OZONE_DOBSON * OZONE_DENSITY * OZONE_CROSS_SECTION * layer
    aerosol = AEROSOL_SCATTERING * particles
    return air, aerosol, air + aerosol + AEROSOL_ABSORPTION * particles + ozone


def viewer_radius(sky: Sky) -> np.ndarray:
    """() float64 distance of the viewer to the Earth's center, km, to half a meter: as Cycles' single precision has it,
    which shows in what a viewer near the ground sees below."""
    return np.float64(np.float32(EARTH_RADIUS + np.clip(sky.altitude * 1e-3, LOWEST, HIGHEST)))  # type: ignore[return-value]


def _to_space(radius: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    """Way from a distance to the Earth's center to space, km; rays go through the Earth."""
    return -radius * cosine + np.sqrt(np.maximum(radius**2 * (cosine**2 - 1.0) + ATMOSPHERE_RADIUS**2, 0.0))


def transmittance(radius: np.ndarray, cosine: np.ndarray, sky: Sky) -> np.ndarray:
    """(..., 4) fraction of light that comes from space to a point.

    radius: distance to the Earth's center, km; cosine: of the angle to the zenith; they broadcast.
    """
    step = _to_space(radius, cosine) / STEPS
    depth = 0.0
    for index in range(STEPS):
        way = step * (index + 0.5)
        there = np.sqrt(radius**2 + way**2 + 2.0 * radius * way * cosine)
        depth = depth + step[..., None] * _coefficients(there - EARTH_RADIUS, sky)[2]
    return np.exp(-depth)


def _transmittance_table(sky: Sky) -> np.ndarray:
    """(HEIGHTS, COSINES, 4) float32."""
    radius = EARTH_RADIUS + THICKNESS * np.linspace(0.0, 1.0, HEIGHTS)[:, None]
    return transmittance(radius, np.linspace(-1.0, 1.0, COSINES)[None, :], sky).astype(np.float32)


def sky_table(sky: Sky, space: WorkingSpace = REC709) -> np.ndarray:
    """(ROWS, COLUMNS, 3) float32 radiance in a working space; sky_table.look_up reads it."""
    sun_light = _transmittance_table(sky)
    elevation, azimuth = row_elevations(0.5), azimuths_from_sun(0.5)
    up, along = np.sin(elevation), np.cos(elevation)
    viewer = viewer_radius(sky)
    ground = viewer**2 * (up**2 - 1.0) + EARTH_RADIUS**2
    meets = (up < 0.0) & (ground > 0.0)
    length = np.where(meets, -viewer * up - np.sqrt(np.maximum(ground, 0.0)), _to_space(viewer, up))
    sun_elevation, _ = sky.sun_angles()
    sun_up, sun_along = np.sin(sun_elevation), np.cos(sun_elevation)
    to_sun = np.outer(along * sun_along, np.cos(azimuth)) + (up * sun_up)[:, None]  # (rows, columns)
    g = AEROSOL_ASYMMETRY
    air_phase = (3.0 / (16.0 * np.pi) * (1.0 + to_sun**2)).astype(np.float32)[..., None]
    aerosol_phase = (1.0 - g * g) / (4.0 * np.pi * (1.0 + g * g - 2.0 * g * to_sun) ** 1.5)
    aerosol_phase = aerosol_phase.astype(np.float32)[..., None]

    step = length / STEPS
    through = np.ones((ROWS, 4))
    radiance = np.zeros((ROWS, COLUMNS // 2, 4), np.float32)
    rows = np.arange(ROWS)[:, None]
    for index in range(STEPS):
        way = step * (index + 0.5)
        radius = np.sqrt(viewer**2 + way**2 + 2.0 * viewer * way * up)
        height = radius - EARTH_RADIUS
        air, aerosol, extinction = _coefficients(height, sky)
        kept = np.exp(-step[:, None] * extinction)
        weight = SUN_IRRADIANCE * through * (1.0 - kept) / np.maximum(extinction, 1e-7)
        through *= kept

        # The sun's light at each row's height, by the cosine.
        level = np.clip(height / THICKNESS, 0.0, 1.0) * (HEIGHTS - 1)
        floor = np.minimum(level.astype(np.int64), HEIGHTS - 2)
        between = (level - floor).astype(np.float32)[:, None, None]
        by_cosine = (1.0 - between) * sun_light[floor] + between * sun_light[floor + 1]  # (rows, COSINES, 4)
        rising = by_cosine[:, -1]
        # Isotropic light from the ground, which fills this solid angle.
        solid_angle = 2.0 * np.pi * (1.0 - np.sqrt(np.maximum(radius**2 - EARTH_RADIUS**2, 0.0)) / radius)
        from_ground = (GROUND_ALBEDO / np.pi / (4.0 * np.pi) * solid_angle)[:, None] * sun_light[0, -1]
        from_ground = from_ground / np.maximum(rising, 1e-30)

        cosine = ((viewer * sun_up + way[:, None] * to_sun) / radius[:, None]).astype(np.float32)
        column = np.clip(0.5 * cosine + 0.5, 0.0, 1.0) * np.float32(COSINES - 1)
        left = np.minimum(column.astype(np.int64), COSINES - 2)
        part = (column - left).astype(np.float32)[..., None]
        direct = by_cosine[rows, left]
        direct += part * (by_cosine[rows, left + 1] - direct)
        on_ground = sun_light[0, left]
        on_ground += part * (sun_light[0, left + 1] - on_ground)

        air, aerosol = (weight * air).astype(np.float32)[:, None], (weight * aerosol).astype(np.float32)[:, None]
        day = (1.0 / (1.0 + 5.0 * np.exp(np.float32(-17.92) * cosine)))[..., None]
        radiance += direct * (air_phase * air + aerosol_phase * aerosol)
        both = air + aerosol
        radiance += day * (both * SCATTERED_AGAIN.astype(np.float32))
        radiance += np.maximum(cosine, 0.0)[..., None] * on_ground * (both * from_ground[:, None].astype(np.float32))
    return mirrored(np.maximum(space.from_rec709(radiance @ TO_REC709.astype(np.float32)), 0.0))


def sun_irradiance(sky: Sky, elevation: float) -> np.ndarray:
    """(3,) float64 irradiance on a surface that faces a point-like sun at an elevation in radians, in Rec.709."""
    return (SUN_IRRADIANCE * transmittance(viewer_radius(sky), np.sin(elevation), sky)) @ TO_REC709

# SPDX-License-Identifier: GPL-3.0-or-later
"""A sky of light that was scattered once (Nishita et al. 1993), as Cycles computes it.

Air, aerosols and ozone lie around a spherical Earth. Along each direction sunlight is scattered in STEPS places, and
absorbed on its way there and from there. 21 wavelengths. Constants are those that make the pictures equal Cycles':
the sun is a black body, Rayleigh's law holds without dispersion, aerosols are gray, ozone has measured spectra.
"""

import numpy as np

from ...scene.common.working_space import REC709, WorkingSpace
from ...scene.sky import Sky
from ..colorimetry import COLOR_MATCHING, WAVELENGTHS, XYZ_TO_REC709, black_body
from .table import ROWS, azimuths_from_sun, mirrored, row_elevations

EARTH_RADIUS = 6360e3
ATMOSPHERE_RADIUS = 6420e3
LOWEST, HIGHEST = 1.0, 59999.0
"""Where the viewer is held, meters above the sea."""
AIR_SCALE_HEIGHT = 8000.0
AEROSOL_SCALE_HEIGHT = 1200.0
STEPS = 32
AEROSOL_ASYMMETRY = 0.76

SUN_TEMPERATURE = 5778.0
SUN_SOLID_ANGLE = 6.790164e-5
"""Solid angle of the true sun seen from the Earth, which determines its irradiance; sr."""
SUN_IRRADIANCE = 1e-9 * SUN_SOLID_ANGLE * black_body(WAVELENGTHS, SUN_TEMPERATURE)
"""(21,) W/m^2 per nm above the atmosphere."""

AIR_SCATTERING = 1.1311488e-30 / WAVELENGTHS**4
"""(21,) 1/m at sea level."""
AEROSOL_SCATTERING = 2e-5
"""1/m at sea level."""
AEROSOL_EXTINCTION = 1.11 * AEROSOL_SCATTERING
OZONE_ABSORPTION = 1e-9 * np.array(
    [
        3.25126850,
        5.85395365,
        19.7719116,
        73.0956763,
        200.845615,
        403.839581,
        635.513359,
        967.070412,
        1547.97400,
        2090.38647,
        2461.28056,
        2735.51299,
        2151.25863,
        1590.51841,
        1123.56198,
        735.275515,
        464.501304,
        330.960799,
        225.126123,
        148.791293,
        168.286234,
    ]
)
"""(21,) 1/m where ozone is densest: the Chappuis band."""

_EXTINCTION = np.stack([AIR_SCATTERING, np.full_like(AIR_SCATTERING, AEROSOL_EXTINCTION), OZONE_ABSORPTION])
_TO_REC709 = COLOR_MATCHING @ XYZ_TO_REC709.T * 20.0
"""(21, 3): 20 nm between wavelengths."""
_NODES, _WEIGHTS = np.polynomial.laguerre.laggauss(8)
_WEIGHTS = _WEIGHTS * np.exp(_NODES) / 25.0
_NODES = _NODES / 25.0
"""Where Cycles looks at the density along a ray of length 1: densities decay like Gauss-Laguerre's weight."""


def viewer_radius(sky: Sky) -> np.ndarray:
    """() float64 distance of the viewer to the Earth's center, meters; Cycles keeps it inside the atmosphere."""
    return np.float64(EARTH_RADIUS + np.clip(sky.altitude, LOWEST, HIGHEST))  # type: ignore[return-value]


def _densities(height: np.ndarray, sky: Sky) -> list[np.ndarray]:
    """Densities of air, aerosols and ozone at heights in meters, each of the height's shape."""
    ozone = np.minimum(height / 15e3 - 2.0 / 3.0, 8.0 / 3.0 - height / 15e3)
    return [
        sky.air_density * np.exp(height / -AIR_SCALE_HEIGHT),
        sky.aerosol_density * np.exp(height / -AEROSOL_SCALE_HEIGHT),
        sky.ozone_density * np.maximum(ozone, 0.0),
    ]


def _depths(radius: np.ndarray, cosine: np.ndarray, sky: Sky) -> np.ndarray:
    """(..., 3) lengths of air, aerosols and ozone at sea level's density, in meters, from a point to space.

    radius: the point's distance to the Earth's center, meters; cosine: of the ray's angle to the zenith.
    """
    length = -radius * cosine + np.sqrt(np.maximum(radius**2 * (cosine**2 - 1.0) + ATMOSPHERE_RADIUS**2, 0.0))
    depths = np.zeros((3, *np.shape(radius)), np.float32)
    height = radius - EARTH_RADIUS
    for node, weight in zip(_NODES, _WEIGHTS):
        way = length * node
        # sqrt(r^2 + e) - r without cancellation
        excess = way * (way + 2.0 * radius * cosine)
        there = height + excess / (radius + np.sqrt(radius**2 + excess))
        for index, density in enumerate(_densities(there.astype(np.float32), sky)):
            depths[index] += weight * density
    return np.moveaxis(depths * length, 0, -1)


def sky_table(sky: Sky, space: WorkingSpace = REC709) -> np.ndarray:
    """(ROWS, COLUMNS, 3) float32 radiance in a working space; sky_table.look_up reads it."""
    elevation = row_elevations(0.0)
    upper = elevation[ROWS // 2 :]
    table = mirrored(np.maximum(space.from_rec709(_upper_half(sky, upper)), 0.0))
    # Below the horizon Cycles lets the horizon's color fade: there is no ground.
    fade = np.maximum(1.0 + 2.5 * np.sin(elevation[: ROWS // 2]), 0.0) ** 3
    return np.concatenate([fade[:, None, None].astype(np.float32) * table[0], table])


def _upper_half(sky: Sky, elevation: np.ndarray) -> np.ndarray:
    """(rows, COLUMNS / 2, 3) float32 radiance in Rec.709."""
    azimuth = azimuths_from_sun(0.0)
    up, along = np.sin(elevation), np.cos(elevation)
    radius = viewer_radius(sky)
    length = -radius * up + np.sqrt(radius**2 * (up**2 - 1.0) + ATMOSPHERE_RADIUS**2)
    sun_elevation, _ = sky.sun_angles()
    sun_up, sun_along = np.sin(sun_elevation), np.cos(sun_elevation)
    to_sun = np.outer(along * sun_along, np.cos(azimuth)) + (up * sun_up)[:, None]  # (rows, columns)
    g = AEROSOL_ASYMMETRY
    air_phase = 3.0 / (16.0 * np.pi) * (1.0 + to_sun**2)
    aerosol_phase = 3.0 * (1.0 - g * g) / (8.0 * np.pi * (2.0 + g * g))
    aerosol_phase = aerosol_phase * (1.0 + to_sun**2) / (1.0 + g * g - 2.0 * g * to_sun) ** 1.5
    # What a place adds in each wavelength, for air and for aerosols, in Rec.709.
    colors = np.concatenate(
        [
            (AIR_SCATTERING * SUN_IRRADIANCE)[:, None] * _TO_REC709,
            (AEROSOL_SCATTERING * SUN_IRRADIANCE)[:, None] * _TO_REC709,
        ],
        axis=1,
    ).astype(np.float32)
    extinction = -_EXTINCTION.astype(np.float32)
    radiance = np.zeros((*to_sun.shape, 3), np.float32)
    passed = np.zeros((len(elevation), 3))
    step = length / STEPS
    for index in range(STEPS):
        way = step * (index + 0.5)
        here = np.sqrt(radius**2 + way**2 + 2.0 * radius * way * up)
        density = np.stack(_densities(here - EARTH_RADIUS, sky), axis=-1)  # (rows, 3)
        passed += density * step[:, None]
        cosine = ((radius * sun_up)[..., None] + way[:, None] * to_sun) / here[:, None]
        here = np.broadcast_to(here[:, None], cosine.shape)
        lit = (cosine > 0.0) | (here**2 * (1.0 - cosine**2) > EARTH_RADIUS**2)
        row = np.nonzero(lit)[0]
        depth = passed[row] + _depths(here[lit], cosine[lit], sky)
        left = np.exp(depth.astype(np.float32) @ extinction) @ colors  # (lit, 6)
        air = (air_phase * (density[:, 0] * step)[:, None])[lit][:, None]
        aerosol = (aerosol_phase * (density[:, 1] * step)[:, None])[lit][:, None]
        radiance[lit] += air * left[:, :3] + aerosol * left[:, 3:]
    return radiance


def sun_irradiance(sky: Sky, elevation: float) -> np.ndarray:
    """(3,) float64 irradiance on a surface that faces a point-like sun at an elevation in radians, in Rec.709.

    Cycles leaves out here what ozone absorbs.
    """
    depth = _depths(viewer_radius(sky), np.sin(elevation), sky)[:2]
    return (SUN_IRRADIANCE * np.exp(-depth @ _EXTINCTION[:2])) @ _TO_REC709

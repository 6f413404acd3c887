# SPDX-License-Identifier: GPL-3.0-or-later
"""The analytic daylight of Hosek and Wilkie 2012, with the coefficients that Cycles' renders show.

Per channel of CIE XYZ, radiance is (1 + A exp(B / (cos t + 0.01))) (C + D exp(E g) + F cos^2 g + G chi(H, g) +
I sqrt(cos t)), t the angle to the zenith and g to the sun. The authors fitted the nine numbers to path-traced skies.
Ours were found by solving for them in renders of Cycles (tests/parity/skies/measure_hosek_wilkie.py), which the form
meets to 2e-7. C, D, F, G and I include the channel's overall radiance.

In the cube root of the sun's elevation A, B, E and H are polynomials of degree five and the products of degree ten,
so that twelve elevations determine all; in turbidity and albedo they are pieces of degree two, which values at the ends
and the middle determine.
"""

from pathlib import Path

import numpy as np

from ...scene.common.working_space import REC709, WorkingSpace
from ...scene.sky import Sky
from ..colorimetry import XYZ_TO_REC709

TURBIDITIES = np.arange(1.0, 10.01, 0.5)
ALBEDOS = (0.0, 0.5, 1.0)
LOWEST_COSINE = np.cos(np.pi / 2 - 1e-3)
"""Below it the horizon's values go on."""
_FILE = Path(__file__).with_name("hosek_wilkie.npz")


ELEVATION_NODES = np.append(0.0, 0.53 - 0.47 * np.cos((np.arange(11) + 0.5) * np.pi / 11))
"""Cube roots of the sun's elevation as a fraction of a quarter turn: 0, and Chebyshev's nodes from 0.06 to 1. Just
above 0 single precision moves Cycles' sun, so that nothing can be measured there."""


def _lagrange(nodes: np.ndarray, x: float) -> np.ndarray:
    """Weights of the values at nodes in the polynomial's value at x."""
    weights = np.ones(len(nodes))
    for i, node in enumerate(nodes):
        for other in np.delete(nodes, i):
            weights[i] *= (x - other) / (node - other)
    return weights


def coefficients(elevation: float, turbidity: float, albedo: float) -> np.ndarray:
    """(3, 9) float64 for X, Y, Z: A, B, E, H, then C, D, F, G, I.

    elevation: of the sun, radians; turbidity 1 to 10, albedo 0 to 1.
    """
    with np.load(_FILE) as file:
        table = file["coefficients"].astype(np.float64)  # (turbidity, albedo, elevation, 3, 9)
    turbidity, albedo = np.clip(turbidity, 1.0, 10.0), np.clip(albedo, 0.0, 1.0)
    first = 2 * min(int(turbidity) - 1, 8)
    table = np.tensordot(_lagrange(TURBIDITIES[first : first + 3], turbidity), table[first : first + 3], 1)
    table = np.tensordot(_lagrange(np.array(ALBEDOS), albedo), table, 1)
    x = (np.clip(elevation, 0.0, np.pi / 2) / (np.pi / 2)) ** (1.0 / 3.0)
    return np.tensordot(_lagrange(ELEVATION_NODES, x), table, 1)


def terms(shape: np.ndarray, cosine: np.ndarray, to_sun: np.ndarray) -> np.ndarray:
    """(n, 5) what C, D, F, G and I multiply. shape: A, B, E, H; cosine to the zenith and angle to the sun (n,)."""
    a, b, e, h = shape
    toward = np.cos(to_sun)
    chi = (1.0 + toward**2) / (1.0 + h * h - 2.0 * h * toward) ** 1.5
    parts = np.stack([np.ones_like(toward), np.exp(e * to_sun), toward**2, chi, np.sqrt(cosine)], axis=1)
    return (1.0 + a * np.exp(b / (cosine + 0.01)))[:, None] * parts


def radiance(sky: Sky, directions: np.ndarray, space: WorkingSpace = REC709) -> np.ndarray:
    """(n, 3) float32 radiance in a working space in unit directions (n, 3)."""
    directions = np.asarray(directions, np.float64)
    sun = sky.direction_to_sun()
    if sun[2] < 0.0:  # Cycles leaves a sun that has set on the horizon.
        length = np.hypot(sun[0], sun[1])
        sun = np.array([sun[0] / length, sun[1] / length, 0.0]) if length > 0.0 else np.array([0.0, 1.0, 0.0])
    cosine = np.maximum(directions[:, 2], LOWEST_COSINE)
    to_sun = np.arccos(np.clip(directions @ sun, -1.0, 1.0))
    elevation = np.arcsin(np.clip(sun[2], -1.0, 1.0))
    rows = coefficients(elevation, sky.turbidity, sky.ground_albedo)
    xyz = np.stack([terms(row[:4], cosine, to_sun) @ row[4:] for row in rows], axis=1)
    return np.maximum(space.from_rec709(xyz @ XYZ_TO_REC709.T), 0.0).astype(np.float32)

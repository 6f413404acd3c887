# SPDX-License-Identifier: GPL-3.0-or-later
"""The analytic daylight of Preetham, Shirley and Smits 1999, scaled as Cycles scales it."""

import numpy as np

from ...scene.common.working_space import REC709, WorkingSpace
from ...scene.sky import Sky
from ..colorimetry import XYZ_TO_REC709

SCALE = 0.06
"""Cycles' radiance for one kcd/m^2."""
LOWEST_COSINE = np.cos(np.pi / 2 - 1e-3)
"""Below it the horizon's values go on."""

# Linear in turbidity: slope and value at 0 of Perez' A to E, for Y, x, y (the paper's appendix A.2).
_PEREZ = np.array(
    [
        [(0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)],
        [(-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)],
        [(-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)],
    ]
)
# Zenith chromaticity: rows T^2, T, 1; columns theta^3, theta^2, theta, 1.
_ZENITH = np.array(
    [
        [
            (0.00166, -0.00375, 0.00209, 0.0),
            (-0.02903, 0.06377, -0.03202, 0.00394),
            (0.11693, -0.21196, 0.06052, 0.25886),
        ],
        [
            (0.00275, -0.00610, 0.00317, 0.0),
            (-0.04214, 0.08970, -0.04153, 0.00516),
            (0.15346, -0.26756, 0.06670, 0.26688),
        ],
    ]
)


def radiance(sky: Sky, directions: np.ndarray, space: WorkingSpace = REC709) -> np.ndarray:
    """(n, 3) float32 radiance in a working space in unit directions (n, 3)."""
    directions = np.asarray(directions, np.float64)
    sun = sky.direction_to_sun()
    sun_angle = np.arccos(np.clip(sun[2], -1.0, 1.0))
    turbidity = sky.turbidity
    powers = np.array([sun_angle**3, sun_angle**2, sun_angle, 1.0])
    chromaticity = np.array([turbidity**2, turbidity, 1.0]) @ _ZENITH @ powers
    chi = (4.0 / 9.0 - turbidity / 120.0) * (np.pi - 2.0 * sun_angle)
    luminance = (4.0453 * turbidity - 4.9710) * np.tan(chi) - 0.2155 * turbidity + 2.4192
    zenith = np.array([SCALE * luminance, *chromaticity])
    cosine = np.maximum(directions[:, 2], LOWEST_COSINE)
    to_sun = np.arccos(np.clip(directions @ sun, -1.0, 1.0))
    values = zenith * _perez(turbidity, cosine, to_sun) / _perez(turbidity, np.ones(1), np.array([sun_angle]))
    big_y, x, y = values.T
    xyz = np.stack([x / y * big_y, big_y, (1.0 - x - y) / y * big_y], axis=1)
    return np.maximum(space.from_rec709(xyz @ XYZ_TO_REC709.T), 0.0).astype(np.float32)


def _perez(turbidity: float, cosine: np.ndarray, to_sun: np.ndarray) -> np.ndarray:
    """(n, 3) relative luminance and chromaticity (Perez et al. 1993)."""
    a, b, c, d, e = (_PEREZ @ [turbidity, 1.0]).T  # each (3,)
    cosine, to_sun = cosine[:, None], to_sun[:, None]
    return (1.0 + a * np.exp(b / cosine)) * (1.0 + c * np.exp(d * to_sun) + e * np.cos(to_sun) ** 2)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Energy loss of rough glass by single scattering, in closed form for shaders of fibers, which have no tables at hand.

The fit is made to the tables glass_entering and glass_leaving of albedo_tables.py, between indices of 1.25 and 2.25:
1 - albedo is fitted by roughness^2 times a polynomial in roughness (to the 4th degree), 1 - cosine (to the 5th), and z.
The root mean square error of albedos is 0.4 % entering and 1 % leaving, for roughness up to 0.85 and cosines from 0.05
on.
"""

import numpy as np

from ..gl.buffers.constants import Constants
from .albedo_tables import SIZE

ROUGHNESS_DEGREE, COSINE_DEGREE = 4, 5
_ROUGHEST, _MIN_COSINE, _INDICES = 0.85, 0.05, (0.33, 0.62)
HAIR_ENERGY = [
    0.003, 1.033, 0.947, -6.358, -5.983, 1.234, 0.353, 16.441, 14.703, -17.438, -6.621, 5.04,
    -0.071, -7.649, 0.598, 41.824, 19.871, -24.104, -30.254, -14.494, -2.781, 10.2, 0.0, 0.0,
    -0.226, 20.139, -11.17, -90.389, 4.46, 38.991, 24.545, 0.953, 0.0, 0.0, 0.0, 0.0,
    0.652, -20.442, 11.912, 81.084, -20.016, -17.12, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    -0.575, 7.485, -0.448, -26.646, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    # Leaving:
    1.326, 0.738, -10.579, 2.441, 17.604, -34.657, -21.096, 70.388, 13.925, -28.111, 4.369, -13.914,
    -9.055, -7.61, 51.236, 29.108, -24.416, -4.325, 1.434, -84.946, -33.339, 79.879, 0.0, 0.0,
    22.195, 24.479, -88.649, -98.634, 34.324, 74.651, 51.653, -55.199, 0.0, 0.0, 0.0, 0.0,
    -23.958, -22.202, 60.388, 102.797, -48.984, 2.437, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    9.496, 5.843, -6.684, -45.22, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
]  # fmt: skip
"""coefficients() of both tables, entering first, a line a power of roughness: else they would be fitted anew whenever
Blender starts."""


def coefficients(table: np.ndarray) -> np.ndarray:
    """(5, 6, 2) by the power of roughness, of 1 - cosine, and of z, of a table (SIZE, SIZE, SIZE)."""
    at = np.linspace(0.0, 1.0, SIZE)
    z, roughness, cosine = np.meshgrid(at, at, at, indexing="ij")
    used = (roughness <= _ROUGHEST) & (cosine >= _MIN_COSINE) & (z > _INDICES[0]) & (z < _INDICES[1])
    z, roughness, cosine, loss = z[used], roughness[used], cosine[used], 1.0 - table[used].astype(float)
    powers = [(i, j, k) for i in range(ROUGHNESS_DEGREE + 1) for j in range(COSINE_DEGREE + 1 - i) for k in range(2)]
    terms = np.stack([roughness ** (2 + i) * (1.0 - cosine) ** j * z**k for i, j, k in powers], axis=-1)
    found = np.zeros((ROUGHNESS_DEGREE + 1, COSINE_DEGREE + 1, 2))
    for power, value in zip(powers, np.linalg.lstsq(terms, loss, rcond=None)[0], strict=True):
        found[power] = value
    return found.round(3)


Constants("HairEnergy", HAIR_ENERGY=HAIR_ENERGY)

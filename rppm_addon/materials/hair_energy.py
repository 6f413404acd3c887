# SPDX-License-Identifier: GPL-3.0-or-later
"""What rough glass loses by single scattering, in closed form for shaders of fibers, which have no tables at hand.

Of the tables of albedo_tables.py, glass_entering and glass_leaving, 1 - albedo is fitted by roughness^2 times a
polynomial in roughness (to the 4th degree), 1 - cosine (to the 5th), and z, between indices of 1.25 and 2.25: of
albedos of roughness up to 0.85 and cosines from 0.05 on, the error is 0.4 % entering and 1 % leaving (root of the mean
square).
"""

import numpy as np

from ..gl.constants import Constants
from .albedo_tables import SIZE, load_lobes

ROUGHNESS_DEGREE, COSINE_DEGREE = 4, 5
_ROUGHEST, _LEAST_COSINE, _INDICES = 0.85, 0.05, (0.33, 0.62)


def coefficients(table: np.ndarray) -> np.ndarray:
    """(5, 6, 2) by the power of roughness, of 1 - cosine, and of z, of a table (SIZE, SIZE, SIZE)."""
    at = np.linspace(0.0, 1.0, SIZE)
    z, roughness, cosine = np.meshgrid(at, at, at, indexing="ij")
    used = (roughness <= _ROUGHEST) & (cosine >= _LEAST_COSINE) & (z > _INDICES[0]) & (z < _INDICES[1])
    z, roughness, cosine, loss = z[used], roughness[used], cosine[used], 1.0 - table[used].astype(float)
    powers = [(i, j, k) for i in range(ROUGHNESS_DEGREE + 1) for j in range(COSINE_DEGREE + 1 - i) for k in range(2)]
    terms = np.stack([roughness ** (2 + i) * (1.0 - cosine) ** j * z**k for i, j, k in powers], axis=-1)
    found = np.zeros((ROUGHNESS_DEGREE + 1, COSINE_DEGREE + 1, 2))
    for power, value in zip(powers, np.linalg.lstsq(terms, loss, rcond=None)[0], strict=True):
        found[power] = value
    return found.round(3)  # alike on all machines


def _both() -> list[float]:
    known = load_lobes()
    return [float(v) for name in ("glass_entering", "glass_leaving") for v in coefficients(known[name]).ravel()]


Constants("HairEnergy", HAIR_ENERGY=_both())

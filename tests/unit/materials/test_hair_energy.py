# SPDX-License-Identifier: GPL-3.0-or-later
"""The fit of what rough glass loses is that of the tables of albedos."""

import numpy as np

from rppm_addon.materials.albedo_tables import load_lobes
from rppm_addon.materials.hair_energy import HAIR_ENERGY, coefficients


def test_coefficients_are_those_of_the_tables():
    tables = load_lobes()
    fitted = np.concatenate([coefficients(tables[name]).ravel() for name in ("glass_entering", "glass_leaving")])
    np.testing.assert_allclose(HAIR_ENERGY, fitted, atol=1.5e-3)  # both are rounded to thousandths

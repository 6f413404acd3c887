# SPDX-License-Identifier: GPL-3.0-or-later
"""From spectra to linear Rec.709."""

import numpy as np

WAVELENGTHS = np.arange(380.0, 781.0, 20.0) * 1e-9
"""(21,) meters."""

COLOR_MATCHING = 1e-6 * np.array(
    [
        (1368, 39, 6450),
        (14310, 396, 67850),
        (134380, 4000, 645600),
        (348280, 23000, 1747060),
        (290800, 60000, 1669200),
        (95640, 139020, 812950),
        (4900, 323000, 272000),
        (63270, 710000, 78250),
        (290400, 954000, 20300),
        (594500, 995000, 3900),
        (916300, 870000, 1650),
        (1062200, 631000, 800),
        (854450, 381000, 190),
        (447900, 175000, 20),
        (164900, 61000, 0),
        (46770, 17000, 0),
        (11359, 4102, 0),
        (2899, 1047, 0),
        (690, 249, 0),
        (166, 60, 0),
        (42, 15, 0),
    ]
)
"""(21, 3) the CIE 1931 observer (2 degrees) at WAVELENGTHS."""

XYZ_TO_REC709 = np.array(
    [
        (3.2409699, -1.5373832, -0.4986108),
        (-0.9692436, 1.8759675, 0.0415551),
        (0.0556301, -0.2039770, 1.0569715),
    ]
)
"""(3, 3) for white D65 at (0.3127, 0.3290)."""

PLANCK = 6.62607015e-34
LIGHT_SPEED = 299792458.0
BOLTZMANN = 1.380649e-23


def black_body(wavelength: np.ndarray, temperature: float) -> np.ndarray:
    """Radiance of a black body in W/(m^2 sr) per meter of wavelength (meters), at a temperature in kelvin."""
    energy = PLANCK * LIGHT_SPEED / (wavelength * BOLTZMANN * temperature)
    return 2.0 * PLANCK * LIGHT_SPEED**2 / (wavelength**5 * np.expm1(energy))

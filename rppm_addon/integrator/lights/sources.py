# SPDX-License-Identifier: GPL-3.0-or-later
"""Light sources: their names in statistics, and their fractions of the photons."""

import numpy as np

SURFACES = "Emissive surfaces"
VOLUMES = "Emissive volumes"
ENVIRONMENT = "World"


def source_name(light: str) -> str:
    """Return the source name of a light object, which is never that of the surfaces, the volumes or the world."""
    return f'Light "{light}"'


_REGARDLESS_OF_POWER = 0.125
"""Fraction of the photons that is distributed among sources however little power they have. Beside a world of a
thousand meters around, or a sun, lamps in a room would have no photon, though all that the others send misses the
room."""


def photon_fractions(powers: np.ndarray, contributions: np.ndarray) -> np.ndarray:
    """Return the fractions of the photons, (n,) summing to 1, or zeros where no source is to have any.

    ``powers`` in W; ``contributions``: what a photon of each source is worth, by the user's weight and by what earlier
    ones contributed, in any unit.
    """
    by_power = powers * contributions
    if not by_power.sum() > 0.0:
        return np.zeros(len(powers))
    by_power, regardless = by_power / by_power.sum(), contributions / contributions.sum()
    return (1.0 - _REGARDLESS_OF_POWER) * by_power + _REGARDLESS_OF_POWER * regardless

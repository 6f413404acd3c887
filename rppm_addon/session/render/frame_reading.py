# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures and passes, read from a film on the device."""

from collections.abc import Mapping

import numpy as np

from ...integrator.film.film import Film, exposed
from .frame_passes import frame_passes
from .results import Frame


def read_combined(film: Film, exposure: float) -> np.ndarray:
    """Return the film's picture, as Frame.combined. Waits for the device."""
    return exposed(film.read_radiance(), exposure)


def read_frame(film: Film, exposure: float, inspections: Mapping[str, np.ndarray] | None = None) -> Frame:
    """Return the film's picture and passes. Waits for the device.

    inspections: passes that are computed once and that the film does not keep, by name.
    """
    passes = frame_passes(film.read_passes(), film.rendered_passes, exposure)
    return Frame(read_combined(film, exposure), {**passes, **(inspections or {})})

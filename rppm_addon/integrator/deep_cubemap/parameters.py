# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of the builds of deep cubemaps."""

import numpy as np

from ..acceleration.acceleration_structure import MARGIN
from .records import BOX_TRIANGLES, STATE

MIN_GAIN = 32
"""Items that a cell has fewer, at least, where it is divided."""
MAX_BINS = 64
"""Largest number of depth bins of a cell."""
CORE_MARGINS = 64.0
"""Radius of the core, in margins: nearer to the center, rays test a list."""
_BASE_LEVEL = 2


def cubemap_parameters(center: np.ndarray, radius: float, exponent: int, count: int) -> np.void:
    """Return the STATE that a build begins with.

    center: (3,) meters; radius: the greatest distance from there of any item, meters; exponent: log2 of the cells along
    a face's side, 2 or more; count: items to be sorted.
    """
    radius = max(float(radius), 1e-20)
    state = STATE.zeros(1)[0]
    state["center"] = center
    state["margin"] = radius * MARGIN
    state["core_radius"] = radius * MARGIN * CORE_MARGINS
    state["scene_radius"] = radius
    state["root_exponent"] = exponent % 2
    state["root_count"] = 6 << (2 * state["root_exponent"])
    state["last_level"] = exponent // 2
    state["base_level"] = min(_BASE_LEVEL, exponent // 2)
    state["min_gain"], state["max_bins"] = MIN_GAIN, MAX_BINS
    state["triangle_count"] = count
    state["box_triangles"] = BOX_TRIANGLES
    return state

# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that begin where another ended, or late in the sequence of iterations, and leave what it takes to go on."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..integrator.state import RenderState


@dataclass
class Pause:
    """A render between two iterations."""

    state: RenderState
    device: str
    """Its label: another one, or another driver, computes the same picture, but not bit for bit."""
    radius_meters: float
    """r_max of the last iteration."""
    inspections: dict[str, np.ndarray] = field(default_factory=dict)
    """Passes that are computed once, as Frame.passes has them."""


@dataclass
class Continuation:
    """Where a render begins in the sequence of iterations, and who keeps it."""

    left_out: int = 0
    """The film begins after so many iterations."""
    begin: Pause | None = None
    """Go on from here instead of from the beginning; its scene and settings are this render's."""
    keep: Callable[[Pause], None] | None = None
    """Told, in the thread of the renderer, how to go on: now and then, and when the render ends."""
    interval: float = math.inf
    """Seconds from one such pause to the next."""

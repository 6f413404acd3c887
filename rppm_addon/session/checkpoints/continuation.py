# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that begin where another ended, or late in the sequence of iterations, and leave what it takes to go on."""

import dataclasses
import logging
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...integrator.state import RenderState
from ...scene.errors import DeviceLostError
from ...scene.scene import Scene

log = logging.getLogger(__name__)


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

    sample_offset: int = 0
    """The film begins after so many iterations."""
    begin: Pause | None = None
    """Go on from here instead of from the beginning; its scene and settings are this render's."""
    keep: Callable[[Pause], None] | None = None
    """Told, in the thread of the renderer, how to go on: now and then, and when the render ends."""
    interval: float = math.inf
    """Seconds from one such pause to the next."""
    safeguard: Callable[[Pause, float], None] | None = None
    """Told likewise, and the seconds so far, as often as that costs little: where to begin again once the device or the
    process is lost."""
    seconds: float = 0.0
    """Seconds that a render which begins again has taken before. Its time limit and snapshots count them."""
    snapshots_taken: int = 0
    """Number of snapshots that were handed out before."""


class DeviceLossRecovery:
    """A render that goes on in another context where the device is lost."""

    def __init__(self, continuation: Continuation | None) -> None:
        """continuation: where the render begins."""
        self.losses = 0
        """Number of times that the device was lost so far."""
        self.continuation = dataclasses.replace(continuation or Continuation(), safeguard=self._safeguard)
        """Where it begins, or begins again."""
        self._start = time.perf_counter()

    def _safeguard(self, pause: Pause, seconds: float) -> None:
        self.continuation.begin = pause

    def lose(self, scene: Scene, error: DeviceLostError) -> None:
        """The device is lost: begin again, which the scene warns of."""
        self.losses += 1
        begin = self.continuation.begin
        self.continuation.seconds = time.perf_counter() - self._start
        text = f"{error}; the render went on {place_of(begin)} in a new context"
        log.warning("%s", text)
        scene.warn(text)


def place_of(begin: Pause | None) -> str:
    """Where a render goes on, in words."""
    return f"after sample {begin.state.iterations_in_film}" if begin is not None else "from its beginning"

# SPDX-License-Identifier: GPL-3.0-or-later
"""State from which renders continue, and renders that begin late in the sequence of iterations."""

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

MOST_LOSSES = 3
"""Number of times that one render may lose the device. After more, another context would not help either."""


@dataclass
class Pause:
    """A render between two iterations."""

    state: RenderState
    device: str
    """Label of the device. Another device or driver computes the same picture, but not bit for bit."""
    radius_meters: float
    """r_max of the last iteration."""
    inspections: dict[str, np.ndarray] = field(default_factory=dict)
    """Passes that are computed once, as Frame.passes has them."""


@dataclass
class Continuation:
    """Place in the sequence of iterations where a render begins, and the receivers of its state."""

    sample_offset: int = 0
    """Number of iterations before the first one in the film."""
    begin: Pause | None = None
    """State from which the render continues, of the same scene and settings; None is the beginning."""
    keep: Callable[[Pause], None] | None = None
    """Receives the state every ``interval`` seconds and when the render ends, in the renderer's thread."""
    interval: float = math.inf
    """Seconds between two calls of ``keep``."""
    safeguard: Callable[[Pause, float], None] | None = None
    """Receives the state and the seconds so far, as often as that costs little: the render begins there again if the
    device or the process is lost."""
    seconds: float = 0.0
    """Seconds that a continued render has taken before. Its time limit and snapshots count them."""
    snapshots_taken: int = 0
    """Number of snapshots that were handed out."""


class DeviceLossRecovery:
    """Lets a render continue in another context when the device is lost."""

    def __init__(self, continuation: Continuation | None) -> None:
        """continuation: where the render begins."""
        self._losses = 0
        """Number of times that the device was lost."""
        self.continuation = dataclasses.replace(continuation or Continuation(), safeguard=self._safeguard)
        """State from which the render begins, or begins again."""
        self._start = time.perf_counter()

    def _safeguard(self, pause: Pause, seconds: float) -> None:
        self.continuation.begin = pause

    def recover(self, scene: Scene, error: DeviceLostError) -> None:
        """Begin again after the last safeguard, and warn about it. Raises the error after MOST_LOSSES."""
        if self._losses == MOST_LOSSES:
            raise error
        self._losses += 1
        begin = self.continuation.begin
        self.continuation.seconds = time.perf_counter() - self._start
        text = f"{error}; the render went on {place_of(begin)} in a new context"
        log.warning("%s", text)
        scene.warn(text)


def place_of(begin: Pause | None) -> str:
    """Return in words where a render continues."""
    return f"after sample {begin.state.iterations_in_film}" if begin is not None else "from its beginning"

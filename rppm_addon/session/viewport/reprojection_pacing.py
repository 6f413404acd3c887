# SPDX-License-Identifier: GPL-3.0-or-later
"""How often a viewport's last picture is reprojected into a moving view, and at which resolution."""

import math
import time

from ...scene.scene import Scene
from ..placeholders.resolution_scaler import ResolutionScaler, at_level

INTERVAL_SECONDS = 1.0 / 12.0
"""Least time between two reprojections."""
REST_FACTOR = 2.0
"""Least ratio of the time between two reprojections to the time for one, which takes a third of all time at most."""
TARGET_SECONDS = 1.0 / 30.0
"""Time for one reprojection, which has fewer pixels where it would take more."""


class ReprojectionPacing:
    """Leaves the device time for rendering between reprojections."""

    def __init__(self) -> None:
        self._ended_at = 0.0
        self._seconds = 0.0
        """Duration of the last reprojection."""
        self._scaler = ResolutionScaler(seconds_per_pixel=1e-9)

    @property
    def is_due(self) -> bool:
        """Whether enough time has passed since the last reprojection."""
        interval = max(INTERVAL_SECONDS, REST_FACTOR * self._seconds)
        return time.perf_counter() - self._ended_at >= interval

    def scaled(self, scene: Scene) -> Scene:
        """Return the scene with as many pixels as TARGET_SECONDS allow."""
        return at_level(scene, self._scaler.first(math.prod(scene.camera.resolution), TARGET_SECONDS))

    def add(self, began: float, pixels: int) -> None:
        """Record a reprojection that has ended.

        Args:
            began: time.perf_counter() at its begin.
            pixels: number of its pixels; 0 if the view could not be reprojected.
        """
        self._ended_at = time.perf_counter()
        self._seconds = self._ended_at - began
        if pixels:
            self._scaler.measure(pixels, self._seconds)

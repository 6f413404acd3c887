# SPDX-License-Identifier: GPL-3.0-or-later
"""The schedule of a viewport: the scene that is rendered next, its resolutions, and when a picture is presented."""

import time
from dataclasses import dataclass

from ...scene.scene import Scene
from ..placeholders.resolution_scaler import ResolutionScaler

NAVIGATION_SECONDS = 1.0 / 15.0
"""Time for the first picture while the view or the scene keeps changing."""
FIRST_SECONDS = 0.15
"""Time for the first picture after a single change."""
REST_SECONDS = 0.25
"""Time without a change after which the view is at rest and the resolution rises."""
FRAME_SECONDS = 1.0 / 60.0
"""Least time between two pictures. Nobody would see more of them, and reading them from the device costs time."""
MOST_PICTURE_TIME = 0.5
"""Largest fraction of all time that making pictures of a film may take from the iterations, while each shows much that
the one before did not."""
LATER_PICTURE_TIME = 0.1
"""Largest fraction once pictures show little that is new."""
NEW_PICTURE_TIME = 0.1
"""Fraction by which the rendering time grows from a picture to the next one, where LATER_PICTURE_TIME allows that: the
standard error of a film falls by 5 % then."""


@dataclass(frozen=True)
class ViewRequest:
    """Request of Blender for pictures of a scene."""

    scene: Scene
    generation: int
    """Number that grows with each scene of a viewport."""
    navigating: bool
    """Whether the view or the scene keeps changing, so that speed counts more than resolution."""


class ViewportScheduler:
    """Decides which scene a viewport renders, at which resolutions, and when a picture is due."""

    def __init__(self) -> None:
        self.pending: ViewRequest | None = None
        """The newest request, until its rendering begins."""
        self._requested_at = 0.0
        self.is_paused = False
        """Whether the picture is not to be improved."""
        self.first_picture_pending = False
        """Whether the scene that is rendered has no picture yet."""
        self._picture_began_at = 0.0
        self._next_picture_at = 0.0
        self._scaler = ResolutionScaler()

    def request(self, request: ViewRequest) -> None:
        """Have a scene rendered next, in place of any other that waits."""
        self.pending = request
        self._requested_at = time.perf_counter()

    def take(self) -> ViewRequest | None:
        """Return the request that waits, and begin with it.

        None if there is none, or if the scene that is rendered has no picture yet. A scene that changes faster than it
        is rendered would never be seen otherwise.
        """
        if self.pending is None or self.first_picture_pending:
            return None
        request, self.pending = self.pending, None
        self.first_picture_pending = True
        return request

    def cancel(self) -> None:
        """End the scene that is rendered, with or without a picture."""
        self.first_picture_pending = False

    def resolution_levels(self, request: ViewRequest) -> list[float]:
        """Ascending fractions of the full side length at which a scene is rendered; the last is 1."""
        width, height = request.scene.camera.resolution
        return self._scaler.levels(width * height, NAVIGATION_SECONDS if request.navigating else FIRST_SECONDS)

    def is_picture_due(self, iteration: int, iterations_per_frame: int) -> bool:
        """Whether to present a picture after an iteration that is not the last.

        The iterations 1, 2, 4, 8 and so on have one whatever it costs, as it has half the variance of the one before.
        """
        count, rest = divmod(iteration, iterations_per_frame)
        if rest:
            return False
        now = time.perf_counter()
        has_doubled = count.bit_count() == 1 and now >= self._picture_began_at + FRAME_SECONDS
        return self.first_picture_pending or has_doubled or now >= self._next_picture_at

    def add_picture(self, began: float, pixels: int, rendering_seconds: float) -> None:
        """Plan the next picture after one was presented.

        Args:
            began: time.perf_counter() before the picture was made.
            pixels: number of rendered pixels.
            rendering_seconds: time from the begin of the series to the begin of the picture.
        """
        took = time.perf_counter() - began
        until_new = min(took / LATER_PICTURE_TIME, NEW_PICTURE_TIME * rendering_seconds)
        self._picture_began_at = began
        self._next_picture_at = began + max(FRAME_SECONDS, took / MOST_PICTURE_TIME, until_new)
        if self.first_picture_pending:
            self._scaler.measure(pixels, rendering_seconds)
            self.first_picture_pending = False

    def is_higher_level_due(self, level: float, navigating: bool) -> bool:
        """Whether to leave a resolution level for the next one: the view is at rest and has a picture."""
        at_rest = not navigating or time.perf_counter() - self._requested_at >= REST_SECONDS
        return level < 1.0 and at_rest and not self.first_picture_pending

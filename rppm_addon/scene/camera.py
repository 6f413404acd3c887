# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera, resolved to a window in front of it."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Camera:
    """A camera that looks along its local -Z axis, Y up.

    Sensor fit, shift and pixel aspect are already in the window.
    """

    matrix: np.ndarray
    """(4, 4) float64, camera to world, a rigid motion (scale removed)."""
    window: tuple[float, float, float, float]
    """left, right, bottom, top of the whole frame: tangents (perspective, at distance 1) or
    metres (orthographic)."""
    width: int
    """Pixels of the whole frame."""
    height: int
    orthographic: bool = False
    clip_start: float = 0.1
    clip_end: float = 1000.0
    crop: tuple[int, int, int, int] | None = None
    """x_min, y_min, x_max, y_max in pixels, row 0 at the bottom; None is the whole frame."""

    @property
    def region(self) -> tuple[int, int, int, int]:
        """The pixels that are rendered: x_min, y_min, x_max, y_max."""
        return self.crop if self.crop is not None else (0, 0, self.width, self.height)

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height of the rendered region in pixels."""
        x_min, y_min, x_max, y_max = self.region
        return x_max - x_min, y_max - y_min

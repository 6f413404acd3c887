# SPDX-License-Identifier: GPL-3.0-or-later
"""A look at the camera's view with fewer pixels than it has, which tells the radii of a render before it begins."""

import math
from collections.abc import Iterator

import numpy as np

from ..scene.camera import Camera
from .camera_view import camera_view

MOST_PIXELS = 1 << 14
"""Of a look: the percentiles of so many footprints are those of all within a percent."""
FEWEST_HITS = 1 << 8
"""With less, what is seen is small in the picture, and all pixels have to look for it."""


def overview_sizes(width: int, height: int) -> list[tuple[int, int]]:
    """Columns and rows of the looks at a view of width x height pixels: a coarse one, if less, and a full one."""
    full = width, height
    if width * height <= MOST_PIXELS:
        return [full]
    rows = min(max(1, int(height * math.sqrt(MOST_PIXELS / (width * height)))), MOST_PIXELS)
    return [(min(width, MOST_PIXELS // rows), rows), full]


def overviews(camera: Camera, columns: int, rows: int, band_rows: int) -> Iterator[np.ndarray]:
    """CAMERA_VIEW records of a look at all of the camera's region, in bands of ``band_rows`` or less from below.

    A footprint stays that of one of the camera's own pixels. Raises as camera_view does.
    """
    whole = camera_view(camera, 0, camera.resolution[1], (0.0, 0.0))
    bottom, top = whole["window"][0, 2:]
    for first in range(0, rows, band_rows):
        last = min(first + band_rows, rows)
        view = whole.copy()
        view["width"], view["height"] = columns, last - first
        view["window"][0, 2:] = bottom + (top - bottom) * np.array([first, last]) / rows
        yield view


def at_pixels(look: np.ndarray, width: int, height: int) -> np.ndarray:
    """(height * width,): for each of the view's pixels what a look (rows, columns) has there."""
    rows, columns = look.shape
    nearest_row = (np.arange(height) * 2 + 1) * rows // (2 * height)
    nearest_column = (np.arange(width) * 2 + 1) * columns // (2 * width)
    return look[nearest_row[:, None], nearest_column].reshape(-1)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The pilot view: the camera's with fewer pixels than it has. What a render has to know before it begins."""

import math
from collections.abc import Iterator

import numpy as np

from ..scene.camera import Camera
from .common.band import Band
from .common.camera_view import camera_view
from .common.iteration import Iteration
from .density_estimation.radii import Radii, radius_in_pixels
from .device_scene.stage_context import StageContext
from .stage_set import StageSet

MOST_PIXELS = 1 << 14
"""Largest number of pixels of the first pilot view. Percentiles of so many footprints are right within a percent."""
FEWEST_HITS = 1 << 8
"""Smallest number of hits of the first pilot view. With fewer hits, a second one has all pixels of the picture."""


def pilot_sizes(width: int, height: int) -> list[tuple[int, int]]:
    """Columns and rows of the pilot views of a view of width x height pixels: a coarse one, if less, and a full one."""
    full = width, height
    if width * height <= MOST_PIXELS:
        return [full]
    rows = min(max(1, int(height * math.sqrt(MOST_PIXELS / (width * height)))), MOST_PIXELS)
    return [(min(width, MOST_PIXELS // rows), rows), full]


def pilot_views(camera: Camera, columns: int, rows: int, band_rows: int) -> Iterator[np.ndarray]:
    """CAMERA_VIEW records of a pilot view of all of the camera's region, in bands of ``band_rows`` or less from below.

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


def enlarged(picture: np.ndarray, width: int, height: int) -> np.ndarray:
    """Array (height, width, ...) of the pixels of a picture (rows, columns, ...) that are nearest to each pixel."""
    rows, columns = picture.shape[:2]
    nearest_row = (np.arange(height) * 2 + 1) * rows // (2 * height)
    nearest_column = (np.arange(width) * 2 + 1) * columns // (2 * width)
    return picture[nearest_row[:, None], nearest_column]


def at_pixels(pilot: np.ndarray, width: int, height: int) -> np.ndarray:
    """(height * width,): for each of the view's pixels what a pilot view (rows, columns) has there."""
    return enlarged(pilot, width, height).reshape(-1)


def pilot_footprints(context: StageContext, stages: StageSet) -> np.ndarray:
    """Return the Eq. 3 radii of the pilot view's first hits, (rows, columns), meters; 0 where there is no importon."""
    camera, settings = context.scene.camera, context.settings
    importons, iteration = stages.importons, Iteration(0, settings.seed)
    context.begin(iteration)
    unlimited = Radii(0.0, 1e30, 0.0, radius_in_pixels(settings, camera), 1.0, 1.0)
    context.iteration_block.write_radii(unlimited)
    for columns, rows in pilot_sizes(*camera.resolution):
        footprints = []
        for view in pilot_views(camera, columns, rows, stages.bands[0].rows):
            band = Band(columns, 0, int(view["height"][0]))
            context = context.with_blocks(stages.blocks_of(band))
            stages.camera_hits.find(context, importons, view, band)
            importons.resolve(context, iteration, 0)
            stages.subsurface.walk_camera_paths(context, importons, band, 0)
            importons.scatter(context, band, 0)
            footprints.append(importons.footprints(band.pixel_count))
        pilot = np.concatenate(footprints).reshape(rows, columns)
        if np.count_nonzero(pilot) >= FEWEST_HITS:
            break
    return pilot

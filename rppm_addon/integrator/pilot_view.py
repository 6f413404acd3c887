# SPDX-License-Identifier: GPL-3.0-or-later
"""The pilot view: the camera's with fewer pixels than it has. What a render has to know before it begins."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..scene.camera import Camera
from .camera_paths.final_gather import FINAL_GATHER_ORIGIN, NO_FINAL_GATHER
from .common.band import Band
from .common.camera_view import camera_view
from .common.iteration import Iteration
from .common.records.rays import HIT, NO_TRIANGLE, RAY
from .density_estimation.radii import Radii, radius_in_pixels
from .device_scene.stage_context import StageContext
from .lights.portals import passes_portal
from .stage_set import StageSet

MOST_PIXELS = 1 << 14
"""Largest number of pixels of the first pilot view. Percentiles of so many footprints are right within a percent."""
FEWEST_HITS = 1 << 8
"""Smallest number of hits of the first pilot view. With fewer hits, a second one has all pixels of the picture."""
MAX_GATHERING_RAYS = 1 << 11
"""Largest number of gathering rays that are traced to their ends."""


@dataclass(frozen=True)
class PilotView:
    """Findings of a pilot view about the camera's first hits and the gathering rays from there."""

    footprints: np.ndarray
    """(rows, columns) Eq. 3 radii of the camera's first hits, meters; 0 where there is no importon."""
    leaving_fraction: float
    """Fraction of the gathering rays from the first hits that leave the scene; nan where none was followed."""
    uncovered_fraction: float = 1.0
    """Fraction of the gathering rays leaving the scene that pass no portal."""


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


def view_pilot(context: StageContext, stages: StageSet, follows_rays: bool) -> PilotView:
    """Look at the scene; follows_rays: along the gathering rays as well."""
    camera, settings = context.scene.camera, context.settings
    importons, iteration = stages.importons, Iteration(0, settings.seed)
    context.begin(iteration)
    unlimited = Radii(0.0, 1e30, 0.0, radius_in_pixels(settings, camera), 1.0, 1.0)
    context.iteration_block.write_radii(unlimited)
    for columns, rows in pilot_sizes(*camera.resolution):
        footprints, ends = [], []
        for view in pilot_views(camera, columns, rows, stages.bands[0].rows):
            band = Band(columns, 0, int(view["height"][0]))
            context = context.with_blocks(stages.blocks_of(band))
            stages.camera_hits.find(context, importons, view, band)
            importons.resolve(context, iteration, 0)
            stages.subsurface.walk_camera_paths(context, importons, band, 0)
            importons.scatter(context, band, 0)
            footprints.append(importons.footprints(band.pixel_count))
            if follows_rays:
                stride = -(-columns * rows // MAX_GATHERING_RAYS)
                ends.append(_ends_of_gathering_rays(context, stages, band.pixel_count, stride))
        pilot = np.concatenate(footprints).reshape(rows, columns)
        if np.count_nonzero(pilot) >= FEWEST_HITS:
            break
    followed = np.concatenate(ends) if ends else np.zeros((0, 2), bool)
    leaves, uncovered = followed.T
    if not len(followed):
        return PilotView(pilot, math.nan)
    return PilotView(pilot, float(leaves.mean()), float(uncovered.sum() / max(leaves.sum(), 1)))


def _ends_of_gathering_rays(context: StageContext, stages: StageSet, pixels: int, stride: int) -> np.ndarray:
    """(n, 2) bool of gathering rays which have just set out, one in ``stride`` of them: whether they leave the scene,
    and whether they do so and pass no portal."""
    importons = stages.importons
    rays = importons.rays.read(RAY.dtype, pixels).copy()
    gathers = stages.final_gather.origins.read(FINAL_GATHER_ORIGIN.dtype, pixels)["reuse_radius"] != NO_FINAL_GATHER
    followed = np.flatnonzero(gathers & (rays["maximum_distance"] > 0.0))[::stride]
    distances = np.zeros(pixels, np.float32)
    distances[followed] = rays["maximum_distance"][followed]
    rays["maximum_distance"] = distances
    importons.rays.write(rays)
    importons.trace(context, 1)
    leaves = importons.hits.read(HIT.dtype, pixels)["triangle"][followed] == NO_TRIANGLE
    starts, directions = (rays[name][followed].astype(np.float64) for name in ("origin", "direction"))
    return np.stack([leaves, leaves & ~passes_portal(context.lights.portals.records, starts, directions)], -1)

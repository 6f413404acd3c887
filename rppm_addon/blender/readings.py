# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures that panels compute from settings and from what renders reported. Without bpy."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..integrator.density_estimation.radii import radius_in_pixels, shrinkage
from ..integrator.lights.sources import photon_fractions
from ..integrator.memory import Memory, expected_memory
from ..scene import Camera, DensityEstimation, Instancing, RenderSettings
from .reports import RenderKind, RenderReport


@dataclass(frozen=True)
class RadiusReading:
    """Radius of a surface that faces the camera, in pixels of the picture."""

    first: float
    last: float
    """After all iterations."""
    shrinkage: float
    """The one over the other, for radii of all kinds."""


def radius_reading(settings: RenderSettings, width: int, height: int) -> RadiusReading:
    """Eq. 3 and Eq. 2 for the settings' iterations and a frame of so many pixels.

    Eq. 3's disk covers the footprints of s_r^2 pixels, so its radius is s_r / sqrt(pi) pixels.
    """
    frame = Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), width, height)
    first = radius_in_pixels(settings, frame) / math.sqrt(math.pi)
    ratio = shrinkage(settings.iterations, settings.alpha)
    return RadiusReading(first, first * ratio, ratio)


@dataclass(frozen=True)
class MemoryReading:
    """Bytes on the device that the next render takes."""

    by_settings: Memory
    scene_bytes: int | None
    """Geometry, textures, deep cubemap and lists, as in a render before; None before the first one."""

    @property
    def total_bytes(self) -> int:
        """Bytes of all parts together."""
        return self.by_settings.total_bytes + (self.scene_bytes or 0)


def memory_reading(settings: RenderSettings, width: int, height: int, report: RenderReport | None) -> MemoryReading:
    """Return the memory to render width x height pixels. report: a former render, which has the scene's own part."""

    def expected(settings: RenderSettings, width: int, height: int, in_viewport: bool = False) -> Memory:
        rasterized = settings.density_estimation is DensityEstimation.RASTERIZED
        photons = settings.photons_for(width, height)
        segments, passes, noise = settings.photon_bounces + 1, settings.rendered_passes, settings.use_adaptive_sampling
        in_levels = settings.instancing is Instancing.TWO_LEVELS
        return expected_memory(width, height, photons, segments, rasterized, passes, noise, in_viewport, in_levels)

    scene_bytes = None
    if report is not None:
        before = expected(report.settings, report.width, report.height, report.kind is RenderKind.VIEWPORT)
        scene_bytes = max(0, report.progress.memory_bytes - before.total_bytes)
    return MemoryReading(expected(settings, width, height), scene_bytes)


def photon_allocation(watts: Mapping[str, float], photon_weights: Mapping[str, float]) -> dict[str, float]:
    """Fractions of the photons by source, summing to 1: by power and the user's weight, 1 where none is named."""
    weights = [max(photon_weights.get(name, 1.0), 0.0) for name in watts]
    return dict(zip(watts, photon_fractions(np.array(list(watts.values())), np.array(weights)).tolist()))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Render settings, in a module for each subject."""

from .acceleration import (
    CUBEMAP_COSTS,
    AccelerationStructure,
    DensityEstimation,
    FirstCameraHits,
    FirstPhotonHits,
    Instancing,
)
from .denoising import DenoisingInputPasses, DenoisingPrefilter, DenoisingQuality
from .film import PixelFilter
from .light_filters import CausticKind
from .light_paths import MOST_COUNTED_BOUNCES, MOST_SEGMENTS, DirectLight
from .photons import MOST_PHOTONS
from .render_settings import RenderSettings

__all__ = [
    "CUBEMAP_COSTS",
    "MOST_COUNTED_BOUNCES",
    "MOST_PHOTONS",
    "MOST_SEGMENTS",
    "AccelerationStructure",
    "CausticKind",
    "DenoisingInputPasses",
    "DenoisingPrefilter",
    "DenoisingQuality",
    "DensityEstimation",
    "DirectLight",
    "FirstCameraHits",
    "FirstPhotonHits",
    "Instancing",
    "PixelFilter",
    "RenderSettings",
]

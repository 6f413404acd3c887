# SPDX-License-Identifier: GPL-3.0-or-later
"""Equal settings for RPPM and Cycles in an open .blend file."""

from dataclasses import dataclass

import bpy

BOUNCES = 12
"""Most bounces of each kind, for both."""
TRANSPARENT_BOUNCES = 64
"""Most transparent surfaces in a row, for both."""
FILTER = ("BLACKMAN_HARRIS", 1.5)
"""Pixel filter of both, and its width in pixels."""


@dataclass(frozen=True)
class Effort:
    """The size of the pictures, and what each of them may cost."""

    resolution: tuple[int, int] | None
    """Width and height in pixels; None is the file's own."""
    samples: int
    """Samples of RPPM's pictures."""
    cycles_samples: int
    seconds: float
    """Longest time of a picture."""


def equalize(scene: bpy.types.Scene, effort: Effort) -> None:
    """Have both renderers trace the same light through the same film, with nothing clamped, filtered or left out."""
    render, cycles, ours = scene.render, scene.cycles, scene.rppm
    if effort.resolution is not None:
        render.resolution_x, render.resolution_y = effort.resolution
        render.resolution_percentage, render.use_border = 100, False
    render.use_compositing = render.use_sequencer = render.use_freestyle = render.use_single_layer = False
    render.use_multiview = False
    cycles.device, cycles.use_auto_tile = "CPU", False
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, f"{kind}_bounces", BOUNCES)
    cycles.transparent_max_bounces = TRANSPARENT_BOUNCES
    cycles.pixel_filter_type, cycles.filter_width = FILTER
    cycles.use_fast_gi = False
    cycles.samples, cycles.time_limit = effort.cycles_samples, effort.seconds
    ours.pixel_filter_type, ours.filter_width = FILTER
    ours.max_bounces = ours.volume_bounces = BOUNCES
    ours.transparent_max_bounces = TRANSPARENT_BOUNCES
    for name in ("max_camera_bounces", "max_photon_bounces"):
        ours.property_unset(name)
    ours.film_exposure = cycles.film_exposure
    ours.use_denoising = ours.use_adaptive_sampling = False
    ours.samples, ours.time_limit = effort.samples, effort.seconds
    used = [layer for layer in scene.view_layers if layer.use] or list(scene.view_layers)
    for layer in scene.view_layers:
        layer.use = layer == used[0]
    image = render.image_settings
    if hasattr(image, "media_type"):  # Blender 5
        image.media_type = "IMAGE"
    image.file_format, image.color_depth, image.color_mode = "OPEN_EXR", "32", "RGBA"
    render.use_file_extension = False

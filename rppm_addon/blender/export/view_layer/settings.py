# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's scene properties to render settings."""

import dataclasses

import bpy
import numpy as np

from ....scene import RenderSettings
from ....scene.meshes import DicingView
from ....scene.passes import COMBINED
from ....scene.settings.setting_info import settings_of
from ...properties import VIEWPORT_APART, viewport_property
from ..camera.camera import export_camera
from .passes import aovs_of_layer, light_groups_of_layer, passes_of_layer


def export_settings(
    scene: bpy.types.Scene,
    layer: bpy.types.ViewLayer | None = None,
    viewport: bool = False,
    shown_pass: str = COMBINED,
) -> RenderSettings:
    """The settings of scene.rppm, or the defaults where the extension is not registered.

    layer: whose passes are rendered; without one there are none.
    viewport: those of a viewport, which has iterations and photons of its own, no time limit, and no pass but the one
    that it shows.
    """
    settings = RenderSettings(film_transparent=scene.render.film_transparent, passes=())
    if viewport:
        settings.passes = () if shown_pass == COMBINED else (shown_pass,)
    elif layer is not None:
        settings.passes = tuple(entry.name for entry in passes_of_layer(layer))
        settings.aovs = aovs_of_layer(layer)
        settings.light_groups = light_groups_of_layer(layer)
    stored = getattr(scene, "rppm", None)
    if stored is not None:
        names = [info.property_of(name) for name, info in settings_of(RenderSettings).items() if not info.where]
        settings = settings.with_properties({name: getattr(stored, name) for name in names})
        if stored.use_animated_seed:
            settings.seed = seed_of_frame(stored.seed, scene.frame_current)
        if viewport:
            settings.iterations, settings.photons = stored.preview_samples, stored.preview_photons
            apart = {name: getattr(stored, viewport_property(name)) for name in VIEWPORT_APART}
            settings = settings.with_values(**apart)
    if not viewport and layer is not None:
        settings.iterations = _samples_of_layer(layer, settings.iterations, getattr(stored, "use_layer_samples", "USE"))
        settings.use_denoising &= is_denoised(layer)
    if viewport:
        settings.time_limit = 0.0
        settings.use_denoising &= shown_pass == COMBINED
    return settings


def _samples_of_layer(layer: bpy.types.ViewLayer, of_scene: int, use: str) -> int:
    """Samples of a view layer beside those of its scene; use: scene.rppm.use_layer_samples."""
    if use == "IGNORE" or layer.samples == 0:
        return of_scene
    return min(layer.samples, of_scene) if use == "BOUNDED" else layer.samples


def is_denoised(layer: bpy.types.ViewLayer) -> bool:
    """Return whether final renders of a view layer are denoised where those of its scene are."""
    return getattr(getattr(layer, "rppm", None), "use_denoising", True)


def seed_of_frame(seed: int, frame: int) -> int:
    """A seed of each frame's own, 0 to 2^31 - 1: seeds and frames that are neighbors have nothing in common.

    The last rounds of MurmurHash3 (Appleby), a permutation of 32 bits, of the frame, then of what that gives and the
    seed.
    """

    def mixed(bits: int) -> int:
        bits = ((bits ^ (bits >> 16)) * 0x85EBCA6B) & 0xFFFFFFFF
        bits = ((bits ^ (bits >> 13)) * 0xC2B2AE35) & 0xFFFFFFFF
        return bits ^ (bits >> 16)

    return mixed((mixed(frame & 0xFFFFFFFF) + seed) & 0xFFFFFFFF) & 0x7FFFFFFF


PREVIEW_ITERATIONS, PREVIEW_PHOTONS, PREVIEW_SECONDS = 64, 8192, 1.0
"""Thumbnails are small and many: what a second gives is good enough."""


def preview_settings(settings: RenderSettings) -> RenderSettings:
    """Return settings for Blender's previews of materials, worlds and lights, whose scenes have nobody's settings."""
    return dataclasses.replace(
        settings, iterations=PREVIEW_ITERATIONS, photons=PREVIEW_PHOTONS, time_limit=PREVIEW_SECONDS
    )


def export_cubemap_center(depsgraph: bpy.types.Depsgraph) -> np.ndarray | None:
    """(3,) meters where the chosen object is in this frame; None where none is chosen."""
    stored = getattr(depsgraph.scene, "rppm", None)
    chosen = None if stored is None else stored.cubemap_center_object
    return None if chosen is None else np.array(chosen.evaluated_get(depsgraph).matrix_world.translation, float)


def export_dicing_view(depsgraph: bpy.types.Depsgraph, viewport: bool) -> DicingView:
    """View by which Adaptive Subdivision divides meshes; Cycles' defaults where it is not enabled. Its camera is the
    Dicing Camera, None where none is chosen. Raises SceneError as export_camera does."""
    scene = depsgraph.scene_eval
    cycles = getattr(scene, "cycles", None)
    if cycles is None:
        return DicingView(8.0 if viewport else 1.0)
    chosen = cycles.dicing_camera
    return DicingView(
        cycles.preview_dicing_rate if viewport else cycles.dicing_rate,
        max(cycles.offscreen_dicing_scale, 1.0),
        cycles.max_subdivisions,
        None if chosen is None else export_camera(scene, depsgraph, chosen),
    )


def export_exposure(scene: bpy.types.Scene) -> float:
    """The film's, a factor; 1 where the extension is not registered."""
    return scene.rppm.film_exposure if hasattr(scene, "rppm") else 1.0

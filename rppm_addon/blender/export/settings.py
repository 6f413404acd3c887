# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's scene properties to render settings."""

import dataclasses

import bpy
import numpy as np

from ...scene import DirectLight, RenderSettings


def export_settings(scene: bpy.types.Scene, viewport: bool = False) -> RenderSettings:
    """The settings of scene.rppm, or the defaults where the extension is not registered.

    viewport: those of a viewport, which has iterations and photons of its own, no time limit and no passes.
    """
    settings = RenderSettings(film_transparent=scene.render.film_transparent)
    stored = getattr(scene, "rppm", None)
    if stored is not None:
        for field in dataclasses.fields(settings):
            if hasattr(stored, field.name):
                setattr(settings, field.name, getattr(stored, field.name))
        settings.direct_light = DirectLight[stored.direct_light]
        if viewport:
            settings.iterations, settings.photons = stored.viewport_iterations, stored.viewport_photons
    if viewport:
        settings.time_limit, settings.deep_cubemap_pass = 0.0, False
    return settings


def export_cubemap_centre(depsgraph: bpy.types.Depsgraph) -> np.ndarray | None:
    """(3,) metres where the chosen object is in this frame; None where none is chosen."""
    stored = getattr(depsgraph.scene, "rppm", None)
    chosen = None if stored is None else stored.cubemap_centre_object
    return None if chosen is None else np.array(chosen.evaluated_get(depsgraph).matrix_world.translation, float)


def export_exposure(scene: bpy.types.Scene) -> float:
    """Cycles' film exposure, a factor; 1 where Cycles is not enabled."""
    return scene.cycles.film_exposure if hasattr(scene, "cycles") else 1.0

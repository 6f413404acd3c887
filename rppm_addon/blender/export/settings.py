# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's scene properties to render settings."""

import dataclasses

import bpy
import numpy as np

from ...scene import DirectLight, RenderSettings


def export_settings(scene: bpy.types.Scene) -> RenderSettings:
    """The settings of scene.rppm, or the defaults where the extension is not registered."""
    settings = RenderSettings(film_transparent=scene.render.film_transparent)
    stored = getattr(scene, "rppm", None)
    if stored is not None:
        for field in dataclasses.fields(settings):
            if hasattr(stored, field.name):
                setattr(settings, field.name, getattr(stored, field.name))
        settings.direct_light = DirectLight[stored.direct_light]
    return settings


def export_cubemap_centre(depsgraph: bpy.types.Depsgraph) -> np.ndarray | None:
    """(3,) metres where the chosen object is in this frame; None where none is chosen."""
    stored = getattr(depsgraph.scene, "rppm", None)
    chosen = None if stored is None else stored.cubemap_centre_object
    return None if chosen is None else np.array(chosen.evaluated_get(depsgraph).matrix_world.translation, float)

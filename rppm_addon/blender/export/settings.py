# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's scene properties to render settings."""

import dataclasses

import bpy

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

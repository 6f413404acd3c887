# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the Properties editor, and a button in the viewport's header."""

import bpy

from . import borrowed, data, shading, switches, view_layer, viewport_header, viewport_shading, warnings
from .render_tab import (
    baking,
    curves,
    cycles_settings,
    light_paths,
    lights,
    motion,
    performance,
    presets,
    render,
    sampling,
    simplify,
    subdivision,
)

CLASSES = (
    *cycles_settings.CLASSES,
    *presets.CLASSES,
    *sampling.CLASSES,
    *warnings.CLASSES,
    *performance.STATUS,
    *light_paths.CLASSES,
    *render.CLASSES,
    *subdivision.CLASSES,
    *curves.CLASSES,
    *motion.CLASSES,
    *baking.CLASSES,
    *lights.CLASSES,
    *simplify.CLASSES,
    *performance.CLASSES,
    *view_layer.CLASSES,
    *data.CLASSES,
    *shading.CLASSES,
    *viewport_shading.CLASSES,
)
"""In the order in which their tabs show them."""


def register() -> None:
    """Add the panels, and let Blender's own show."""
    switches.register()
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    presets.register()
    borrowed.register()
    viewport_header.register()


def unregister() -> None:
    """Take out the panels."""
    viewport_header.unregister()
    borrowed.unregister()
    presets.unregister()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    switches.unregister()


def redraw() -> None:
    """Have all drawn again that shows readings, as when a viewport has reported. Main thread only."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"PROPERTIES", "PREFERENCES"}:
                area.tag_redraw()
            elif area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "HEADER":
                        region.tag_redraw()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The pause button in the header of a rendered viewport."""

import bpy

from .base import ENGINE


def draw_pause(self: bpy.types.Header, context: bpy.types.Context) -> None:
    """Show whether rendered viewports are paused, and let them go on."""
    space = context.space_data
    if context.engine == ENGINE and space.type == "VIEW_3D" and space.shading.type == "RENDERED":
        settings = context.scene.rppm
        self.layout.prop(settings, "preview_pause", text="", icon="PLAY" if settings.preview_pause else "PAUSE")


def register() -> None:
    """Add the header's button."""
    bpy.types.VIEW3D_HT_header.append(draw_pause)


def unregister() -> None:
    """Take out the header's button."""
    bpy.types.VIEW3D_HT_header.remove(draw_pause)

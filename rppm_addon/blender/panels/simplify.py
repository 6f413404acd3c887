# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's Simplify panel shows, which would stand before all others of the render tab."""

import bpy
from bl_ui import properties_render
from bl_ui.properties_grease_pencil_common import GreasePencilSimplifyPanel

from .base import RppmPanel


class RPPM_PT_simplify(RppmPanel, bpy.types.Panel):
    bl_label = "Simplify"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render, "use_simplify", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """All is in the panels inside."""


class RPPM_PT_simplify_viewport(RppmPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "RPPM_PT_simplify"

    def draw(self, context: bpy.types.Context) -> None:
        """Blender's, and Cycles' limit."""
        properties_render.RENDER_PT_simplify_viewport.draw(self, context)
        _texture_limit(self.layout, context.scene, "texture_limit")


class RPPM_PT_simplify_render(RppmPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "RPPM_PT_simplify"

    def draw(self, context: bpy.types.Context) -> None:
        """Blender's, and Cycles' limit."""
        properties_render.RENDER_PT_simplify_render.draw(self, context)
        _texture_limit(self.layout, context.scene, "texture_limit_render")


class RPPM_PT_simplify_greasepencil(RppmPanel, GreasePencilSimplifyPanel, bpy.types.Panel):
    bl_label = "Grease Pencil"
    bl_parent_id = "RPPM_PT_simplify"
    bl_options = {"DEFAULT_CLOSED"}


def _texture_limit(layout: bpy.types.UILayout, scene: bpy.types.Scene, name: str) -> None:
    if hasattr(scene, "cycles"):  # whose add-on may be off
        column = layout.column()
        column.active = scene.render.use_simplify
        column.prop(scene.cycles, name, text="Texture Limit")


CLASSES = (
    RPPM_PT_simplify,
    RPPM_PT_simplify_viewport,
    RPPM_PT_simplify_render,
    RPPM_PT_simplify_greasepencil,
)

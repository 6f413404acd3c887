# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels in place of Blender's Simplify panel, which would stand before all others of the render tab."""

import bpy
from bl_ui import properties_render
from bl_ui.properties_grease_pencil_common import GreasePencilSimplifyPanel

from ...export.instances.instance_reader import SURFACE_TYPES
from .. import cycles_properties
from ..base import RppmPanel


class RPPM_PT_simplify(RppmPanel, bpy.types.Panel):
    bl_label = "Simplify"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render, "use_simplify", text="")

    def draw(self, context: bpy.types.Context) -> None:
        """All is in the panels inside, but for what Cycles' add-on would add to them."""
        if not cycles_properties.are_there():
            cycles_properties.draw_remedy(self.layout, "Texture Limit, Culling")


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


class RPPM_PT_simplify_culling(RppmPanel, bpy.types.Panel):
    bl_label = "Culling"
    bl_parent_id = "RPPM_PT_simplify"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Where Cycles, whose properties they are, is enabled."""
        return super().poll(context) and cycles_properties.are_there()

    def draw(self, context: bpy.types.Context) -> None:
        """For which objects, they say themselves."""
        layout, settings = self.layout, context.scene.cycles
        layout.use_property_split, layout.use_property_decorate = True, False
        layout.active = context.scene.render.use_simplify
        for heading, switch, number in (
            ("Camera Culling", "use_camera_cull", "camera_cull_margin"),
            ("Distance Culling", "use_distance_cull", "distance_cull_margin"),
        ):
            row = layout.row(heading=heading)
            row.prop(settings, switch, text="")
            column = row.column()
            column.active = getattr(settings, switch)
            column.prop(settings, number, text="")
        layout.label(text="In final renders", icon="INFO")


class RPPM_PT_object_culling(RppmPanel, bpy.types.Panel):
    bl_label = "Culling"
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Return True for objects with a surface."""
        return super().poll(context) and context.object is not None and context.object.type in SURFACE_TYPES

    def draw(self, context: bpy.types.Context) -> None:
        """Whether it is culled where the scene culls."""
        layout, scene = self.layout, context.scene
        if not cycles_properties.are_there():
            cycles_properties.draw_remedy(layout, "Camera Culling, Distance Culling")
            return
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in ("use_camera_cull", "use_distance_cull"):
            row = layout.row()
            row.active = scene.render.use_simplify and getattr(scene.cycles, name)
            row.prop(context.object.cycles, name)


class RPPM_PT_simplify_greasepencil(RppmPanel, GreasePencilSimplifyPanel, bpy.types.Panel):
    bl_label = "Grease Pencil"
    bl_parent_id = "RPPM_PT_simplify"
    bl_options = {"DEFAULT_CLOSED"}


def _texture_limit(layout: bpy.types.UILayout, scene: bpy.types.Scene, name: str) -> None:
    if cycles_properties.are_there():
        column = layout.column()
        column.active = scene.render.use_simplify
        column.prop(scene.cycles, name, text="Texture Limit")


CLASSES = (
    RPPM_PT_simplify,
    RPPM_PT_simplify_viewport,
    RPPM_PT_simplify_render,
    RPPM_PT_simplify_culling,
    RPPM_PT_object_culling,
    RPPM_PT_simplify_greasepencil,
)

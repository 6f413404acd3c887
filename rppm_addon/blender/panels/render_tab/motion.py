# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur: of the render, and of objects with the properties that Cycles gives them."""

import bpy

from ...export.instances.instance_reader import SURFACE_TYPES
from .. import cycles_properties
from ..base import RppmPanel

_SHAPES = (
    ("SMOOTH", "SMOOTHCURVE"),
    ("ROUND", "SPHERECURVE"),
    ("ROOT", "ROOTCURVE"),
    ("SHARP", "SHARPCURVE"),
    ("LINE", "LINCURVE"),
    ("MAX", "NOCURVE"),
)
_BLURRED = {*SURFACE_TYPES, "CAMERA", "LIGHT"}


class RPPM_PT_motion_blur(RppmPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context: bpy.types.Context) -> None:
        render = context.scene.render
        column = self.column()
        column.active = render.use_motion_blur
        column.prop(render, "motion_blur_position", text="Position")
        column.prop(render, "motion_blur_shutter")
        if not cycles_properties.are_there():
            cycles_properties.draw_remedy(column, "Rolling Shutter")
            return
        cycles = context.scene.cycles
        column.prop(cycles, "rolling_shutter_type", text="Rolling Shutter")
        column = column.column()
        column.active = cycles.rolling_shutter_type != "NONE"
        column.prop(cycles, "rolling_shutter_duration", text="Duration")


class RPPM_PT_motion_blur_curve(RppmPanel, bpy.types.Panel):
    bl_label = "Shutter Curve"
    bl_parent_id = "RPPM_PT_motion_blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        render = context.scene.render
        column = self.column()
        column.active = render.use_motion_blur
        column.template_curve_mapping(render, "motion_blur_shutter_curve")
        row = column.row(align=True)
        for shape, icon in _SHAPES:
            row.operator("render.shutter_curve_preset", icon=icon, text="").shape = shape


class RPPM_PT_object_motion_blur(RppmPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        shown = context.object
        if not super().poll(context) or shown is None:
            return False
        return shown.type in _BLURRED or (shown.instance_type == "COLLECTION" and shown.instance_collection is not None)

    def draw_header(self, context: bpy.types.Context) -> None:
        if cycles_properties.are_there():
            self.layout.active = context.scene.render.use_motion_blur
            self.layout.prop(context.object.cycles, "use_motion_blur", text="")

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        if not cycles_properties.are_there():
            cycles_properties.draw_remedy(column, "Motion Blur, Steps, Deformation")
            return
        cycles = context.object.cycles
        column.active = context.scene.render.use_motion_blur and cycles.use_motion_blur
        column.prop(cycles, "motion_steps", text="Steps")
        if context.object.type not in {"CAMERA", "LIGHT"}:
            column.prop(cycles, "use_deform_motion", text="Deformation")


CLASSES = (RPPM_PT_motion_blur, RPPM_PT_motion_blur_curve, RPPM_PT_object_motion_blur)

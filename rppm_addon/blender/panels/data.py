# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the tab of a light."""

import bpy

from .render import RppmPanel


class RppmLightPanel(RppmPanel):
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light is not None


class RPPM_PT_light(RppmLightPanel, bpy.types.Panel):
    bl_label = "Light"

    def draw(self, context: bpy.types.Context) -> None:
        light = context.light
        self.layout.row().prop(light, "type", expand=True)
        column = self.column()
        # Names differ between the Blender versions: show what this one has.
        for name in ("color", "use_temperature", "temperature", "energy", "exposure", "normalize"):
            if hasattr(light, name) and (name != "temperature" or light.use_temperature):
                column.prop(light, name)
        column.separator()
        if light.type in {"POINT", "SPOT"}:
            column.prop(light, "shadow_soft_size", text="Radius")
        elif light.type == "SUN":
            column.prop(light, "angle")
        else:
            oblong = light.shape in {"RECTANGLE", "ELLIPSE"}
            column.prop(light, "shape")
            column.prop(light, "size", text="Size X" if oblong else "Size")
            if oblong:
                column.prop(light, "size_y", text="Y")
            column.prop(light, "spread")
        column.separator()
        column.prop(light.rppm, "photon_share")


class RPPM_PT_light_beam(RppmLightPanel, bpy.types.Panel):
    bl_label = "Beam Shape"
    bl_parent_id = "RPPM_PT_light"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light.type == "SPOT"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.light, "spot_size", text="Spot Size")
        column.prop(context.light, "spot_blend", text="Blend", slider=True)
        column.prop(context.light, "show_cone")


CLASSES = (RPPM_PT_light, RPPM_PT_light_beam)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels that RPPM adds to Blender's own in the shading popover of a rendered viewport."""

import bpy

from .base import EnginePanel


class _ShadingPanel(EnginePanel):
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_parent_id = "VIEW3D_PT_shading"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.space_data.shading.type == "RENDERED"


class RPPM_PT_shading_lighting(_ShadingPanel, bpy.types.Panel):
    bl_label = "Lighting"

    def draw(self, context: bpy.types.Context) -> None:
        bpy.types.VIEW3D_PT_shading_lighting.draw(self, context)


class RPPM_PT_shading_render_pass(_ShadingPanel, bpy.types.Panel):
    bl_label = "Render Pass"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.space_data.shading.rppm, "render_pass", text="")


CLASSES = (RPPM_PT_shading_lighting, RPPM_PT_shading_render_pass)

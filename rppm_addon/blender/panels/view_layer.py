# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the view layer tab."""

import bpy

from .base import RppmPanel


class RPPM_PT_passes(RppmPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.view_layer, "use_pass_combined")
        column.prop(context.view_layer, "use_pass_z")
        column.prop(context.view_layer, "use_pass_normal")
        column.prop(context.scene.rppm, "deep_cubemap_pass")


CLASSES = (RPPM_PT_passes,)

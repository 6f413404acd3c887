# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the view layer tab."""

import bpy
from bl_ui import properties_view_layer

from ...scene.passes import PASSES, Accumulation
from ..export.view_layer.passes import switch_of
from .base import RppmPanel


def _blenders(name: str) -> type:
    """Return a class that Blender's own panels of passes share, which before Blender 4.3 was a panel itself."""
    return getattr(properties_view_layer, f"{name}Helper", None) or getattr(properties_view_layer, name)


class RPPM_PT_passes(RppmPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.view_layer, "use_pass_combined")
        shown = (entry for entry in PASSES if entry.accumulation is not Accumulation.COVERAGE)
        for switch in dict.fromkeys(switch_of(context.view_layer, entry) for entry in shown):
            column.prop(*switch)
        column.prop(context.view_layer, "pass_alpha_threshold")


class RPPM_PT_passes_cryptomatte(RppmPanel, _blenders("ViewLayerCryptomattePanel"), bpy.types.Panel):
    bl_label = "Cryptomatte"
    bl_context = "view_layer"
    bl_parent_id = "RPPM_PT_passes"


class RPPM_PT_passes_aov(RppmPanel, _blenders("ViewLayerAOVPanel"), bpy.types.Panel):
    bl_label = "Shader AOV"
    bl_context = "view_layer"
    bl_parent_id = "RPPM_PT_passes"


class RPPM_PT_passes_light_groups(RppmPanel, _blenders("ViewLayerLightgroupsPanel"), bpy.types.Panel):
    bl_label = "Light Groups"
    bl_context = "view_layer"
    bl_parent_id = "RPPM_PT_passes"


class RPPM_PT_filter(RppmPanel, bpy.types.Panel):
    bl_label = "Filter"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        layer = context.view_layer
        include = self.column().column(heading="Include")
        include.prop(layer, "use_sky", text="Environment")
        include.prop(layer, "use_solid", text="Surfaces")
        include.prop(layer, "use_strand", text="Curves")
        include.prop(layer, "use_volumes", text="Volumes")
        use = self.layout.column(heading="Use")
        if hasattr(layer, "use_motion_blur"):  # Blender 5
            row = use.row()
            row.active = context.scene.render.use_motion_blur
            row.prop(layer, "use_motion_blur", text="Motion Blur")
        row = use.row()
        row.active = context.scene.rppm.use_denoising
        row.prop(layer.rppm, "use_denoising", text="Denoising")


class RPPM_PT_override(RppmPanel, bpy.types.Panel):
    bl_label = "Override"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "view_layer"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Blender 5 has such a panel for all engines."""
        return super().poll(context) and not hasattr(bpy.types, "VIEWLAYER_PT_override")

    def draw(self, context: bpy.types.Context) -> None:
        column, layer = self.column(), context.view_layer
        column.prop(layer, "material_override")
        if hasattr(layer, "world_override"):
            column.prop(layer, "world_override")
        column.prop(layer, "samples")


CLASSES = (
    RPPM_PT_passes,
    RPPM_PT_passes_cryptomatte,
    RPPM_PT_passes_aov,
    RPPM_PT_passes_light_groups,
    RPPM_PT_filter,
    RPPM_PT_override,
)

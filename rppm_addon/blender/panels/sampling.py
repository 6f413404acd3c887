# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab on how much is rendered, and their presets."""

import bpy

from ...scene.quantities import count_text
from ..export.settings import export_settings
from .base import RppmPanel, rendered_size
from .cycles_settings import RPPM_OT_copy_from_cycles, RPPM_OT_copy_to_cycles
from .presets import RPPM_PT_presets
from .switches import draw_setting


class RPPM_PT_sampling(RppmPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        RPPM_PT_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "direct_light", text="Direct")
        column.prop(settings, "use_final_gather")
        if RPPM_OT_copy_from_cycles.poll(context):
            row = column.row(align=True)
            row.operator(RPPM_OT_copy_from_cycles.bl_idname, text="From Cycles")
            row.operator(RPPM_OT_copy_to_cycles.bl_idname, text="To Cycles")


class RPPM_PT_sampling_viewport(RppmPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "preview_samples", text="Samples")
        draw_setting(column, context.scene, "preview_photons", "Photons")
        column.prop(settings, "preview_pause", text="Pause")


class RPPM_PT_sampling_final(RppmPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "samples")
        photons = export_settings(context.scene).photons_for(*rendered_size(context.scene.render))
        draw_setting(column, context.scene, "photons", "Photons", f"Automatic: {count_text(photons)}")
        draw_setting(column, context.scene, "time_limit", "Time Limit")


class RPPM_PT_advanced(RppmPanel, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "RPPM_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        row = column.row(align=True)
        row.prop(settings, "seed")
        row.prop(settings, "use_animated_seed", text="", icon="TIME")
        column.prop(settings, "density_estimation", text="Density")
        column.prop(settings, "first_photon_hits", text="First Hits")
        column.prop(settings, "use_splat_roulette")


CLASSES = (RPPM_PT_sampling, RPPM_PT_sampling_viewport, RPPM_PT_sampling_final, RPPM_PT_advanced)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab on how much is rendered, and their presets."""

import bpy

from ...scene.quantities import count_text
from ..export.settings import export_settings
from .base import RppmPanel, reading, rendered_size
from .cycles_settings import RPPM_OT_copy_from_cycles, RPPM_OT_copy_to_cycles
from .presets import RPPM_PT_presets


class RPPM_PT_sampling(RppmPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        RPPM_PT_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "direct_light")
        column.prop(settings, "use_final_gather")
        if RPPM_OT_copy_from_cycles.poll(context):
            row = column.row(align=True)
            row.operator(RPPM_OT_copy_from_cycles.bl_idname)
            row.operator(RPPM_OT_copy_to_cycles.bl_idname)


class RPPM_PT_sampling_viewport(RppmPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "preview_samples", text="Samples")
        column.prop(settings, "preview_photons", text="Photons")
        column.prop(settings, "preview_pause", text="Pause")


class RPPM_PT_sampling_final(RppmPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "samples")
        column.prop(settings, "photons")
        if settings.photons == 0:
            photons = export_settings(context.scene).photons_for(*rendered_size(context.scene.render))
            reading(column, "Automatic", f"{count_text(photons)} photons")
        column.prop(settings, "time_limit")


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
        column.prop(settings, "density_estimation")
        column.prop(settings, "first_photon_hits")
        column.prop(settings, "use_splat_roulette")


CLASSES = (RPPM_PT_sampling, RPPM_PT_sampling_viewport, RPPM_PT_sampling_final, RPPM_PT_advanced)

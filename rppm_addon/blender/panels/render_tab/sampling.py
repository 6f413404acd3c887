# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab on how much is rendered, and their presets."""

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ....denoising.places import REMEDY
from ....scene.common.quantities import count_text
from ...export.view_layer.settings import export_settings
from ...render_client.denoising_libraries import denoising_libraries
from ..base import RppmPanel, letters_across, paragraph, rendered_size
from ..switches import draw_setting
from .cycles_settings import RPPM_OT_copy_from_cycles, RPPM_OT_copy_to_cycles
from .presets import RPPM_PT_presets


class RPPM_PT_sampling(RppmPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        RPPM_PT_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """All is in the panels inside, samples first."""


def _draw_samples(column: bpy.types.UILayout, scene: bpy.types.Scene, viewport: bool) -> None:
    """Noise threshold and samples of final renders or of viewports, laid out as Cycles' panels are."""
    prefix, settings = "preview_" if viewport else "", scene.rppm
    is_on = getattr(settings, f"use_{prefix}adaptive_sampling")
    row = column.row(align=True, heading="Noise Threshold")
    row.prop(settings, f"use_{prefix}adaptive_sampling", text="")
    threshold = row.row()
    threshold.active = is_on
    threshold.prop(settings, f"{prefix}adaptive_threshold", text="")
    column.prop(settings, f"{prefix}samples", text="Max Samples" if is_on else "Samples")
    least = column.column()
    least.active = is_on
    automatic = iface_("Automatic: {}").format(export_settings(scene, viewport=viewport).least_iterations)
    draw_setting(least, scene, f"{prefix}adaptive_min_samples", "Min Samples", automatic)


class RPPM_PT_sampling_viewport(RppmPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        _draw_samples(column, context.scene, viewport=True)
        draw_setting(column, context.scene, "preview_photons", "Photons")
        column.prop(settings, "preview_pause", text="Pause")


class RPPM_PT_sampling_final(RppmPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        _draw_samples(column, context.scene, viewport=False)
        photons = export_settings(context.scene).photons_for(*rendered_size(context.scene.render))
        automatic = iface_("Automatic: {}").format(count_text(photons))
        draw_setting(column, context.scene, "photons", "Photons", automatic)
        draw_setting(column, context.scene, "time_limit", "Time Limit")


class _DenoisePanel(RppmPanel):
    """Denoising of viewports or of final renders, laid out as Cycles' panels are."""

    bl_label = "Denoise"
    bl_options = {"DEFAULT_CLOSED"}
    prefix = ""

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.rppm, f"use_{self.prefix}denoising", text="")

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        if not denoising_libraries():
            text = iface_("Open Image Denoise is not there: {}").format(iface_(REMEDY))
            paragraph(self.layout, text, letters_across(context), icon="ERROR")
        column = self.column()
        column.active = getattr(settings, f"use_{self.prefix}denoising")
        column.prop(settings, f"{self.prefix}denoising_input_passes", text="Passes")
        column.prop(settings, f"{self.prefix}denoising_prefilter", text="Prefilter")
        column.prop(settings, f"{self.prefix}denoising_quality", text="Quality")
        column.prop(settings, f"{self.prefix}denoising_use_gpu", text="Use GPU")
        if self.prefix:
            column.prop(settings, f"{self.prefix}denoising_start_sample", text="Start Sample")


class RPPM_PT_sampling_viewport_denoise(_DenoisePanel, bpy.types.Panel):
    bl_parent_id = "RPPM_PT_sampling_viewport"
    prefix = "preview_"


class RPPM_PT_sampling_final_denoise(_DenoisePanel, bpy.types.Panel):
    bl_parent_id = "RPPM_PT_sampling_final"


class RPPM_PT_light_estimation(RppmPanel, bpy.types.Panel):
    bl_label = "Light Estimation"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.scene.rppm, "direct_light", text="Direct")
        column.prop(context.scene.rppm, "use_final_gather")


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
        row = column.row()
        row.active = any(layer.samples > 0 for layer in context.scene.view_layers)
        row.prop(settings, "use_layer_samples")
        if RPPM_OT_copy_from_cycles.poll(context):
            row = column.row(align=True)
            row.operator(RPPM_OT_copy_from_cycles.bl_idname)
            row.operator(RPPM_OT_copy_to_cycles.bl_idname)


CLASSES = (
    RPPM_PT_sampling,
    RPPM_PT_sampling_viewport,
    RPPM_PT_sampling_viewport_denoise,
    RPPM_PT_sampling_final,
    RPPM_PT_sampling_final_denoise,
    RPPM_PT_light_estimation,
    RPPM_PT_advanced,
)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab on how much is rendered, and their presets."""

import bpy

from ...scene.quantities import count_text
from ..export.settings import export_settings
from .base import RppmPanel, reading, rendered_size
from .presets import RPPM_PT_presets


class RPPM_PT_sampling(RppmPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        RPPM_PT_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "direct_light")
        column.prop(settings, "final_gather")


class RPPM_PT_sampling_viewport(RppmPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "viewport_iterations", text="Iterations")
        column.prop(settings, "viewport_photons", text="Photons")
        column.prop(settings, "viewport_paused", text="Pause")


class RPPM_PT_sampling_final(RppmPanel, bpy.types.Panel):
    bl_label = "Final Render"
    bl_parent_id = "RPPM_PT_sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "iterations")
        column.prop(settings, "photons")
        if settings.photons == 0:
            photons = export_settings(context.scene).photons_for(*rendered_size(context.scene.render))
            reading(column, "Automatic", f"{count_text(photons)} photons")
        column.prop(settings, "time_limit")


CLASSES = (RPPM_PT_sampling, RPPM_PT_sampling_viewport, RPPM_PT_sampling_final)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab that show settings of radii, animation and film."""

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...export.camera.camera import frame_size
from ...export.view_layer.settings import export_settings
from ...readings import radius_reading
from ...reports import reports_of
from ..base import RppmPanel, length_text, reading


class RPPM_PT_radius(RppmPanel, bpy.types.Panel):
    bl_label = "Radius"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        scene = context.scene
        column = self.column()
        column.prop(scene.rppm, "radius_scale", text="Initial")
        column.prop(scene.rppm, "use_adaptive_radius", text="Adaptive")
        column.prop(scene.rppm, "alpha")
        column.separator()
        final = radius_reading(export_settings(scene), *frame_size(scene.render))
        reading(column, "First", iface_("{:.2f} pixels").format(final.first))
        reading(column, "Last", iface_("{:.2f} pixels ({:.0%})").format(final.last, final.shrinkage))
        viewport = radius_reading(export_settings(scene, viewport=True), *frame_size(scene.render))
        reading(column, "Viewport", iface_("{:.0%} after {}").format(viewport.shrinkage, scene.rppm.preview_samples))
        report = reports_of(scene.session_uid).latest
        if report is not None:
            radius = length_text(scene, report.photon_statistics.radius_meters)
            reading(column, "Rendered", iface_("{} in sample {}").format(radius, report.progress.iteration))


class RPPM_PT_animation(RppmPanel, bpy.types.Panel):
    bl_label = "Animation"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.column().prop(context.scene.rppm, "samples_per_frame", text="Samples")


class RPPM_PT_film(RppmPanel, bpy.types.Panel):
    bl_label = "Film"

    def draw(self, context: bpy.types.Context) -> None:
        scene = context.scene
        column = self.column()
        column.prop(scene.rppm, "film_exposure")
        column.prop(scene.rppm, "pixel_filter_type", text="Filter")
        if scene.rppm.pixel_filter_type != "BOX":
            column.prop(scene.rppm, "filter_width", text="Width")
        column.prop(scene.render, "film_transparent", text="Transparent")
        glass = column.column()
        glass.active = scene.render.film_transparent
        glass.prop(scene.rppm, "film_transparent_glass")
        row = glass.row()
        row.active = scene.rppm.film_transparent_glass
        row.prop(scene.rppm, "film_transparent_roughness")


CLASSES = (
    RPPM_PT_radius,
    RPPM_PT_animation,
    RPPM_PT_film,
)

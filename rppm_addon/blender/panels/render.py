# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab that show settings, but for those of sampling."""

import bpy

from ..export.camera.camera import frame_size
from ..export.settings import export_settings
from ..readings import radius_reading
from ..reports import reports_of
from .base import RppmPanel, reading


class RPPM_PT_paths(RppmPanel, bpy.types.Panel):
    bl_label = "Path Lengths"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "camera_path_length", text="Camera")
        column.prop(settings, "photon_path_length", text="Photon")
        column.prop(settings, "specular_roughness")


class RPPM_PT_radius(RppmPanel, bpy.types.Panel):
    bl_label = "Radius"

    def draw(self, context: bpy.types.Context) -> None:
        scene = context.scene
        column = self.column()
        column.prop(scene.rppm, "radius_scale")
        column.prop(scene.rppm, "adaptive_radius")
        column.prop(scene.rppm, "radius_minimum")
        column.prop(scene.rppm, "radius_maximum")
        column.prop(scene.rppm, "alpha")
        column.separator()
        final = radius_reading(export_settings(scene), *frame_size(scene.render))
        reading(column, "First Iteration", f"{final.first:.2f} pixels")
        text = f"{final.last:.2f} pixels ({final.shrinkage:.0%}) after {scene.rppm.iterations} iterations"
        reading(column, "Final Render", text)
        viewport = radius_reading(export_settings(scene, viewport=True), *frame_size(scene.render))
        reading(column, "Viewport", f"{viewport.shrinkage:.0%} after {scene.rppm.viewport_iterations} iterations")
        report = reports_of(scene.session_uid).latest
        if report is not None:
            length = bpy.utils.units.to_string(scene.unit_settings.system, "LENGTH", report.radius_metres, precision=4)
            reading(column, f"Last {report.kind.value}", f"{length} in iteration {report.iterations}")


class RPPM_PT_animation(RppmPanel, bpy.types.Panel):
    bl_label = "Animation"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.column().prop(context.scene.rppm, "iterations_per_frame")


class RPPM_PT_film(RppmPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        scene = context.scene
        column = self.column()
        if hasattr(scene, "cycles"):
            column.prop(scene.cycles, "film_exposure")
        column.prop(scene.rppm, "filter_width")
        column.prop(scene.render, "film_transparent", text="Transparent")


class RPPM_PT_advanced(RppmPanel, bpy.types.Panel):
    bl_label = "Advanced"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        row = column.row(align=True)
        row.prop(settings, "seed")
        row.prop(settings, "animate_seed", text="", icon="TIME")
        column.prop(settings, "density_estimation")
        column.prop(settings, "first_photon_hits")
        column.prop(settings, "splat_roulette")


class RPPM_PT_deep_cubemap(RppmPanel, bpy.types.Panel):
    bl_label = "Deep Cubemap"
    bl_parent_id = "RPPM_PT_advanced"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "cubemap_resolution", text="Resolution")
        column.prop(settings, "cubemap_centre_object", text="Centre")


CLASSES = (
    RPPM_PT_paths,
    RPPM_PT_radius,
    RPPM_PT_animation,
    RPPM_PT_film,
)
ADVANCED = (RPPM_PT_advanced, RPPM_PT_deep_cubemap)

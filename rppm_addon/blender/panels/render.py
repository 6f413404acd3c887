# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render and view layer tabs."""

import bpy

ENGINE = "RPPM"


class RppmPanel:
    """What all panels of RPPM in the Properties editor share."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine == ENGINE

    def column(self) -> bpy.types.UILayout:
        """A column laid out as Blender's own panels are."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class RPPM_PT_sampling(RppmPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "iterations")
        column.prop(settings, "time_limit")
        column.separator()
        column.prop(settings, "photons")
        column.prop(settings, "direct_light")
        column.prop(settings, "final_gather")
        column.separator()
        column.prop(settings, "viewport_iterations")
        column.prop(settings, "viewport_photons")
        column.prop(settings, "viewport_paused")


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
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "radius_scale")
        column.prop(settings, "radius_minimum")
        column.prop(settings, "radius_maximum")
        column.prop(settings, "alpha")


class RPPM_PT_animation(RppmPanel, bpy.types.Panel):
    bl_label = "Animation and Display"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.column().prop(context.scene.rppm, "iterations_per_frame")


class RPPM_PT_advanced(RppmPanel, bpy.types.Panel):
    bl_label = "Advanced"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "seed")
        column.prop(settings, "splat_roulette")
        column.prop(settings, "cubemap_resolution")
        column.prop(settings, "cubemap_centre_object")


class RPPM_PT_film(RppmPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.scene.rppm, "filter_width")
        column.prop(context.scene.render, "film_transparent", text="Transparent")


class RPPM_PT_passes(RppmPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.view_layer, "use_pass_combined")
        column.prop(context.view_layer, "use_pass_z")
        column.prop(context.view_layer, "use_pass_normal")
        column.prop(context.scene.rppm, "deep_cubemap_pass")


CLASSES = (
    RPPM_PT_sampling,
    RPPM_PT_paths,
    RPPM_PT_radius,
    RPPM_PT_animation,
    RPPM_PT_advanced,
    RPPM_PT_film,
    RPPM_PT_passes,
)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel Light Paths, with Cycles' sub-panels."""

import bpy

from ..base import RppmPanel


class RPPM_PT_light_paths(RppmPanel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.column().prop(context.scene.rppm, "specular_roughness", text="Specular")


class _LightPathsPanel(RppmPanel):
    bl_parent_id = "RPPM_PT_light_paths"


class RPPM_PT_light_paths_max_bounces(_LightPathsPanel, bpy.types.Panel):
    bl_label = "Max Bounces"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "max_bounces", text="Total")
        column.separator()
        column.prop(settings, "diffuse_bounces", text="Diffuse")
        column.prop(settings, "glossy_bounces", text="Glossy")
        column.prop(settings, "transmission_bounces", text="Transmission")
        column.prop(settings, "volume_bounces", text="Volume")
        column.separator()
        column.prop(settings, "transparent_max_bounces", text="Transparent")


class RPPM_PT_path_parts(RppmPanel, bpy.types.Panel):
    bl_label = "Camera and Photons"
    bl_parent_id = "RPPM_PT_light_paths_max_bounces"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "max_camera_bounces", text="Camera")
        column.prop(settings, "max_photon_bounces", text="Photon")


class RPPM_PT_light_paths_clamping(_LightPathsPanel, bpy.types.Panel):
    bl_label = "Clamping"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "sample_clamp_direct", text="Direct Light")
        column.prop(settings, "sample_clamp_indirect", text="Indirect Light")


class RPPM_PT_light_paths_caustics(_LightPathsPanel, bpy.types.Panel):
    bl_label = "Caustics"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        self.column().prop(settings, "blur_glossy")
        column = self.column().column(heading="Caustics", align=True)
        column.prop(settings, "caustics_reflective", text="Reflective")
        column.prop(settings, "caustics_refractive", text="Refractive")


CLASSES = (
    RPPM_PT_light_paths,
    RPPM_PT_light_paths_max_bounces,
    RPPM_PT_path_parts,
    RPPM_PT_light_paths_clamping,
    RPPM_PT_light_paths_caustics,
)

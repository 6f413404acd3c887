# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the tabs of a light, of a camera and of a volume object."""

import bpy

from . import cycles_properties
from .base import RppmPanel
from .nodes import RppmNodePanel


class RppmLightPanel(RppmPanel):
    bl_context = "data"
    is_decorated = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light is not None


class RPPM_PT_light(RppmLightPanel, bpy.types.Panel):
    bl_label = "Light"

    def draw(self, context: bpy.types.Context) -> None:
        light = context.light
        self.layout.row().prop(light, "type", expand=True)
        column = self.column()
        # Names differ between the Blender versions: show what this one has.
        for name in ("color", "use_temperature", "temperature", "energy", "exposure", "normalize"):
            if hasattr(light, name) and (name != "temperature" or light.use_temperature):
                column.prop(light, name)
        column.separator()
        if light.type in {"POINT", "SPOT"}:
            column.prop(light, "shadow_soft_size", text="Radius")
            if hasattr(light, "use_soft_falloff"):
                column.prop(light, "use_soft_falloff")
        elif light.type == "SUN":
            column.prop(light, "angle")
        else:
            oblong = light.shape in {"RECTANGLE", "ELLIPSE"}
            column.prop(light, "shape")
            column.prop(light, "size", text="Size X" if oblong else "Size")
            if oblong:
                column.prop(light, "size_y", text="Y")
            column.prop(light, "spread")
        column.separator()
        cycles = getattr(light, "cycles", None)
        if light.type == "AREA" and hasattr(cycles, "is_portal"):
            column.prop(cycles, "is_portal", text="Portal")
        # Once the shadow was a property of Cycles.
        if hasattr(cycles, "cast_shadow"):
            column.prop(cycles, "cast_shadow")
        else:
            column.prop(light, "use_shadow", text="Cast Shadow")
        if cycles is not None:
            column.prop(cycles, "max_bounces")
        column.prop(light.rppm, "photon_weight")
        if cycles is None:
            cycles_properties.draw_remedy(column, "Portal, Max Bounces" if light.type == "AREA" else "Max Bounces")


class RPPM_PT_light_beam(RppmLightPanel, bpy.types.Panel):
    bl_label = "Beam Shape"
    bl_parent_id = "RPPM_PT_light"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light.type == "SPOT"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.light, "spot_size", text="Spot Size")
        column.prop(context.light, "spot_blend", text="Blend", slider=True)
        column.prop(context.light, "show_cone")


class RPPM_PT_light_nodes(RppmNodePanel, bpy.types.Panel):
    bl_label = "Nodes"
    bl_context = "data"
    owner_name = "light"


class RPPM_PT_panorama(RppmPanel, bpy.types.Panel):
    """Panorama settings, which Blender's Lens panel shows for Cycles only."""

    bl_label = "Panorama"
    bl_context = "data"
    is_decorated = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.camera is not None and context.camera.type == "PANO"

    def draw(self, context: bpy.types.Context) -> None:
        camera = context.camera
        # Before Blender 5 Cycles adds the properties.
        source = camera if hasattr(camera, "panorama_type") else getattr(camera, "cycles", None)
        if source is None:
            cycles_properties.draw_remedy(self.layout, "Panorama Type")
            return
        column = self.column()
        column.prop(source, "panorama_type")
        for name in _PANORAMA_PROPERTIES.get(source.panorama_type, ()):
            column.prop(source, name)


class RPPM_PT_volume_velocity(RppmPanel, bpy.types.Panel):
    """Velocities of a volume object, which Blender's Render panel shows for Cycles only."""

    bl_label = "Velocity"
    bl_context = "data"
    bl_parent_id = "DATA_PT_volume_render"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.volume is not None

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.volume, "velocity_grid")
        column.prop(context.volume, "velocity_unit")
        column.prop(context.volume, "velocity_scale")


_FISHEYE_POLYNOMIAL = tuple(f"fisheye_polynomial_k{power}" for power in range(5))
_PANORAMA_PROPERTIES = {
    "EQUIRECTANGULAR": ("latitude_min", "latitude_max", "longitude_min", "longitude_max"),
    "FISHEYE_EQUIDISTANT": ("fisheye_fov",),
    "FISHEYE_EQUISOLID": ("fisheye_lens", "fisheye_fov"),
    "FISHEYE_LENS_POLYNOMIAL": ("fisheye_fov", *_FISHEYE_POLYNOMIAL),
    "CENTRAL_CYLINDRICAL": (
        "central_cylindrical_range_v_min",
        "central_cylindrical_range_v_max",
        "central_cylindrical_range_u_min",
        "central_cylindrical_range_u_max",
        "central_cylindrical_radius",
    ),
}


CLASSES = (RPPM_PT_light, RPPM_PT_light_beam, RPPM_PT_light_nodes, RPPM_PT_panorama, RPPM_PT_volume_velocity)

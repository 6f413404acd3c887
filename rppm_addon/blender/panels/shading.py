# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the tabs of a material and of the world."""

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ..colored_glasses import colored_glasses
from ..export.instances.instance_reader import SURFACE_TYPES
from . import cycles_properties
from .base import RppmPanel, letters_across, paragraph
from .nodes import RppmNodePanel

_COLORED_GLASSES = (
    "Red, green and blue glass are added, which gives three colors. One glass with an Abbe number gives the whole "
    "spectrum, with less noise"
)


class RppmMaterialPanel(RppmNodePanel):
    bl_context = "material"
    owner_name = "material"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and not context.material.grease_pencil


class RPPM_PT_material_surface(RppmMaterialPanel, bpy.types.Panel):
    bl_label = "Surface"


class RPPM_PT_material_volume(RppmMaterialPanel, bpy.types.Panel):
    bl_label = "Volume"
    bl_options = {"DEFAULT_CLOSED"}
    input_name = "Volume"


class RPPM_PT_material_displacement(RppmMaterialPanel, bpy.types.Panel):
    bl_label = "Displacement"
    bl_options = {"DEFAULT_CLOSED"}
    input_name = "Displacement"


class RPPM_PT_material_settings(RppmMaterialPanel, bpy.types.Panel):
    bl_label = "Settings"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        material = context.material
        column = self.column()
        column.prop(material, "pass_index")
        # Names differ between the Blender versions: show what this one has.
        for name in ("displacement_method", "use_transparent_shadow"):
            if hasattr(material, name):
                column.prop(material, name)
        if hasattr(material, "cycles"):
            column.prop(material.cycles, "use_bump_map_correction")
        column.prop(material.rppm, "use_dispersion")
        row = column.row()
        row.active = material.rppm.use_dispersion
        row.prop(material.rppm, "abbe_number")
        if colored_glasses(material) is not None:
            paragraph(column, iface_(_COLORED_GLASSES), letters_across(context), icon="INFO")
            column.operator("rppm.convert_to_dispersion")


class RppmWorldPanel(RppmNodePanel):
    bl_context = "world"
    owner_name = "world"


class RPPM_PT_world_preview(RppmWorldPanel, bpy.types.Panel):
    bl_label = "Preview"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.template_preview(context.world)


class RPPM_PT_world_surface(RppmWorldPanel, bpy.types.Panel):
    bl_label = "Surface"


class RPPM_PT_world_volume(RppmWorldPanel, bpy.types.Panel):
    bl_label = "Volume"
    bl_options = {"DEFAULT_CLOSED"}
    input_name = "Volume"


class RPPM_PT_world_mist(RppmPanel, bpy.types.Panel):
    bl_label = "Mist Pass"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "world"
    is_decorated = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Return True where a view layer has the pass."""
        if not super().poll(context) or context.world is None:
            return False
        return any(layer.use_pass_mist for layer in context.scene.view_layers)

    def draw(self, context: bpy.types.Context) -> None:
        mist, column = context.world.mist_settings, self.column()
        for name in ("start", "depth", "falloff"):
            column.prop(mist, name)


class RPPM_PT_world_ambient_occlusion(RppmPanel, bpy.types.Panel):
    """Distance of the pass, of what is baked, and of nodes that have none of their own."""

    bl_label = "Ambient Occlusion"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "world"
    is_decorated = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world is not None

    def draw(self, context: bpy.types.Context) -> None:
        self.column().prop(context.world.light_settings, "distance")


class RPPM_PT_ray_visibility(RppmPanel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.object is not None and context.object.type in _VISIBLE_TYPES

    def draw(self, context: bpy.types.Context) -> None:
        thing = context.object
        column = self.column()
        for name in ("camera", "diffuse", "glossy", "transmission"):
            column.prop(thing, f"visible_{name}", text=name.capitalize())
        column.prop(thing, "visible_volume_scatter", text="Volume Scatter")
        if thing.type != "LIGHT":
            column.prop(thing, "visible_shadow", text="Shadow")
            mask = column.column(heading="Mask")
            mask.prop(thing, "is_holdout")
            mask.prop(thing, "is_shadow_catcher")


class RPPM_PT_shadow_terminator(RppmPanel, bpy.types.Panel):
    bl_label = "Shadow Terminator"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_shading" if hasattr(bpy.types, "OBJECT_PT_shading") else ""  # none before Blender 4.3

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        thing = context.object
        return super().poll(context) and thing is not None and thing.type in SURFACE_TYPES

    def draw(self, context: bpy.types.Context) -> None:
        thing, column = context.object, self.column()
        if hasattr(thing, "shadow_terminator_shading_offset"):
            column.prop(thing, "shadow_terminator_geometry_offset", text="Geometry Offset")
            column.prop(thing, "shadow_terminator_shading_offset", text="Shading Offset")
        elif cycles_properties.are_there():  # whose properties they are before Blender 5
            column.prop(thing.cycles, "shadow_terminator_geometry_offset", text="Geometry Offset")
            column.prop(thing.cycles, "shadow_terminator_offset", text="Shading Offset")
        else:
            cycles_properties.draw_remedy(column, "Geometry Offset, Shading Offset")


class RPPM_PT_world_ray_visibility(RppmPanel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "world"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world is not None

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        if not cycles_properties.are_there():
            cycles_properties.draw_remedy(column, "Ray Visibility, Max Bounces")
            return
        for name in ("camera", "diffuse", "glossy", "transmission", "scatter"):
            column.prop(context.world.cycles_visibility, name)
        column.separator()
        column.prop(context.world.cycles, "max_bounces")


def _draw_light_group(column: bpy.types.UILayout, owner: bpy.types.ID, layer: bpy.types.ViewLayer) -> None:
    """The group of an object or a world, and a button that gives the view layer such a group."""
    row = column.row(align=True)
    row.prop_search(owner, "lightgroup", layer, "lightgroups", text="Light Group", results_are_suggestions=True)
    button = row.row(align=True)
    button.enabled = bool(owner.lightgroup) and owner.lightgroup not in layer.lightgroups
    button.operator("scene.view_layer_add_lightgroup", icon="ADD", text="").name = owner.lightgroup


class RPPM_PT_object_light_group(RppmPanel, bpy.types.Panel):
    bl_label = "Light Group"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "object"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.object is not None and context.object.type in _VISIBLE_TYPES

    def draw(self, context: bpy.types.Context) -> None:
        _draw_light_group(self.column(), context.object, context.view_layer)


class RPPM_PT_world_light_group(RppmPanel, bpy.types.Panel):
    bl_label = "Light Group"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "world"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world is not None

    def draw(self, context: bpy.types.Context) -> None:
        _draw_light_group(self.column(), context.world, context.view_layer)


_VISIBLE_TYPES = {*SURFACE_TYPES, "LIGHT"}
"""Objects that are rendered."""


CLASSES = (
    RPPM_PT_material_surface,
    RPPM_PT_material_volume,
    RPPM_PT_material_displacement,
    RPPM_PT_material_settings,
    RPPM_PT_world_preview,
    RPPM_PT_world_surface,
    RPPM_PT_world_volume,
    RPPM_PT_world_mist,
    RPPM_PT_world_ambient_occlusion,
    RPPM_PT_ray_visibility,
    RPPM_PT_shadow_terminator,
    RPPM_PT_world_ray_visibility,
    RPPM_PT_object_light_group,
    RPPM_PT_world_light_group,
)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's settings for baking, as Cycles' panels show them."""

import bpy

from ..base import RppmPanel

_LIGHT_BY_LOBES = {"DIFFUSE", "GLOSSY", "TRANSMISSION"}
_SEEN = {"COMBINED", "EMIT", *_LIGHT_BY_LOBES}
"""Types that depend on from where a surface is seen."""
_BEFORE_5 = {
    "use_multires": "use_bake_multires",
    "type": "bake_type",
    "use_clear": "use_bake_clear",
    "use_lores_mesh": "use_bake_lores_mesh",
    "margin": "bake_margin",
}
"""Properties of RenderSettings in place of those of BakeSettings that Blender 5 has for multiresolution."""


def _of_multires(render: bpy.types.RenderSettings, name: str) -> tuple[bpy.types.bpy_struct, str]:
    """Return the owner of a setting for multiresolution, and its name there. name: as Blender 5 has it."""
    return (render.bake, name) if hasattr(render.bake, "use_multires") else (render, _BEFORE_5[name])


def _uses_multires(context: bpy.types.Context) -> bool:
    return getattr(*_of_multires(context.scene.render, "use_multires"))


class _BakePanel(RppmPanel):
    bl_parent_id = "RPPM_PT_bake"


class RPPM_PT_bake(RppmPanel, bpy.types.Panel):
    bl_label = "Bake"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        scene = context.scene
        bake, column = scene.render.bake, self.column()
        if _uses_multires(context):
            column.operator("object.bake_image", icon="RENDER_STILL")
            for name in ("use_multires", "type"):
                column.prop(*_of_multires(scene.render, name))
            return
        column.operator("object.bake", icon="RENDER_STILL").type = scene.rppm.bake_type
        column.prop(*_of_multires(scene.render, "use_multires"))
        column.prop(scene.rppm, "bake_type")
        if scene.rppm.bake_type in _SEEN:
            row = column.row()
            row.prop(bake, "view_from")
            row.active = scene.camera is not None


class RPPM_PT_bake_influence(_BakePanel, bpy.types.Panel):
    bl_label = "Influence"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        scene = context.scene
        has_contents = super().poll(context) and scene.rppm.bake_type in {"NORMAL", "COMBINED", *_LIGHT_BY_LOBES}
        return has_contents and not _uses_multires(context)

    def draw(self, context: bpy.types.Context) -> None:
        bake, kind = context.scene.render.bake, context.scene.rppm.bake_type
        column = self.column()
        if kind == "NORMAL":
            column.prop(bake, "normal_space", text="Space")
            swizzle = column.column(align=True)
            for name, text in (("normal_r", "Swizzle R"), ("normal_g", "G"), ("normal_b", "B")):
                swizzle.prop(bake, name, text=text)
            return
        contents = self.layout.column(heading="Lighting" if kind == "COMBINED" else "Contributions", align=True)
        contents.prop(bake, "use_pass_direct")
        contents.prop(bake, "use_pass_indirect")
        if kind in _LIGHT_BY_LOBES:
            contents.prop(bake, "use_pass_color")
            return
        contents = self.layout.column(heading="Contributions", align=True)
        contents.active = bake.use_pass_direct or bake.use_pass_indirect
        for name in ("diffuse", "glossy", "transmission", "emit"):
            contents.prop(bake, f"use_pass_{name}")


class RPPM_PT_bake_selected_to_active(_BakePanel, bpy.types.Panel):
    bl_label = "Selected to Active"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and not _uses_multires(context)

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render.bake, "use_selected_to_active", text="")

    def draw(self, context: bpy.types.Context) -> None:
        bake, column = context.scene.render.bake, self.column()
        column.active = bake.use_selected_to_active
        column.prop(bake, "use_cage", text="Cage")
        if bake.use_cage:
            column.prop(bake, "cage_object")
        row = column.row()
        row.prop(bake, "cage_extrusion", text="Cage Extrusion" if bake.use_cage else "Extrusion")
        row.active = not bake.use_cage or bake.cage_object is None
        column.prop(bake, "max_ray_distance")


class RPPM_PT_bake_output(_BakePanel, bpy.types.Panel):
    bl_label = "Output"

    def draw(self, context: bpy.types.Context) -> None:
        render, column = context.scene.render, self.column()
        if not _uses_multires(context):
            column.prop(render.bake, "target")
            if render.bake.target == "IMAGE_TEXTURES":
                column.prop(render.bake, "use_clear", text="Clear Image")
            return
        column.prop(*_of_multires(render, "use_clear"), text="Clear Image")
        kind = getattr(*_of_multires(render, "type"))
        if kind.endswith("DISPLACEMENT"):
            column.prop(*_of_multires(render, "use_lores_mesh"))
        if kind == "VECTOR_DISPLACEMENT":
            column.prop(render.bake, "displacement_space", text="Space")


class RPPM_PT_bake_output_margin(RppmPanel, bpy.types.Panel):
    bl_label = "Margin"
    bl_parent_id = "RPPM_PT_bake_output"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.scene.render.bake.target == "IMAGE_TEXTURES"

    def draw(self, context: bpy.types.Context) -> None:
        bake, kind, column = context.scene.render.bake, context.scene.rppm.bake_type, self.column()
        if _uses_multires(context):
            column.prop(*_of_multires(context.scene.render, "margin"), text="Size")
            return
        if not (kind == "UV" or (kind == "NORMAL" and bake.normal_space == "TANGENT")):
            column.prop(bake, "margin_type", text="Type")
        column.prop(bake, "margin", text="Size")


CLASSES = (
    RPPM_PT_bake,
    RPPM_PT_bake_influence,
    RPPM_PT_bake_selected_to_active,
    RPPM_PT_bake_output,
    RPPM_PT_bake_output_margin,
)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Adaptive Subdivision: settings of the scene by which meshes are divided, and the switch of an object.

Blender's own modifier panel shows the switch for Cycles alone.
"""

import bpy

from .. import cycles_properties
from ..base import RppmPanel


class RPPM_PT_subdivision(RppmPanel, bpy.types.Panel):
    bl_label = "Subdivision"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        if not cycles_properties.are_there():
            cycles_properties.draw_remedy(column, "Dicing Rate, Offscreen Scale, Max Subdivisions, Dicing Camera")
            return
        rates = column.column(align=True)
        rates.prop(context.scene.cycles, "dicing_rate", text="Dicing Rate Render")
        rates.prop(context.scene.cycles, "preview_dicing_rate", text="Viewport")
        column.prop(context.scene.cycles, "offscreen_dicing_scale", text="Offscreen Scale")
        column.prop(context.scene.cycles, "max_subdivisions")
        column.prop(context.scene.cycles, "dicing_camera")


class RPPM_PT_adaptive_subdivision(RppmPanel, bpy.types.Panel):
    bl_label = "Adaptive Subdivision"
    bl_options = {"DEFAULT_CLOSED"}
    bl_context = "modifier"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Return True where an object's last modifier divides its surface, which alone can do so adaptively."""
        modifiers = () if context.object is None else context.object.modifiers
        return super().poll(context) and len(modifiers) > 0 and modifiers[-1].type == "SUBSURF"

    def draw_header(self, context: bpy.types.Context) -> None:
        owner = _owner_of_switch(context.object)
        if owner is not None:
            self.layout.prop(owner, "use_adaptive_subdivision", text="")

    def draw(self, context: bpy.types.Context) -> None:
        column, owner = self.column(), _owner_of_switch(context.object)
        if owner is None:
            cycles_properties.draw_remedy(column, "Adaptive Subdivision, Dicing Scale")
            return
        column.active = owner.use_adaptive_subdivision
        if not hasattr(owner, "adaptive_space"):
            column.prop(owner, "dicing_rate", text="Dicing Scale")
            return
        column.prop(owner, "adaptive_space")
        in_pixels = owner.adaptive_space == "PIXEL"
        column.prop(owner, "adaptive_pixel_size" if in_pixels else "adaptive_object_edge_length")


def _owner_of_switch(thing: bpy.types.Object) -> bpy.types.bpy_struct | None:
    """Return the last modifier or, before Blender 5, what Cycles gives the object; None without Cycles."""
    modifier = thing.modifiers[-1]
    return modifier if hasattr(modifier, "use_adaptive_subdivision") else getattr(thing, "cycles", None)


CLASSES = (RPPM_PT_subdivision, RPPM_PT_adaptive_subdivision)

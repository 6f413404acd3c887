# SPDX-License-Identifier: GPL-3.0-or-later
"""How hair curves and particles' hair are rendered, by the properties that Cycles gives scenes."""

import bpy

from ..base import RppmPanel


class RPPM_PT_curves(RppmPanel, bpy.types.Panel):
    bl_label = "Curves"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Where Cycles, whose properties they are, is enabled."""
        return super().poll(context) and hasattr(context.scene, "cycles_curves")

    def draw(self, context: bpy.types.Context) -> None:
        column, settings = self.column(), context.scene.cycles_curves
        column.prop(settings, "shape", text="Shape")
        if settings.shape == "RIBBONS":
            column.prop(settings, "subdivisions", text="Curve Subdivisions")


CLASSES = (RPPM_PT_curves,)

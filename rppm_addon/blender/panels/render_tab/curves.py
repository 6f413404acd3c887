# SPDX-License-Identifier: GPL-3.0-or-later
"""How hair curves and particles' hair are rendered, by the properties that Cycles gives scenes."""

import bpy

from .. import cycles_properties
from ..base import RppmPanel


class RPPM_PT_curves(RppmPanel, bpy.types.Panel):
    bl_label = "Curves"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        if not cycles_properties.are_there():
            cycles_properties.draw_remedy(column, "Shape, Curve Subdivisions")
            return
        settings = context.scene.cycles_curves
        column.prop(settings, "shape", text="Shape")
        if settings.shape == "RIBBONS":
            column.prop(settings, "subdivisions", text="Curve Subdivisions")


CLASSES = (RPPM_PT_curves,)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the view layer tab."""

import bpy

from ...scene.passes import PASSES
from ..export.passes import switch_of
from .base import RppmPanel


class RPPM_PT_passes(RppmPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.view_layer, "use_pass_combined")
        for switch in dict.fromkeys(switch_of(context.view_layer, entry) for entry in PASSES):
            column.prop(*switch)


CLASSES = (RPPM_PT_passes,)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Which passes a view layer has switched on."""

import bpy

from ...scene.passes import PASSES, RenderPass


def switch_of(layer: bpy.types.ViewLayer, entry: RenderPass) -> tuple[bpy.types.bpy_struct | None, str]:
    """What holds the pass's switch, and its name: the view layer, or the add-on's properties of it, which are None
    where the extension is not registered."""
    return (layer, entry.switch) if entry.switch else (getattr(layer, "rppm", None), entry.own_switch)


def passes_of_layer(layer: bpy.types.ViewLayer) -> tuple[RenderPass, ...]:
    """Those that are on, in the table's order."""
    return tuple(entry for entry in PASSES if getattr(*switch_of(layer, entry), False))

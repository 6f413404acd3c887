# SPDX-License-Identifier: GPL-3.0-or-later
"""Adaptive Subdivision: how finely the renderer divides a mesh."""

import bpy

from .....scene.meshes import Dicing

_LEAST = 1e-4


def adaptive_modifier(source: bpy.types.Object, render: bool = True) -> bpy.types.SubsurfModifier | None:
    """By what Cycles would divide an evaluated object as large as it is seen: its last modifier, as a render or else a
    viewport shows it."""
    modifier = source.modifiers[-1] if len(source.modifiers) else None
    if (
        modifier is None
        or modifier.type != "SUBSURF"
        or not (modifier.show_render if render else modifier.show_viewport)
    ):
        return None
    # Before Blender 5 a property of Cycles'.
    owner = modifier if hasattr(modifier, "use_adaptive_subdivision") else getattr(source, "cycles", None)
    return modifier if getattr(owner, "use_adaptive_subdivision", False) else None


def export_dicing(source: bpy.types.Object, modifier: bpy.types.SubsurfModifier, level: int) -> Dicing:
    """Fineness to which the mesh of an evaluated object with an adaptive modifier is divided. level: of the mesh, by
    which Blender has divided it."""
    is_curved = modifier.subdivision_type == "CATMULL_CLARK"
    if not hasattr(modifier, "use_adaptive_subdivision"):
        return Dicing(max(source.cycles.dicing_rate, _LEAST), True, is_curved, level)
    in_pixels = modifier.adaptive_space == "PIXEL"
    length = modifier.adaptive_pixel_size if in_pixels else modifier.adaptive_object_edge_length
    return Dicing(max(length, _LEAST), in_pixels, is_curved, level)

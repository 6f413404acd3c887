# SPDX-License-Identifier: GPL-3.0-or-later
"""Adaptive Subdivision: how finely a mesh is divided once its modifiers have been applied."""

import bpy

from ....scene.meshes import Dicing


def subdivides_adaptively(source: bpy.types.Object) -> bool:
    """Whether Cycles would divide an evaluated object by how large it is seen."""
    modifiers = [modifier for modifier in source.modifiers if modifier.type == "SUBSURF"]
    # Before Blender 5 a property of Cycles'.
    return bool(getattr(getattr(source, "cycles", None), "use_adaptive_subdivision", False) and modifiers) or any(
        getattr(modifier, "use_adaptive_subdivision", False) for modifier in modifiers
    )


def export_dicing(source: bpy.types.Object) -> Dicing | None:
    """None where the mesh of an evaluated object is not divided further."""
    if not subdivides_adaptively(source):
        return None
    modifier = next(modifier for modifier in reversed(source.modifiers) if modifier.type == "SUBSURF")
    is_curved = modifier.subdivision_type == "CATMULL_CLARK"
    if not hasattr(modifier, "use_adaptive_subdivision"):
        return Dicing(max(source.cycles.dicing_rate, _LEAST), True, is_curved)
    in_pixels = modifier.adaptive_space == "PIXEL"
    length = modifier.adaptive_pixel_size if in_pixels else modifier.adaptive_object_edge_length
    return Dicing(max(length, _LEAST), in_pixels, is_curved)


_LEAST = 1e-4

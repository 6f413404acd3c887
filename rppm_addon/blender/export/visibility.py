# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's ray visibility."""

import bpy

from ...scene import RayVisibility


def visibility_of(source: bpy.types.Object) -> RayVisibility:
    """The rays that see an object."""
    return RayVisibility(sum(ray for ray in RayVisibility if getattr(source, f"visible_{ray.name.lower()}")))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that glow as a Raycast node says: a ball over a ground below a slab that leans, all of one material."""

import bmesh
import bpy
import numpy as np

from ..features import stage
from ..net import Net, material
from ..scenes import place

RESOLUTION = 24
TILT, UP = (0.2, 0.1, 2.0), (0.0, 0.0, 1.0)
INCOMING, INSIDE = "incoming", "inside"
"""Away from the viewer, by 1.7 of its length; 0.05 below the surface."""
COLORS = "Colors"
"""An attribute of all corners."""
CASES = {
    "is_hit": {"output": "Is Hit"},
    "self_hit": {"output": "Self Hit", "length": 5.0, "direction": INCOMING},
    "along_the_normal": {"output": "Hit Distance", "length": 3.0, "scale": 0.3},
    "tilted": {"output": "Hit Distance", "length": 3.0, "direction": TILT, "scale": 0.3},
    "through": {"output": "Hit Distance", "length": 5.0, "direction": INCOMING, "position": INSIDE, "scale": 0.3},
    "short": {"output": "Hit Distance", "length": 0.3, "direction": UP},
    "local": {"output": "Hit Distance", "length": 2.0, "direction": UP, "only_local": True, "scale": 0.3},
    "position": {"output": "Hit Position", "length": 5.0, "direction": TILT, "scale": 0.1, "offset": 0.5},
    "normal": {"output": "Hit Normal", "length": 5.0, "direction": INCOMING, "scale": 0.5, "offset": 0.5},
    "color": {"output": COLORS, "length": 5.0, "direction": TILT, "scale": 0.5, "offset": 0.1},
    "alpha": {"output": f"{COLORS} Alpha", "length": 5.0, "direction": TILT, "scale": 0.5, "offset": 0.1},
}


def colors(corners: int) -> np.ndarray:
    """(corners, 4) float32 of a mesh."""
    return np.random.default_rng(corners).random((corners, 4)).astype(np.float32)


def build() -> tuple[bpy.types.Material, Net]:
    """The scene, and the material whose nodes are still to be made."""
    stage.empty()
    surface, net = material()
    stage.set_up(surface)
    mesh = bmesh.new()
    bmesh.ops.create_cube(mesh, size=2.0)
    where = place(at=(0.1, 0.7, 1.6), turn=(-60.0, 0.0, 10.0), scale=(1.2, 0.9, 0.1))
    stage.mesh_object(mesh, "Slab", surface, {"at": (0.0, 0.0, 0.0)}).matrix_world = where
    for thing in bpy.data.objects:
        if thing.type == "MESH":
            attribute = thing.data.attributes.new(COLORS, "FLOAT_COLOR", "CORNER")
            attribute.data.foreach_set("color", colors(len(thing.data.loops)).ravel())
    render = bpy.context.scene.render
    render.resolution_x = render.resolution_y = RESOLUTION
    cycles = bpy.context.scene.cycles
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.01
    return surface, net

# SPDX-License-Identifier: GPL-3.0-or-later
"""Portals in the window of a closed room."""

import bmesh
import bpy

from ...net import Net, diffuse
from ...scenes import background, camera, light, place
from .. import stage
from ..rows import Row, add

GROUP = "Light portals"
SIDE, HEIGHT = 2.0, 2.6
"""Half of the room's width and depth, and its height, meters."""
LEFT, RIGHT, BOTTOM, TOP = -0.6, 0.8, 0.9, 2.0
"""Edges of the window in the wall at X = SIDE."""
ROOM = {"photons": 16384, "photon_path_length": 12}


def _room(surface: bpy.types.Material) -> None:
    s, h = SIDE, HEIGHT
    floor = [(-s, -s), (s, -s), (s, s), (-s, s)]
    quads = [[(x, y, 0) for x, y in floor], [(x, y, h) for x, y in floor]]
    quads += [
        [(*p, 0), (*q, 0), (*q, h), (*p, h)] for p, q in ((floor[0], floor[1]), *zip(floor[2:], [floor[3], floor[0]]))
    ]
    for y0, y1, z0, z1 in ((-s, LEFT, 0, h), (RIGHT, s, 0, h), (LEFT, RIGHT, 0, BOTTOM), (LEFT, RIGHT, TOP, h)):
        quads.append([(s, y0, z0), (s, y1, z0), (s, y1, z1), (s, y0, z1)])
    mesh = bmesh.new()
    for corners in quads:
        mesh.faces.new([mesh.verts.new(corner) for corner in corners])
    stage.mesh_object(mesh, "Room", surface, {"at": (0.0, 0.0, 0.0)})


def _sky() -> None:
    """Blue, with a sun that shines through the window."""
    net = Net(bpy.context.scene.world.node_tree)
    along = net.out("VectorMath", "Value", {0: net.out("TexCoord", "Generated"), 1: (0.8, -0.25, 0.545)},
                    operation="DOT_PRODUCT")  # fmt: skip
    spot = net.out("Math", 0, {0: along, 1: 0.985}, operation="GREATER_THAN")
    net.set(background().inputs["Color"], net.out("MixRGB", 0, {0: spot, 1: (0.5, 0.7, 1.0), 2: (60.0, 50.0, 40.0)}))
    background().inputs["Strength"].default_value = 1.0


def _row(name: str, portals, **members: object) -> None:
    def build() -> None:
        stage.empty()
        plain = diffuse("Plain", (0.6, 0.55, 0.5))
        stage.set_up(plain)
        bpy.data.objects.remove(bpy.data.objects["Ground"])
        bpy.data.objects["Ball"].matrix_world = place(at=(0.7, 0.4, 0.5), scale=(0.55, 0.55, 0.55))
        _room(plain)
        _sky()
        camera((-1.8, -1.7, 1.6), (0.9, 0.5, 0.8), 75.0)
        for where, properties in portals:
            made = light("AREA", 10.0, place(turn=(0.0, 90.0, 0.0), **where), **properties)
            made.data.cycles.is_portal = True

    add(Row(GROUP, name, build, settings=ROOM, **members))


IN_WINDOW = {"at": (SIDE, 0.5 * (LEFT + RIGHT), 0.5 * (BOTTOM + TOP))}
_row("in a window", [(IN_WINDOW, {"shape": "RECTANGLE", "size": TOP - BOTTOM, "size_y": RIGHT - LEFT})], effort=8)
_row("in a part of it", [(IN_WINDOW, {"shape": "ELLIPSE", "size": 0.9, "size_y": 0.8})], effort=8)

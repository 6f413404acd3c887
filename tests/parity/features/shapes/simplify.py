# SPDX-License-Identifier: GPL-3.0-or-later
"""Culling of Simplify: boxes around a mirror, some of which are left out."""

import itertools

import bmesh
import bpy

from ...net import material
from .. import stage
from ..rows import Kind, Row, add


def _box(number: int, place: tuple[float, float, float]) -> bpy.types.Object:
    surface, net = material(f"Glow {number}")
    net.output(net.emission([(1.0, 0.3, 0.2), (0.2, 0.9, 0.4), (0.3, 0.4, 1.0)][number % 3]))
    mesh = bmesh.new()
    bmesh.ops.create_cube(mesh, size=1.2)
    return stage.mesh_object(mesh, f"Box {number}", surface, {"at": place, "turn": (0.0, 0.0, 30.0 * number)})


def _row(name: str, **settings: object) -> None:
    def build() -> None:
        stage.empty()
        mirror, net = material("Mirror")
        net.output(net.out("BsdfAnisotropic", inputs={"Roughness": 0.0, "Color": (1.0, 1.0, 1.0)}))
        stage.set_up(mirror)
        bpy.data.objects.remove(bpy.data.objects["Ground"])
        for number, place in enumerate(itertools.product((-4.0, -1.9, 2.1, 4.0), (-7.0, -3.0, 3.0), (-1.5, 2.5))):
            made = _box(number, place)
            made.cycles.use_camera_cull = number % 4 != 0
            made.cycles.use_distance_cull = number % 5 != 0
        scene = bpy.context.scene
        scene.render.use_simplify = True
        for setting, value in settings.items():
            setattr(scene.cycles, setting, value)

    add(Row("Simplify", name, build, Kind.VALUES, settings={"camera_path_length": 3}))


_row("camera culling", use_camera_cull=True)
_row("camera culling, margin 0.5", use_camera_cull=True, camera_cull_margin=0.5)
_row("distance culling", use_distance_cull=True, distance_cull_margin=4.0)
_row("both", use_camera_cull=True, use_distance_cull=True, distance_cull_margin=4.0)

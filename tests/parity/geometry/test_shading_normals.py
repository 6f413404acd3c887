# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals that lie across their face or behind it, and smooth balls of few faces, against Cycles."""

import math
from collections.abc import Callable

import bpy
import pytest
from mathutils import Vector

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..net import Net
from ..scenes import DIFFUSE, GLASS, GLOSSY, PRINCIPLED, light, material, new_scene, orthographic_camera, place, plane

COLOR = (0.8, 0.6, 0.4)
SIZE = 6
NEAR = Tolerance(mean=0.01, block=0.03, mode=0.01)


def toon(component: str) -> bpy.types.Material:
    made = material("ShaderNodeBsdfToon", Color=COLOR, Size=0.4, Smooth=0.3)
    Net(made.node_tree).find("BSDF_TOON").component = component
    return made


CLOSURES: dict[str, Callable[[], bpy.types.Material]] = {
    "diffuse": lambda: material(DIFFUSE, Color=COLOR, Roughness=0.7),
    "translucent": lambda: material("ShaderNodeBsdfTranslucent", Color=COLOR),
    "glossy": lambda: material(GLOSSY, "GGX", Color=COLOR, Roughness=0.7),
    "principled": lambda: material(PRINCIPLED, Base_Color=COLOR, Roughness=0.6),
    "sheen": lambda: material("ShaderNodeBsdfSheen", Color=COLOR),
    "toon": lambda: toon("DIFFUSE"),
}
ROUND = CLOSURES | {
    "metal": lambda: material(PRINCIPLED, Base_Color=COLOR, Metallic=1.0, Roughness=0.5),
    "glass": lambda: material(GLASS, "GGX", Color=COLOR, Roughness=0.3, IOR=1.45),
    "toon": lambda: toon("GLOSSY"),
}
NORMALS = ((-0.4, False), (0.1, False), (0.4, False), (-0.4, True), (0.1, True), (0.4, True))
"""Angles by which normals lean behind a face that looks at the camera, which sees some from behind."""


def leaf(surface: bpy.types.Material, x: float, z: float, tilt: float, backward: bool) -> None:
    made = plane(0.4, surface, place(at=(x, 0.0, z), turn=(-90.0 if backward else 90.0, 0.0, 0.0)))
    up = Vector((0.0, tilt, 1.0)).normalized()
    local = made.matrix_world.to_3x3().inverted() @ up
    made.data.shade_smooth()
    made.data.normals_split_custom_set([local] * 4)


def ball_of_few_faces(surface: bpy.types.Material, x: float, z: float, subdivisions: int) -> None:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions, radius=0.42, location=(x, 0.0, z))
    made = bpy.context.object
    made.rotation_euler = (0.3, 0.5, 0.1)
    made.data.shade_smooth()
    made.data.materials.append(surface)


def look(scene: bpy.types.Scene, columns: int, rows: int) -> None:
    """A camera that looks along y at a grid of that many things, 16 pixels each."""
    scene.render.resolution_x, scene.render.resolution_y = 16 * columns, 16 * rows
    made = orthographic_camera(max(columns, rows))
    made.location, made.rotation_euler = (0.0, -6.0, 0.0), (math.pi / 2, 0.0, 0.0)


@pytest.mark.parametrize("side", ["front", "behind"])
def test_leaves_with_normals_that_lean(renderer, side):
    scene = new_scene(world=0.2)
    for column, make in enumerate(CLOSURES.values()):
        surface = make()
        for row, (tilt, backward) in enumerate(NORMALS):
            leaf(surface, column - 2.5, row - 2.5, tilt, backward)
    light("SUN", 3.0, place(turn=(50.0 if side == "front" else -50.0, 10.0, 0.0)), angle=0.0)
    look(scene, len(CLOSURES), len(NORMALS))
    compare_with_cycles(renderer, f"leaves_{side}", 512, NEAR, seeds=2, iterations=32, photons=256)


@pytest.mark.long
@pytest.mark.parametrize("subdivisions", [1, 2])
def test_balls_of_few_faces(renderer, subdivisions):
    scene = new_scene(world=1.0)
    for number, make in enumerate(ROUND.values()):
        ball_of_few_faces(make(), number % 4 - 1.5, number // 4 - 0.5, subdivisions)
    light("SUN", 3.0, place(turn=(50.0, 10.0, 0.0)), angle=0.2)
    look(scene, 4, 2)
    compare_with_cycles(renderer, f"balls_{subdivisions}", 1024, NEAR, seeds=2, iterations=96, photons=4096)

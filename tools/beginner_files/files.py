# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of the files, and the startup scene that each of them begins with."""

import math
from collections.abc import Callable
from typing import Any

import bpy
from mathutils import Matrix, Vector

FILES: dict[str, Callable[[], None]] = {}
"""Functions that make each file out of the startup scene, by name."""
ALONE: set[str] = set()
"""Names of files that a process of their own makes, as Blender's module aborts as it goes on to another file."""
SIZE = (64, 48)
"""Pixels of the pictures."""


def file(name: str, make: Callable[[], Any], alone: bool = False) -> None:
    """Put a file on the list. alone: see ALONE."""
    if name in FILES:
        raise ValueError(f"two files are named {name}; give one of them another name")
    FILES[name] = make
    if alone:
        ALONE.add(name)


def start(with_cube: bool = False) -> bpy.types.Scene:
    """Blender's startup scene with a floor, a sky and a camera that is near; the cube stays if asked for."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.25, 0.3, 0.4, 1.0)
    camera = scene.camera
    camera.location = (3.4, -3.2, 2.6)
    aim(camera, (0.0, 0.0, 0.1))
    lamp = bpy.data.objects["Light"]
    lamp.location, lamp.data.energy = (2.0, -1.5, 3.5), 250.0
    bpy.ops.mesh.primitive_plane_add(size=8.0, location=(0.0, 0.0, -1.0))
    floor = bpy.context.object
    floor.name = "Floor"
    floor.data.materials.append(plain((0.5, 0.45, 0.4)))
    cube = bpy.data.objects["Cube"]
    if with_cube:
        select(cube)
    else:
        bpy.data.objects.remove(cube)
    return scene


def aim(thing: bpy.types.Object, at: tuple[float, float, float]) -> None:
    """Turn a camera or a lamp towards a point."""
    thing.rotation_euler = (Vector(at) - thing.location).to_track_quat("-Z", "Y").to_euler()


def select(thing: bpy.types.Object) -> bpy.types.Object:
    """Make an object the only one that is selected, and the active one."""
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    return thing


def plain(color: tuple[float, float, float], **inputs: object) -> bpy.types.Material:
    """A Principled BSDF as it is, of a color; inputs by name with _ for a space."""
    material = bpy.data.materials.new("Material")
    material.use_nodes = True
    principled = material.node_tree.nodes["Principled BSDF"]
    principled.inputs["Base Color"].default_value = (*color, 1.0)
    for name, value in inputs.items():
        principled.inputs[name.replace("_", " ")].default_value = value
    return material


def paint(thing: bpy.types.Object, material: bpy.types.Material | None = None) -> bpy.types.Object:
    """Give an object a material, orange where none is given."""
    thing.data.materials.clear()
    thing.data.materials.append(material or plain((0.8, 0.35, 0.1)))
    return thing


def cube(size: float = 1.6) -> bpy.types.Object:
    """An orange cube, turned a little."""
    bpy.ops.mesh.primitive_cube_add(size=size, rotation=(0.0, 0.0, 0.3))
    return paint(bpy.context.object)


def monkey() -> bpy.types.Object:
    """Suzanne, turned towards the camera."""
    bpy.ops.mesh.primitive_monkey_add(size=2.0, rotation=(0.0, 0.0, math.radians(40.0)))
    return paint(bpy.context.object)


def ball(material: bpy.types.Material | None = None) -> bpy.types.Object:
    """A smooth ball with texture coordinates."""
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1.0)
    bpy.ops.object.shade_smooth()
    return paint(bpy.context.object, material)


def scaled(matrix: tuple[float, float, float]) -> Matrix:
    """The matrix that scales along the axes."""
    return Matrix.Diagonal((*matrix, 1.0))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Additions to the open .blend file of what it lacks to be rendered beside Cycles.

A file without a camera gets one that sees all surfaces, and a sun where it has no lamp. Of a library of materials, a
file whose surfaces use the fewest of what it has, BALLS materials are drawn, always the same, and put on balls above a
floor (tests/parity/material_previews.py).
"""

import random
from pathlib import Path

import bpy
from mathutils import Vector

from tests.parity.material_previews import Preview, build

BALLS = 10
_WITH_SURFACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
_FROM = Vector((0.45, -1.0, 0.55))
"""Towards a camera that is added, from what it looks at."""
_AIR = 1.15
"""How much farther away it is than it must."""


def is_library() -> bool:
    """Whether the open file is there for its materials."""
    materials = [material for material in bpy.data.materials if not material.is_grease_pencil]
    used = {slot.material for part in bpy.context.scene.objects for slot in part.material_slots}
    return bpy.context.scene.camera is None and len(materials) > 4 * max(len(used), 1)


def show_materials(source: Path) -> None:
    """Open a scene of BALLS of the file's materials."""
    names = sorted(material.name for material in bpy.data.materials if not material.is_grease_pencil)
    always_the_same = random.Random(1)  # nosec B311
    chosen = always_the_same.sample(names, min(BALLS, len(names)))
    build([Preview(str(source), name) for name in chosen])


def add_camera(scene: bpy.types.Scene) -> None:
    """A camera that sees all surfaces, and a sun where nothing but the world shines."""
    corners = [
        value
        for part in scene.objects
        if part.type in _WITH_SURFACES
        for corner in part.bound_box
        for value in part.matrix_world @ Vector(corner)
    ]
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.rotation_euler = _FROM.to_track_quat("Z", "Y").to_euler()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    depsgraph.update()
    near, _ = camera.camera_fit_coords(depsgraph, corners)
    middle = sum((Vector(corners[at : at + 3]) for at in range(0, len(corners), 3)), Vector()) / (len(corners) / 3)
    camera.location = middle + (near - middle) * _AIR
    if not any(part.type == "LIGHT" for part in scene.objects):
        sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        sun.data.energy = 3.0
        sun.rotation_euler = (0.6, 0.3, 0.0)
        scene.collection.objects.link(sun)


def stage(source: Path) -> None:
    """Give the open file what it lacks: a camera, light, or balls that show its materials."""
    if is_library():
        show_materials(source)
    elif bpy.context.scene.camera is None:
        add_camera(bpy.context.scene)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's bake operator, as users press it."""

import bpy
import numpy as np


def bake(baked: bpy.types.Object, size: int = 32, others=(), **arguments) -> np.ndarray:
    """(size, size, 4) scene-linear, row 0 at the bottom: what the engine of the scene bakes of an object that has a UV
    map and a material. others: selected as well; arguments: the operator's."""
    image = bpy.data.images.new("Baked", size, size, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    aim_at(baked, image)
    select(baked, others)
    bpy.ops.object.bake(**arguments)
    return np.array(image.pixels, np.float32).reshape(size, size, 4)


def aim_at(baked: bpy.types.Object, image: bpy.types.Image) -> None:
    """Make an image what the object's materials are baked to."""
    for slot in baked.material_slots:
        nodes = slot.material.node_tree.nodes
        node = nodes.get("Baked") or nodes.new("ShaderNodeTexImage")
        node.name, node.image = "Baked", image
        nodes.active = node


def select(baked: bpy.types.Object, others=()) -> None:
    """Select objects, of which one becomes active."""
    bpy.context.view_layer.objects.active = baked
    for other in bpy.context.view_layer.objects:
        other.select_set(other == baked or other in others)


def add_uv_map(baked: bpy.types.Object) -> None:
    """Each face of a mesh over a square of its own, in rows; Blender's new maps have them over each other."""
    mesh = baked.data
    layer, faces = mesh.uv_layers.new(name="UVMap"), len(mesh.polygons)
    columns = int(np.ceil(np.sqrt(faces)))
    for number, face in enumerate(mesh.polygons):
        corner = np.array([number % columns, number // columns])
        for loop, place in zip(face.loop_indices, ((0, 0), (1, 0), (1, 1), (0, 1))):
            layer.uv[loop].vector = (corner + 0.05 + 0.9 * np.array(place)) / columns

# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps that a test can ask of Blender's bake operator."""

import bpy
import numpy as np
from window_steps import counter, override

bakes = {"complete": 0, "cancelled": 0}
SIZE = 32

bpy.app.handlers.object_bake_complete.append(counter(bakes, "complete"))
bpy.app.handlers.object_bake_cancel.append(counter(bakes, "cancelled"))


def bake(at_once: bool = False) -> str:
    """Bake all light of the object with the fewest faces to an image "Baked", as the button does in the background;
    at_once: before the window goes on. Returns the object's name."""
    meshes = [thing for thing in bpy.context.scene.objects if thing.type == "MESH" and thing.material_slots]
    baked = min(meshes, key=lambda thing: len(thing.data.polygons))
    if not baked.data.uv_layers:
        baked.data.uv_layers.new(name="UVMap")
    image = bpy.data.images.get("Baked") or bpy.data.images.new("Baked", SIZE, SIZE, float_buffer=True)
    for slot in baked.material_slots:
        nodes = slot.material.node_tree.nodes
        node = nodes.get("Baked") or nodes.new("ShaderNodeTexImage")
        node.name, node.image, nodes.active = "Baked", image, node
    bpy.context.view_layer.objects.active = baked
    for thing in bpy.context.view_layer.objects:
        thing.select_set(thing == baked)
    with override():
        bpy.ops.object.bake("EXEC_DEFAULT" if at_once else "INVOKE_DEFAULT", type="COMBINED")
    return baked.name


def bake_counts() -> dict[str, int]:
    return bakes


def baking() -> bool:
    return bpy.app.is_job_running("OBJECT_BAKE")


def baked_image() -> list[float]:
    """Red, green, blue of all texels."""
    pixels = np.array(bpy.data.images["Baked"].pixels, np.float32).reshape(-1, 4)
    return pixels[:, :3].ravel().tolist()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials in which all outputs of a shader node are seen, and what of a node a user can change."""

from collections.abc import Iterator

import bpy
import numpy as np
from blender_scenes import add_mesh, new_image
from changes import Change, changes_of
from node_trees import add_node, link, new_material

OF_ALL_NODES = {prop.identifier for prop in bpy.types.ShaderNode.bl_rna.properties}
_PARTS = ("image_user", "texture_mapping", "color_mapping", "color_ramp", "mapping")
"""Structs of nodes that have properties of their own."""


def node_types() -> list[str]:
    """Types of the shader nodes of Blender, but for groups, outputs and what scripts define."""
    left_out = tuple(f"ShaderNode{kind}" for kind in ("Group", "Custom", "Tree", "Output"))
    return [name for name in sorted(dir(bpy.types)) if name.startswith("ShaderNode") and not name.startswith(left_out)]


def shown_node(scene: bpy.types.Scene, kind: str) -> bpy.types.Node | None:
    """A new node whose outputs are all added up to what a quad emits or is made of; None for a base class."""
    material = new_material("Shown")
    tree = material.node_tree
    add_mesh(scene, "Quad", material=material).data.uv_layers.new(name="UVMap")
    try:
        node = tree.nodes.new(kind)
    except RuntimeError:
        return None
    if hasattr(node, "image"):
        node.image = new_image("Picture", np.random.default_rng(0).random((8, 8, 4)))
    target = tree.nodes["Output"].inputs["Volume" if "Volume" in kind else "Surface"]
    for output in node.outputs:
        shader = output if output.type == "SHADER" else add_node(tree, "ShaderNodeEmission", Color=output).outputs[0]
        if target.is_linked:
            both = add_node(tree, "ShaderNodeAddShader")
            link(tree, target.links[0].from_socket, both.inputs[0])
            link(tree, shader, both.inputs[1])
            shader = both.outputs[0]
        link(tree, shader, target)
    _feed(tree, node)
    return node


def _feed(tree: bpy.types.NodeTree, node: bpy.types.Node) -> None:
    """Give what is a table something to be looked up by, and bends and colors to be found in it."""
    if hasattr(node, "color_ramp"):
        node.color_ramp.elements[0].color, node.color_ramp.elements[1].color = (1, 0, 0, 1), (0, 0, 1, 0.5)
    if hasattr(node, "mapping") and hasattr(node.mapping, "curves"):
        node.mapping.curves[0].points[1].location = (0.6, 0.4)
        node.mapping.update()
    elif not (hasattr(node, "color_ramp") and node.inputs):
        return
    coordinates = add_node(tree, "ShaderNodeTexCoord")
    fed = next((socket for socket in node.inputs if "Fac" not in socket.name), node.inputs[0])
    link(tree, coordinates.outputs["Object"], fed)


def contexts_of(node: bpy.types.Node) -> Iterator[tuple[str, str]]:
    """Yield each choice of a node's own, by which other properties and inputs may come to matter."""
    for prop in node.bl_rna.properties:
        if prop.type == "ENUM" and prop.identifier not in OF_ALL_NODES and not prop.is_readonly:
            for item in prop.enum_items:
                yield prop.identifier, item.identifier


def node_changes(node: bpy.types.Node) -> Iterator[Change]:
    """Yield changes of a node: of properties of its own, of the values of its inputs and of its parts.

    Keys have the node's type: ``ShaderNodeTexNoise.normalize``, ``ShaderNodeTexNoise[Scale]``,
    ``ShaderNodeTexNoise.texture_mapping.scale``.
    """
    kind = node.bl_idname
    for change in changes_of(node):
        if change.name not in OF_ALL_NODES:
            yield Change(f"{kind}.{change.name}", node, change.name, change.value)
    for part in _PARTS:
        owner = getattr(node, part, None)
        for change in changes_of(owner) if owner is not None else ():
            yield Change(f"{kind}.{part}.{change.name}", owner, change.name, change.value)
    for socket in node.inputs:
        if socket.enabled and not socket.hide_value and not socket.is_linked and hasattr(socket, "default_value"):
            for change in changes_of(socket):
                if change.name == "default_value":
                    yield Change(f"{kind}[{socket.identifier}]", socket, change.name, change.value)

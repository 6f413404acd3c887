# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees in few words."""

from typing import Any

import bpy


class Graph:
    """A node tree of a kind, whose nodes are made with their settings, values and links at once."""

    def __init__(self, tree: bpy.types.NodeTree, prefix: str = "ShaderNode") -> None:
        self.tree = tree
        self._prefix = prefix

    def node(
        self, kind: str, settings: dict[str, Any] | None = None, inputs: dict[int, Any] | None = None, **named: Any
    ) -> bpy.types.Node:
        """A new node. An input by number or name (_ for a space) gets a value, or a link from a socket or node."""
        made = self.tree.nodes.new(self._prefix + kind)
        for name, value in (settings or {}).items():
            setattr(made, name, value)
        for key, value in {**(inputs or {}), **named}.items():
            socket = made.inputs[key.replace("_", " ") if isinstance(key, str) else key]
            if isinstance(value, bpy.types.Node):
                value = value.outputs[0]
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = value
        return made

    def math(self, operation: str, *operands: Any) -> bpy.types.Node:
        """A Math node with operands that are numbers, sockets or nodes."""
        return self.node("Math", {"operation": operation}, dict(enumerate(operands)))

    def mixed(self, factor: Any, a: Any, b: Any, blend: str = "MIX") -> bpy.types.NodeSocket:
        """The mixture of two colors."""
        settings = {"data_type": "RGBA", "blend_type": blend}
        return self.node("Mix", settings, {0: factor, 6: a, 7: b}).outputs[2]

    def ramp(self, factor: Any, stops: list[tuple[float, tuple[float, ...]]], interpolation: str = "LINEAR") -> Any:
        """A Color Ramp with stops of a position and a color."""
        made = self.node("ValToRGB", None, {0: factor})
        made.color_ramp.interpolation = interpolation
        elements = made.color_ramp.elements
        while len(elements) < len(stops):
            elements.new(0.5)
        for element, (position, color) in zip(elements, stops, strict=True):
            element.position, element.color = position, color
        return made


def material(name: str) -> tuple[bpy.types.Material, Graph]:
    """A material without a shader, and its graph."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.node_tree.nodes.clear()
    return made, Graph(made.node_tree)


def finish(graph: Graph, surface: Any = None, volume: Any = None, displacement: Any = None) -> None:
    """Link shaders to a new Material Output."""
    sockets = {"Surface": surface, "Volume": volume, "Displacement": displacement}
    graph.node("OutputMaterial", **{name: value for name, value in sockets.items() if value is not None})


def geometry_nodes(thing: bpy.types.Object) -> tuple[Graph, bpy.types.Node, bpy.types.Node]:
    """A geometry nodes modifier of an object: its graph, the node of what it is given, and its output."""
    tree = bpy.data.node_groups.new("Geometry Nodes", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    thing.modifiers.new("Geometry Nodes", "NODES").node_group = tree
    return Graph(tree, "GeometryNode"), tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")

# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees in few words."""

from collections.abc import Callable

import bpy


class Net:
    """A node tree under construction."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self.tree = tree

    def node(self, kind: str, /, inputs: dict | None = None, **properties: object) -> bpy.types.Node:
        """A node by its bl_idname without "ShaderNode"; inputs by name, identifier or place: values, sockets, or
        functions of the net that give one of them."""
        given = {name: value(self) if callable(value) else value for name, value in (inputs or {}).items()}
        made = self.tree.nodes.new(f"ShaderNode{kind}")
        for name, value in properties.items():
            setattr(made, name, value)
        for name, value in given.items():
            self.set(_found(made.inputs, name), value)
        return made

    def out(self, kind: str, output: str | int = 0, /, inputs: dict | None = None, **properties: object):
        """An output of a new node."""
        return _found(self.node(kind, inputs, **properties).outputs, output)

    def find(self, kind: str) -> bpy.types.Node:
        """The first node of a type, by Blender's name for it: "EMISSION"."""
        return next(node for node in self.tree.nodes if node.type == kind)

    def set(self, socket: bpy.types.NodeSocket, value: object) -> None:
        """Link an output to an input, or store a value in it."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif socket.type == "RGBA":
            value = (value,) * 3 if isinstance(value, int | float) else tuple(value)
            socket.default_value = (*value, 1.0)[:4]
        else:
            socket.default_value = value

    def scaled(self, value: object, scale: float, offset: float) -> bpy.types.NodeSocket:
        """value * scale + offset, component by component."""
        return self.out("VectorMath", inputs={0: value, 1: (scale,) * 3, 2: (offset,) * 3}, operation="MULTIPLY_ADD")

    def emission(self, color: object, strength: object = 1.0) -> bpy.types.NodeSocket:
        return self.out("Emission", inputs={"Color": color, "Strength": strength})

    def output(self, surface: bpy.types.NodeSocket | None = None, **inputs: bpy.types.NodeSocket) -> None:
        """The Material Output; further inputs by name."""
        sockets = inputs | ({} if surface is None else {"Surface": surface})
        self.node("OutputMaterial", inputs=sockets)


Socket = Callable[[Net], bpy.types.NodeSocket]
"""A function that makes nodes in a net and gives an output of theirs."""


def _found(sockets, name: str | int):
    if isinstance(name, int):
        return sockets[name]
    enabled = [socket for socket in sockets if socket.enabled]
    return next(s for s in (*enabled, *sockets) if name in (s.name, s.identifier))


def socket(kind: str, output: str | int = 0, /, inputs: dict | None = None, **properties: object) -> Socket:
    """An output of a node to come: a function that makes it in a net, as Net.out does."""
    return lambda net: net.out(kind, output, inputs, **properties)


def material(name: str = "Feature") -> tuple[bpy.types.Material, Net]:
    """A material without nodes."""
    made = bpy.data.materials.new(name)
    if made.node_tree is None:
        made.use_nodes = True
    made.node_tree.nodes.clear()
    return made, Net(made.node_tree)


def diffuse(name: str, color: tuple[float, float, float]) -> bpy.types.Material:
    """A diffuse material."""
    made, net = material(name)
    net.output(net.out("BsdfDiffuse", inputs={"Color": color}))
    return made

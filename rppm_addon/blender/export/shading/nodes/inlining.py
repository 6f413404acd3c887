# SPDX-License-Identifier: GPL-3.0-or-later
"""Trees with repeat zones, closures, bundles and menu switches, of which Blender makes plain nodes.

Blender 5 evaluates such nodes itself, for Cycles as for others: what it hands out has neither groups nor reroutes,
zones are unrolled, and numbers that nothing varies are computed. So are trees whose output node is in a group. Trees
without any of these are read as the user built them.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import bpy

from .links import is_lost, node_tree

_READ_HERE = {"NodeReroute", "NodeFrame", "NodeGroupInput", "NodeGroupOutput", "NodeUndefined"}
_NATIVE = ("GeometryNode", "FunctionNode", "Node")
"""Prefixes of nodes that shader trees share with other trees, and add-ons do not use."""
_NUMBERED = re.compile(r"\d+_(.*)", re.DOTALL)
"""Pattern of the name that Blender gives the copy of a node: a number before the name of the node."""


@dataclass(frozen=True)
class ReadableTree:
    """A tree whose nodes can be followed one by one."""

    tree: bpy.types.NodeTree
    owner: "bpy.types.InlineShaderNodes | None" = None
    """Owner of a tree that Blender made; the tree lives as long as its owner."""
    nodes: dict[tuple[str, str], bpy.types.Node] = field(default_factory=dict)
    """By bl_idname and name, the user's nodes of which Blender made that tree, those in groups included."""

    @property
    def output(self) -> bpy.types.Node | None:
        """The output node for Cycles."""
        return self.tree.get_output_node("CYCLES") or self.tree.get_output_node("ALL")

    @property
    def lost_groups(self) -> list[bpy.types.Node]:
        """The user's groups whose node tree is not there; Blender cuts their links, and its own tree has none."""
        return [node for node in self.nodes.values() or self.tree.nodes if is_lost(node)]

    def user_node(self, node: bpy.types.Node) -> bpy.types.Node:
        """The node that the user sees, of a node of this tree."""
        if not self.nodes:
            return node
        numbered = _NUMBERED.fullmatch(node.name)
        return self.nodes.get((node.bl_idname, numbered[1] if numbered else node.name), node)


def readable_tree(owner: bpy.types.Material | bpy.types.World | bpy.types.Light) -> ReadableTree | None:
    """The node tree that makes a material, world or light, None where plain properties do."""
    tree = node_tree(owner)
    if tree is None:
        return None
    plain = ReadableTree(tree)
    blender = getattr(bpy.types, "InlineShaderNodes", None)  # none before Blender 5, as are such nodes
    if blender is None or (plain.output and not any(_needs_blender(node) for node in _all_nodes(tree, set()))):
        return plain
    if isinstance(owner, bpy.types.Material):
        inlined = blender.from_material(owner)
    elif isinstance(owner, bpy.types.World):
        inlined = blender.from_world(owner)
    else:
        inlined = blender.from_light(owner)
    nodes = {(node.bl_idname, node.name): node for node in reversed(list(_all_nodes(tree, set())))}
    found = ReadableTree(inlined.node_tree, inlined, nodes)
    # Where links run in a circle Blender makes nothing of a tree: then the rest is rendered and such nodes are named.
    return found if found.output is not None or plain.output is None else plain


def _needs_blender(node: bpy.types.Node) -> bool:
    return node.bl_idname.startswith(_NATIVE) and node.bl_idname not in _READ_HERE


def _all_nodes(tree: bpy.types.NodeTree, passed: set[int]) -> Iterator[bpy.types.Node]:
    """The nodes of a tree and, once each, of its groups."""
    passed.add(tree.as_pointer())
    for node in tree.nodes:
        yield node
        inside = node.node_tree if node.type in {"GROUP", "CUSTOM GROUP"} else None
        if inside is not None and inside.as_pointer() not in passed:
            yield from _all_nodes(inside, passed)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Following links of a node tree through reroutes, muted nodes and groups."""

from dataclasses import dataclass

import bpy

Path = tuple[bpy.types.Node, ...]
"""The group nodes that were entered on the way to a node, outermost first."""


@dataclass(frozen=True)
class Source:
    """The output that feeds an input, and the groups it lies in."""

    node: bpy.types.Node
    output: bpy.types.NodeSocket
    path: Path


@dataclass(frozen=True)
class Unlinked:
    """Nothing feeds an input: the socket whose own value counts."""

    socket: bpy.types.NodeSocket
    broken: bpy.types.Node | None = None
    """A group without a node tree that should have fed it."""


def node_tree(owner: bpy.types.Material | bpy.types.World) -> bpy.types.NodeTree | None:
    """The node tree that makes a material or world, None where plain properties do."""
    # From 5.0 on there is always one, and asking for use_nodes is deprecated.
    if bpy.app.version < (5, 0) and not owner.use_nodes:
        return None
    return owner.node_tree


class LinkTable:
    """The links of node trees by the inputs that they lead to, while none is changed: Blender's own list of a socket's
    links looks at all links of the tree each time."""

    def __init__(self) -> None:
        self._trees: dict[int, dict[int, bpy.types.NodeLink]] = {}

    def into(self, socket: bpy.types.NodeSocket) -> bpy.types.NodeLink | None:
        """The link that feeds an input, None where none does."""
        tree = socket.id_data
        links = self._trees.get(tree.as_pointer())
        if links is None:
            links = self._trees[tree.as_pointer()] = {}
            usable = (link for link in tree.links if link.is_valid and not link.is_muted)
            for link in sorted(usable, key=lambda link: getattr(link, "multi_input_sort_id", 0)):
                links[link.to_socket.as_pointer()] = link  # of several the last
        return links.get(socket.as_pointer())


def find_source(socket: bpy.types.NodeSocket, path: Path, links: LinkTable) -> Source | Unlinked:
    """Return the source of an input socket of a node that lies in the groups of ``path``."""
    start = socket
    passed: set[tuple[int, Path]] = set()
    while True:
        place = (socket.as_pointer(), path)
        if place in passed:
            return Unlinked(start)  # links in a circle, without a node that could give a value
        passed.add(place)
        link = links.into(socket)
        if link is None:
            # A reroute and a muted node have no value that the user sees: the reader's own counts.
            return Unlinked(start if socket.node.type == "REROUTE" else socket)
        node, output = link.from_node, link.from_socket
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            inner = next((inner for inner in node.internal_links if inner.to_socket == output), None)
            if inner is None:
                return Unlinked(start)
            socket = inner.from_socket
        elif node.type == "GROUP_INPUT" and path:
            outer = next((outer for outer in path[-1].inputs if outer.identifier == output.identifier), None)
            if outer is None:
                return Unlinked(start)
            socket, path = outer, path[:-1]
            start = socket
        elif node.type in {"GROUP", "CUSTOM GROUP"}:
            inside = _group_output(node, output)
            if inside is None:
                return Unlinked(start, node if is_lost(node) else None)
            socket, path = inside, (*path, node)
            start = socket
        else:
            return Source(node, output, path)


def is_lost(node: bpy.types.Node) -> bool:
    """Whether a node is a group whose node tree is not there, as when the file that it was linked from is gone."""
    if node.type not in {"GROUP", "CUSTOM GROUP"}:
        return False
    # Evaluated copies do not say so themselves.
    return node.node_tree is None or node.node_tree.original.is_missing


def _group_output(group: bpy.types.Node, output: bpy.types.NodeSocket) -> bpy.types.NodeSocket | None:
    if group.node_tree is None:
        return None
    for node in group.node_tree.nodes:
        if node.type == "GROUP_OUTPUT" and node.is_active_output:
            return next((socket for socket in node.inputs if socket.identifier == output.identifier), None)
    return None

# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs of a single node, and chains of nodes."""

from rppm_addon.materials.nodes import KINDS
from rppm_addon.scene import Link, NodeGraph


def surface_graph(kind: str, **inputs: object) -> NodeGraph:
    """A graph whose surface is the first output of one node."""
    graph = NodeGraph()
    graph.surface = graph.add(kind, next(iter(KINDS[kind].outputs)), **inputs)
    return graph


def chain(graph: NodeGraph, count: int) -> Link:
    """The value at the end of so many Math nodes that follow a texture's coordinates."""
    value = graph.add("tex_coord", "uv")
    for _ in range(count):
        value = graph.add("math", "value", value=value)
    return value

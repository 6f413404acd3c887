# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs of a single node or two, and chains of nodes."""

from rppm_addon.materials.nodes import KINDS
from rppm_addon.scene import Link, Material, NodeGraph


def surface_graph(kind: str, **inputs: object) -> NodeGraph:
    """A graph whose surface is the first output of one node."""
    graph = NodeGraph()
    graph.surface = graph.add(kind, next(iter(KINDS[kind].outputs)), **inputs)
    return graph


def diffuse_by_node(kind: str, output: str, **members: object) -> Material:
    """A diffuse material of the color that a node gives. members: as NodeGraph.add takes them."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=graph.add(kind, output, **members))
    return Material(kind, graph)


def chain(graph: NodeGraph, count: int) -> Link:
    """The value at the end of so many Math nodes that follow a texture's coordinates."""
    value = graph.add("tex_coord", "uv")
    for _ in range(count):
        value = graph.add("math", "value", value=value)
    return value

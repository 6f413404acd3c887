# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials whose color is that of a node."""

from rppm_addon.scene import Material, NodeGraph


def diffuse_by_node(kind: str, output: str, **members: object) -> Material:
    """A diffuse surface of the color that a node gives. members: as NodeGraph.add takes them."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=graph.add(kind, output, **members))
    return Material(kind, graph)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs that depend on how often lobes of each type have scattered a path."""

from ...scene.node_graphs import Link, NodeGraph
from .emitted import reachable

_OUTPUTS = ("diffuse_depth", "glossy_depth", "transmission_depth")


def asks_for_bounces_by_type(graph: NodeGraph) -> bool:
    """Whether a depth of a type, of the Light Path node, has a part in the surface."""
    inputs = (value for index in reachable(graph, graph.surface) for value in graph.nodes[index].inputs.values())
    links = (value for value in inputs if isinstance(value, Link))
    return any(link.output in _OUTPUTS and graph.nodes[link.node].kind == "light_path" for link in links)

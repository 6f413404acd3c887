# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs that reflect by the model of Ashikhmin and Shirley."""

from ...scene.node_graphs import NodeGraph
from ..nodes.shaders import ASHIKHMIN_SHIRLEY


def has_ashikhmin(graph: NodeGraph) -> bool:
    """Whether any of its nodes is a glossy surface with that distribution."""
    return any(node.options.get("distribution") == ASHIKHMIN_SHIRLEY for node in graph.nodes)

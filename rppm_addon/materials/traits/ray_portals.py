# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs with ray portals."""

from ...scene.node_graphs import NodeGraph
from .emitted import reachable

_RAY_PORTAL = "bsdf_ray_portal"


def has_ray_portals(graph: NodeGraph) -> bool:
    """True where paths that come to a surface may go on elsewhere."""
    if not any(node.kind == _RAY_PORTAL for node in graph.nodes):
        return False
    return any(graph.nodes[index].kind == _RAY_PORTAL for index in reachable(graph, graph.surface))

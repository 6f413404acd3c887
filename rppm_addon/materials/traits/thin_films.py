# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs with thin films on microfacets."""

from ...scene.node_graphs import NodeGraph
from .emitted import is_positive


def has_thin_film(graph: NodeGraph) -> bool:
    """Return True where any of its nodes may have a film."""
    return any(
        "thin_film_thickness" in node.inputs and is_positive(node, "thin_film_thickness") for node in graph.nodes
    )

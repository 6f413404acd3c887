# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs that request rays."""

from ...scene.node_graphs import NodeGraph
from ..nodes import KINDS

RAYCAST = "raycast"
"""The kind whose rays begin anywhere."""


def traces_rays(graph: NodeGraph) -> bool:
    """Whether any of its nodes depends on what rays find around a place, such as Ambient Occlusion and Bevel."""
    return any(node.kind in KINDS and KINDS[node.kind].traces_rays for node in graph.nodes)


def casts_rays(graph: NodeGraph) -> bool:
    """Whether any of its nodes sends a ray from anywhere, as Raycast does."""
    return any(node.kind == RAYCAST for node in graph.nodes)

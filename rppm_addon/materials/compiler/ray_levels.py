# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of the rays that nodes request: rays of a level depend on what those of the levels before found."""

import numpy as np

from ...scene.node_graphs import Link, NodeGraph
from ..nodes import KINDS
from ..traits.node_rays import RAYCAST
from .compiled_graph import MAX_NODE_RAYS, NodeRayCounts
from .graph_constants import finite


class RayLevels:
    """Places and levels of the rays of a graph's nodes, and their ``counts`` so far."""

    def __init__(self, graph: NodeGraph) -> None:
        self._graph = graph
        self._depths: list[int] = []
        """Number of nodes that trace rays on the longest way to a node, itself included, by node."""
        for index, node in enumerate(graph.nodes):
            links = [link.node for link in node.inputs.values() if isinstance(link, Link)]
            below = max((self._depths[link] for link in links if 0 <= link < index), default=0)
            self._depths.append(below + (node.kind in KINDS and KINDS[node.kind].traces_rays))
        self.counts = NodeRayCounts()

    @property
    def of_normal(self) -> int:
        """First level of the rays of nodes that read the normal, which follow the rays of the normal itself."""
        normal = self._graph.normal
        return 0 if normal is None or not 0 <= normal.node < len(self._depths) else self._depths[normal.node]

    def arguments(self, index: int, first_level: int) -> list[str]:
        """Return GLSL for the first place of what the rays of a node find, and for their level."""
        place, level = self.counts.places, first_level + self._depths[index] - 1
        node = self._graph.nodes[index]
        kind, count = KINDS[node.kind], 1
        if "samples" in kind.inputs:
            samples = node.inputs.get("samples", kind.inputs["samples"][1])
            count = MAX_NODE_RAYS  # the number that another node gives is clamped to that
            if isinstance(samples, int | float):
                count = int(np.clip(finite(samples), 1, MAX_NODE_RAYS))
        self.counts = NodeRayCounts(
            place + kind.ray_places,
            max(self.counts.levels, level + 1),
            max(self.counts.samples, count),
            self.counts.casts or node.kind == RAYCAST,
        )
        return [f"{place}u", f"{level}u"]

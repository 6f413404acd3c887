# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs that scatter as fibers do."""

from ...scene.node_graphs import NodeGraph
from .. import hair_energy as hair_energy
from ..nodes.hair import KINDS


def has_hair(graph: NodeGraph) -> bool:
    """Whether any of its nodes is a shader of fibers."""
    return any(node.kind in KINDS for node in graph.nodes)

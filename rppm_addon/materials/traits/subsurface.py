# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs with subsurface scattering."""

from ...gl.buffers.constants import Constants
from ...scene.node_graphs import NodeGraph, ShaderNode
from ..nodes.shaders import SUBSURFACE_METHODS
from .emitted import is_positive, reachable

Constants("SubsurfaceMethods", SUBSURFACE=SUBSURFACE_METHODS)


def has_subsurface(graph: NodeGraph) -> bool:
    """Whether light may go into a surface at one place and come out at another."""
    if not any(_scatters(node) for node in graph.nodes):
        return False
    return any(_scatters(graph.nodes[index]) for index in reachable(graph, graph.surface))


def _scatters(node: ShaderNode) -> bool:
    if node.kind == "bsdf_principled":
        return is_positive(node, "subsurface_weight") and not node.options.get("thin_wall", False)
    return node.kind == "subsurface_scattering"

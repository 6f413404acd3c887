# SPDX-License-Identifier: GPL-3.0-or-later
"""Transparency of node graphs, and whether shadow rays or photons bring the light behind."""

from ...scene.node_graphs import Link, NodeGraph, ShaderNode
from .emitted import is_positive, reachable


def passes_shadow_rays(graph: NodeGraph) -> bool:
    """True where shadow rays may pass a surface, as far as the graph's structure and constants show.

    Glass that is transparent to shadow rays, the usual trick against black shadows, stops them: photons refract its
    light, which would be there twice.
    """
    nodes = [graph.nodes[index] for index in reachable(graph, graph.surface)]
    return any(map(_is_transparent, nodes)) and not (_distinguishes_shadow_rays(graph) and any(map(_refracts, nodes)))


def asks_for_shadow_rays(graph: NodeGraph) -> bool:
    """True where what passes a surface depends on whether a shadow ray comes to it."""
    return passes_shadow_rays(graph) and _distinguishes_shadow_rays(graph)


def _distinguishes_shadow_rays(graph: NodeGraph) -> bool:
    links = (value for index in reachable(graph, graph.surface) for value in graph.nodes[index].inputs.values())
    return any(
        isinstance(link, Link)
        and link.output == "is_shadow_ray"
        and 0 <= link.node < len(graph.nodes)
        and graph.nodes[link.node].kind == "light_path"
        for link in links
    )


def _is_transparent(node: ShaderNode) -> bool:
    if node.kind == "bsdf_principled":
        return node.inputs.get("alpha", 1.0) != 1.0 or bool(node.options.get("thin_wall"))
    if node.kind == "plain_surface":
        return node.inputs.get("transparent") != 0.0
    return node.kind in ("bsdf_transparent", "volume_boundary")


def _refracts(node: ShaderNode) -> bool:
    if node.kind == "bsdf_principled":
        return is_positive(node, "transmission_weight")
    return node.kind in ("bsdf_glass", "bsdf_refraction")

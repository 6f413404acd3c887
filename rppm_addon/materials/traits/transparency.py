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


def bounds_volume_alone(graph: NodeGraph) -> bool:
    """True for a surface without a shader, around a volume."""
    root = graph.surface
    return root is not None and 0 <= root.node < len(graph.nodes) and graph.nodes[root.node].kind == "volume_boundary"


def asks_for_shadow_rays(graph: NodeGraph) -> bool:
    """True where what passes a surface depends on whether a shadow ray comes to it."""
    return passes_shadow_rays(graph) and _distinguishes_shadow_rays(graph)


def stops_shadow_rays_as_glass(graph: NodeGraph) -> bool:
    """True where glass that lets shadow rays pass stops them all the same (passes_shadow_rays)."""
    nodes = [graph.nodes[index] for index in reachable(graph, graph.surface)]
    return _distinguishes_shadow_rays(graph) and any(map(_is_transparent, nodes)) and any(map(_refracts, nodes))


def passes_by_ray_length(graph: NodeGraph) -> bool:
    """True where what passes a surface may depend on the length of the ray that comes to it."""
    return passes_shadow_rays(graph) and _reads_light_path(graph, "ray_length")


def scatters_by_ray_length(graph: NodeGraph) -> bool:
    """True where what a surface scatters may depend on the length of the ray that comes to it."""
    kinds = {graph.nodes[index].kind for index in reachable(graph, graph.surface)}
    scatters = any(kind.startswith("bsdf_") and kind != "bsdf_transparent" for kind in kinds)
    return scatters and _reads_light_path(graph, "ray_length")


def _distinguishes_shadow_rays(graph: NodeGraph) -> bool:
    return _reads_light_path(graph, "is_shadow_ray")


def _reads_light_path(graph: NodeGraph, output: str) -> bool:
    links = (value for index in reachable(graph, graph.surface) for value in graph.nodes[index].inputs.values())
    return any(
        isinstance(link, Link)
        and link.output == output
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

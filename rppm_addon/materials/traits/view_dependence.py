# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs whose lobe weights depend on the direction of view."""

from ...scene.node_graphs import Link, NodeGraph, ShaderNode
from .emitted import is_positive, reachable

_SHADERS = {"bsdf_principled", "bsdf_sheen", "subsurface_scattering", "bsdf_hair", "bsdf_hair_principled"}
"""Layers hide what lies below them by the viewer's angle, and sheen is a fit for one. What goes below a surface is seen
where it comes out, and fibers are met where the viewer sees them."""

_OUTPUTS = {
    ("fresnel", "fac"),
    ("layer_weight", "fresnel"),
    ("layer_weight", "facing"),
    ("new_geometry", "incoming"),
    ("new_geometry", "backfacing"),
    ("tex_coord", "reflection"),
}
"""Kinds of nodes with outputs that depend on the viewer."""


def depends_on_view(graph: NodeGraph) -> bool:
    """Whether light may go from one direction to another by another fraction than the other way round."""
    nodes = [graph.nodes[index] for index in reachable(graph, graph.surface)]
    links = [value for node in nodes for value in node.inputs.values() if isinstance(value, Link)]
    return any(_is_seen_from_a_side(node) for node in nodes) or any(
        (graph.nodes[link.node].kind, link.output) in _OUTPUTS for link in links
    )


def _is_seen_from_a_side(node: ShaderNode) -> bool:
    # The energy that rough microfacets lose is given back by the viewer's angle.
    restored = node.options.get("distribution") == "MULTI_GGX" and is_positive(node, "roughness")
    coated = "thin_film_thickness" in node.inputs and is_positive(node, "thin_film_thickness")
    return node.kind in _SHADERS or restored or coated

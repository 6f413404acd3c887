# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender materials to node graphs."""

import bpy

from .....materials.traits.transparency import (
    passes_by_ray_length,
    scatters_by_ray_length,
    stops_shadow_rays_as_glass,
)
from .....scene import Material, NodeGraph
from ...context import ExportContext
from . import surface_nodes, value_nodes, volume_nodes  # noqa: F401  register their handlers
from .graphs import GraphExporter
from .inlining import readable_tree
from .material_outputs import export_aovs, export_displacement, export_volume


def plain_surface(color: tuple[float, float, float]) -> NodeGraph:
    """A diffuse surface."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=color)
    return graph


def export_material(material: bpy.types.Material, context: ExportContext) -> Material:
    """The surface and the interior of a material; what has no counterpart is reported and left out."""
    tree = readable_tree(material)
    if tree is None:
        return Material(material.name, plain_surface(tuple(material.diffuse_color[:3])), pass_index=material.pass_index)
    owner = f'Material "{material.name}"'
    output = tree.output
    if output is None or output.type != "OUTPUT_MATERIAL":  # such as that of a world, which scripts may add
        context.report.warn(f"{owner}: it has no Material Output node and is black")
        return Material(material.name, pass_index=material.pass_index)
    exporter = GraphExporter(owner, context, tree, material.pass_index)
    graph = exporter.graph
    if exporter.is_linked(output.inputs["Displacement"], ()):
        export_displacement(exporter, material, output)
    graph.surface = exporter.surface()
    graph.aovs = export_aovs(exporter, tree.tree)
    _warn_of_light_paths(owner, graph, context)
    shadow = getattr(material, "use_transparent_shadow", True)
    exported = Material(material.name, graph, transparent_shadow=shadow, pass_index=material.pass_index)
    exported.corrects_bump = getattr(getattr(material, "cycles", None), "use_bump_map_correction", True)
    if hasattr(material, "rppm") and material.rppm.use_dispersion:
        exported.abbe_number = material.rppm.abbe_number
    if exporter.is_linked(output.inputs["Volume"], ()):
        exported.interior = export_volume(owner, context, tree, material.pass_index)
        if getattr(getattr(material, "cycles", None), "volume_interpolation", "LINEAR") == "CUBIC":
            context.report.warn(f"{owner}: it has the volume interpolation Cubic; voxels are interpolated linearly")
        if not exporter.is_linked(output.inputs["Surface"], ()):
            graph.surface = graph.add("volume_boundary", "bsdf")
    return exported


def _warn_of_light_paths(owner: str, graph: NodeGraph, context: ExportContext) -> None:
    """Report uses of the Light Path node that give another picture than in Cycles."""
    if stops_shadow_rays_as_glass(graph):
        context.report.warn(
            f"{owner}: its glass lets shadow rays pass (Is Shadow Ray); it makes shadows and caustics all the same"
        )
    if passes_by_ray_length(graph):
        context.report.warn(
            f"{owner}: it lets light pass by Ray Length, which photons measure from where they come from; light behind "
            "it may differ"
        )
    elif scatters_by_ray_length(graph):
        context.report.warn(
            f"{owner}: it scatters light by Ray Length, which photons measure from where they come from; the light "
            "that it sends to other surfaces may differ"
        )

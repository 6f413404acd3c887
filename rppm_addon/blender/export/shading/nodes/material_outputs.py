# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs of a material's tree beside its surface: displacement, passes of AOV nodes, and the volume."""

from collections.abc import Iterator

import bpy

from .....scene import AovOutput, Link, NodeGraph
from .....scene.meshes import UNDISPLACED
from ...context import ExportContext
from ...geometry.meshes.attributes import NO_ATTRIBUTE
from .graphs import GraphExporter
from .inlining import ReadableTree
from .links import Path


def export_displacement(exporter: GraphExporter, material: bpy.types.Material, output: bpy.types.Node) -> None:
    """Set the displacement of vertices and the bump by its height, as the material's displacement method asks."""
    graph = exporter.graph
    displacement = exporter.value(output.inputs["Displacement"], ())
    if material.displacement_method != "BUMP":
        if not isinstance(displacement, Link):  # the same everywhere
            options = {"space": "WORLD"}
            displacement = graph.add(
                "vector_displacement", "displacement", options=options, attribute=NO_ATTRIBUTE, vector=displacement
            )
        graph.displacement = displacement
    if material.displacement_method != "DISPLACEMENT":
        height = graph.add("displacement_height", "height", displacement=displacement)
        attribute = UNDISPLACED if material.displacement_method == "BOTH" else ""
        graph.normal = graph.add("bump", "normal", name=output.name, attribute=attribute, height=height)


def export_aovs(exporter: GraphExporter, tree: bpy.types.NodeTree) -> list[AovOutput]:
    """The values that AOV Output nodes write to passes."""
    return [
        AovOutput(name, *(exporter.value(node.inputs[socket], path) for socket in ("Color", "Value")))
        for node, path, name in _aov_outputs(tree, ())
    ]


def _aov_outputs(tree: bpy.types.NodeTree, path: Path) -> Iterator[tuple[bpy.types.Node, Path, str]]:
    """AOV Output nodes with the groups that they lie in and the names of their passes."""
    for node in tree.nodes:
        if node.mute:
            continue
        if node.type == "OUTPUT_AOV" and node.aov_name:
            yield node, path, node.aov_name
        elif node.type == "GROUP" and node.node_tree is not None:
            yield from _aov_outputs(node.node_tree, (*path, node))


def export_volume(owner: str, context: ExportContext, tree: ReadableTree, pass_index: int = 0) -> NodeGraph:
    """The graph of a volume: of a material, whose surface encloses it, or of a world."""
    exporter = GraphExporter(owner, context, tree, pass_index, is_volume=True)
    exporter.graph.surface = exporter.shader(tree.output.inputs["Volume"], Path())
    return exporter.graph

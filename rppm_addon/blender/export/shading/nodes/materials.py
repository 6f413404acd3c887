# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender materials to node graphs."""

import dataclasses
from collections.abc import Iterator

import bpy

from .....materials.nodes.geometry import CAST_ATTRIBUTE
from .....scene import AovOutput, Link, Material, NodeGraph
from .....scene.cryptomatte import DEFAULT_MATERIAL
from .....scene.meshes import SMOOTH_NORMALS, UNDISPLACED
from ...context import ExportContext
from ...geometry.meshes.attributes import NO_ATTRIBUTE
from . import surface_nodes, value_nodes  # noqa: F401  register their handlers
from .graphs import GraphExporter
from .inlining import ReadableTree, readable_tree
from .links import Path


class MaterialTable:
    """The materials of a scene under export, each exported once and as long as it does not change."""

    def __init__(self, context: ExportContext) -> None:
        self.materials: list[Material] = []
        self.attributes: list[dict[str, str]] = []
        """Attributes that the nodes of each material read, each with the name of a node that reads it."""
        self.sampled: frozenset[str] = frozenset()
        """Attributes that rays of nodes read wherever they hit, so that all meshes are asked for them."""
        self._context = context
        self._places: dict[int, int] = {}
        self._on_round_shapes: set[int] = set()
        """Places of those that are on strands or points."""
        self.untracked: set[int] = set()
        """session_uid of those that rest on what changes without the depsgraph telling."""

    def index(self, material: bpy.types.Material | None) -> int:
        """Index of a material, exported now if it is new; None is what Cycles gives faces without one."""
        # Blender gives evaluated copies no session_uid.
        key = 0 if material is None else material.original.session_uid
        if key not in self._places:
            exported = self._export(key, material)
            self._places[key] = len(self.materials)
            self.materials.append(exported)
            self.attributes.append(_attributes_of(exported))
            self.sampled |= _sampled_of(exported)
        return self._places[key]

    def put_on_round_shapes(self, places: list[int]) -> None:
        """Materials are on strands or points as well."""
        for place in set(places) - self._on_round_shapes:
            self._on_round_shapes.add(place)
            self.materials[place] = dataclasses.replace(self.materials[place], on_round_shapes=True)

    def renew(self, material: bpy.types.Material) -> bool:
        """Export a material that has changed again, if it is in use. Returns whether meshes need other attributes."""
        key = material.original.session_uid
        if key not in self._places:
            return False
        exported, place = self._export(key, material), self._places[key]
        exported.on_round_shapes = place in self._on_round_shapes
        before = self.attributes[place], self.sampled
        self.materials[place], self.attributes[place] = exported, _attributes_of(exported)
        self.sampled |= _sampled_of(exported)
        return (self.attributes[place], self.sampled) != before

    def _export(self, key: int, material: bpy.types.Material | None) -> Material:
        reads = self._context.untracked_reads
        with self._context.report.about(("material", key)):
            if material is None:
                exported = Material(DEFAULT_MATERIAL, default_surface())
            else:
                exported = export_material(material, self._context)
        (self.untracked.add if self._context.untracked_reads > reads else self.untracked.discard)(key)
        return exported


def _attributes_of(material: Material) -> dict[str, str]:
    nodes = [node for node in material.graph.nodes if node.kind != CAST_ATTRIBUTE]
    asked = {node.attribute: node.name for node in nodes if node.attribute not in {"", NO_ATTRIBUTE, UNDISPLACED}}
    return asked if material.graph.displacement is None else {**asked, SMOOTH_NORMALS: ""}


def _sampled_of(material: Material) -> set[str]:
    return {node.attribute for node in material.graph.nodes if node.kind == CAST_ATTRIBUTE}


def default_surface() -> NodeGraph:
    """A Principled surface whose sockets are untouched."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_principled", "bsdf", options={"distribution": "MULTI_GGX"})
    return graph


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
    if output is None:
        context.report.warn(f"{owner}: it has no Material Output node and is black")
        return Material(material.name, pass_index=material.pass_index)
    exporter = GraphExporter(owner, context, tree, material.pass_index)
    graph = exporter.graph
    if exporter.is_linked(output.inputs["Displacement"], ()):
        _displace(exporter, material, output)
    graph.surface = exporter.surface()
    graph.aovs = [
        AovOutput(name, *(exporter.value(node.inputs[socket], path) for socket in ("Color", "Value")))
        for node, path, name in _aov_outputs(tree.tree, ())
    ]
    shadow = getattr(material, "use_transparent_shadow", True)
    exported = Material(material.name, graph, transparent_shadow=shadow, pass_index=material.pass_index)
    if hasattr(material, "rppm") and material.rppm.use_dispersion:
        exported.abbe_number = material.rppm.abbe_number
    if exporter.is_linked(output.inputs["Volume"], ()):
        exported.interior = _interior(owner, context, tree)
        if not exporter.is_linked(output.inputs["Surface"], ()):
            # Only an interior: the boundary itself is not there.
            graph.surface = graph.add("bsdf_transparent", "bsdf")
    return exported


def _aov_outputs(tree: bpy.types.NodeTree, path: Path) -> Iterator[tuple[bpy.types.Node, Path, str]]:
    """AOV Output nodes with the groups that they lie in and the names of their passes."""
    for node in tree.nodes:
        if node.mute:
            continue
        if node.type == "OUTPUT_AOV" and node.aov_name:
            yield node, path, node.aov_name
        elif node.type == "GROUP" and node.node_tree is not None:
            yield from _aov_outputs(node.node_tree, (*path, node))


def _displace(exporter: GraphExporter, material: bpy.types.Material, output: bpy.types.Node) -> None:
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


def _interior(owner: str, context: ExportContext, tree: ReadableTree) -> NodeGraph:
    exporter = GraphExporter(owner, context, tree)
    exporter.graph.surface = exporter.shader(tree.output.inputs["Volume"], Path())
    return exporter.graph

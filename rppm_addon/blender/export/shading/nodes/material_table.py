# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of a scene's materials, each exported once."""

import dataclasses

import bpy

from .....materials.nodes.geometry import CAST_ATTRIBUTE
from .....scene import Material, NodeGraph
from .....scene.cryptomatte import DEFAULT_MATERIAL
from .....scene.meshes import SMOOTH_NORMALS, UNDISPLACED
from ...context import ExportContext
from ...geometry.meshes.attributes import NO_ATTRIBUTE
from .materials import export_material

_NO_MATERIAL = 0
"""Stands for the session_uid of a material where there is none."""
_DEFAULT_VOLUME = -1
"""Stands for the place of the material that volume objects have where there is none."""


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
        self._of_volumes: dict[int, int] = {}
        """Places of materials as they are on volumes, by those of the materials, or _DEFAULT_VOLUME."""
        self._on_round_shapes: set[int] = set()
        """Places of those that are on strands or points."""
        self.untracked: set[int] = set()
        """session_uid of the materials that depend on values that change without a report of the depsgraph."""

    def index(self, material: bpy.types.Material | None) -> int:
        """Index of a material, exported now if it is new; None is what Cycles gives faces without one."""
        # Blender gives evaluated copies no session_uid.
        key = _NO_MATERIAL if material is None else material.original.session_uid
        if key not in self._places:
            exported = self._export(key, material)
            self._places[key] = len(self.materials)
            self.materials.append(exported)
            self.attributes.append(_attributes_of(exported))
            self.sampled |= _sampled_of(exported)
        return self._places[key]

    def of_volume(self, place: int, is_gas: bool) -> int:
        """Index of a material as it is on a volume, which has no surface but grids.

        is_gas: it is on the gas of a fluid domain, which is not seen where it has no material; volume objects without
        one have Principled Volume.
        """
        material = self.materials[place]
        if place == self._places.get(_NO_MATERIAL) and not is_gas:
            place, material = _DEFAULT_VOLUME, dataclasses.replace(material, interior=default_volume())
        if place not in self._of_volumes:
            self._of_volumes[place] = len(self.materials)
            self.materials.append(_of_volume(material))
            self.attributes.append({})
        return self._of_volumes[place]

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
        if place in self._of_volumes:
            self.materials[self._of_volumes[place]] = _of_volume(exported)
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


def _of_volume(material: Material) -> Material:
    graph = NodeGraph()
    graph.surface = graph.add("volume_boundary", "bsdf")
    return dataclasses.replace(material, graph=graph, reads_grids=True)


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


def default_volume() -> NodeGraph:
    """A Principled Volume whose sockets are untouched, which Cycles gives volume objects without a material."""
    graph = NodeGraph()
    density, temperature = (graph.add("grid_attribute", "fac", attribute=name) for name in ("density", "temperature"))
    graph.surface = graph.add("volume_principled", "volume", density_grid=density, temperature_grid=temperature)
    return graph

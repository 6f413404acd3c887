# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiled graphs of a scene: those of its materials, of displacement, and of what belongs to no surface."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from ...scene.materials import Material
from ...scene.node_graphs import NodeGraph
from ...scene.passes import aov_passes
from ...scene.scene import Scene
from ..traits.emitted import Emits, emits
from ..traits.interiors import Interior, Variation
from .compiled_graph import NEUTRAL_TEXT, CompiledGraph, GraphError, NodeRayCounts
from .compiler import compile_displacement, compile_graph

NO_EFFECT = "it gives nothing"
"""Consequence of an error in a graph of the world, a light or a volume."""


@dataclass
class TextUse:
    """Materials whose graphs have the same GLSL."""

    rays: NodeRayCounts
    """Counts of the rays that any of them requests."""
    names: list[str] = field(default_factory=list)
    """Names of the materials."""


@dataclass(frozen=True)
class UnattachedGraph:
    """Graph of the world, of a light or of a volume, which belongs to no surface."""

    graph: NodeGraph
    owner: str
    """Owner, as in messages."""
    compiled: CompiledGraph


class SceneGraphs:
    """Compiled graphs of a scene. A graph that is not well formed is replaced, with a warning in scene.warnings."""

    def __init__(self, scene: Scene, materials: list[Material]) -> None:
        """materials: those of the scene, and the default material."""
        self._scene = scene
        self.surfaces: list[CompiledGraph] = []
        """Compiled graphs of the surfaces, by index of the material."""
        self.emits: list[Emits] = []
        """Emission of the surfaces, by index of the material."""
        self.texts: dict[str, TextUse] = {}
        """Distinct GLSL texts of surfaces."""
        for material in materials:
            self._compile_surface(material)
        self.displacements = dict(self._compile_displacements())
        """Graphs of the materials that displace, by index of the material."""
        self.interiors = [Interior.of(material.interior, material.reads_grids) for material in materials]
        """Media inside the surfaces, by index of the material."""
        self.world_interior = Interior.of(scene.world.volume)
        """The medium that fills the world."""
        self.unattached = list(self._compile_unattached(materials))

    def _compile_surface(self, material: Material) -> None:
        aovs, round_shapes = aov_passes(self._scene.settings.aovs), material.on_round_shapes
        try:
            compiled = compile_graph(
                material.graph,
                aovs,
                material.abbe_number,
                round_shapes,
                material.corrects_bump,
                space=self._scene.color_space,
            )
            emission = emits(material.graph)
        except GraphError as error:
            self._scene.warn(f'Material "{material.name}": {error}; it is gray')
            compiled, emission = CompiledGraph(NEUTRAL_TEXT), Emits.NOTHING
        self.surfaces.append(compiled)
        self.emits.append(emission)
        use = self.texts.setdefault(compiled.text, TextUse(rays=compiled.rays))
        use.names.append(material.name)
        use.rays = compiled.rays.united(use.rays)

    def _compile_displacements(self) -> Iterator[tuple[int, CompiledGraph]]:
        for index, material in enumerate(self._scene.materials):
            if material.graph.displacement is None:
                continue
            try:
                yield index, compile_displacement(material.graph, self._scene.color_space)
            except GraphError as error:
                self._scene.warn(f'Material "{material.name}": {error}; it displaces nothing')

    def _compile_unattached(self, materials: list[Material]) -> Iterator[UnattachedGraph]:
        owners = [("The world", self._scene.world.graph)]
        owners += [(f'Light "{light.name}"', light.graph) for light in self._scene.lights]
        volumes = [("The volume of the world", self.world_interior)]
        volumes += [
            (f'The volume of material "{material.name}"', interior)
            for material, interior in zip(materials, self.interiors, strict=True)
        ]
        for owner, interior in volumes:
            owners += [(owner, graph) for graph in interior.graphs]
            if interior.phases_vary:
                self._scene.warn(f"{owner} has a phase function that varies from place to place; one stands for all")
        if self.world_interior.variation >= Variation.PLACE_IN_OBJECT:
            self._scene.warn("The volume of the world varies from place to place; it is rendered around the scene only")
        for owner, graph in owners:
            if graph is not None:
                yield UnattachedGraph(graph, owner, self._compile_light(graph, owner))

    def _compile_light(self, graph: NodeGraph, owner: str) -> CompiledGraph:
        try:
            return compile_graph(graph, traces_rays=False, space=self._scene.color_space)
        except GraphError as error:
            self._scene.warn(f"{owner}: {error}; {NO_EFFECT}")
            return CompiledGraph(NEUTRAL_TEXT)

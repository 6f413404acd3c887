# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs of volumes, taken apart into the coefficients and the phase functions of a medium."""

import dataclasses
import enum
from collections.abc import Callable, Collection, Iterator
from typing import Any

import numpy as np

from ...scene.node_graphs import Link, NodeGraph, ShaderNode
from ..nodes import KINDS
from ..nodes.volumes import PHASES
from ..phase_functions import HENYEY_GREENSTEIN, MODELS, Parameters, PhaseModel
from ..records import PhaseFunctionKind
from .emitted import is_positive, reachable, surface_outputs

Evaluate = Callable[[NodeGraph], np.ndarray]
"""Gives the (height, width, 3) float32 "emission" of a node graph."""

_Contributions = dict[str, tuple[tuple[str, ...], ...]]
"""Kinds of nodes that contribute to a coefficient, and sets of inputs: the node contributes if all inputs of a set are
positive."""
_ABSORPTION: _Contributions = {
    "volume_absorption": (("density",),),
    "volume_coefficients": (("absorption_coefficients",),),
    "volume_principled": (("density",),),
}
_SCATTERING: _Contributions = {
    "volume_scatter": (("density", "color"),),
    "volume_coefficients": (("scatter_coefficients",),),
    "volume_principled": (("density", "color"),),
}
_EMISSION: _Contributions = {
    "emission": (("strength",),),
    "background": (("strength",),),
    "volume_coefficients": (("emission_coefficients",),),
    "volume_principled": (("emission_strength", "emission_color"), ("blackbody_intensity", "blackbody_tint")),
}
_COEFFICIENTS = {"ABSORPTION": _ABSORPTION, "SCATTERING": _SCATTERING, "EMISSION": _EMISSION}
"""Contributions by the option "coefficient" of a node."""
_DENSITY = frozenset({"density", "density_grid"})
_COLOR = frozenset({"color", "color_grid"})
_READ: dict[tuple[str, str], frozenset[str]] = {
    ("volume_scatter", "SCATTERING"): _DENSITY | _COLOR | {"diameter"},
    ("volume_coefficients", "ABSORPTION"): frozenset({"absorption_coefficients"}),
    ("volume_coefficients", "SCATTERING"): frozenset({"scatter_coefficients", "diameter"}),
    ("volume_coefficients", "EMISSION"): frozenset({"emission_coefficients"}),
    ("volume_principled", "ABSORPTION"): _DENSITY | _COLOR | {"absorption_color"},
    ("volume_principled", "SCATTERING"): _DENSITY | _COLOR,
    ("volume_principled", "EMISSION"): frozenset(
        {
            "emission_strength", "emission_color", "blackbody_intensity", "blackbody_tint", "temperature",
            "temperature_grid",
        }
    ),
}  # fmt: skip
"""Inputs on which a coefficient of a kind of node depends; the diameter of droplets for Mie's phase function only."""
_COMBINING = ("mix_shader", "add_shader")


class Variation(enum.IntEnum):
    """Variables on which the coefficients of a medium depend; each includes those before it."""

    NOTHING = 0
    OBJECT = 1
    """The object that the medium is in."""
    PLACE_IN_OBJECT = 2
    """The place in the space of the object, or an attribute there."""
    PLACE = 3
    """The place in the world."""


_CONSTANT = {"light_path", "uvmap", "random_per_island", "tangent", "strand_value", "hair_info", "round_size"}
"""Nodes about surfaces, which give the same everywhere in a volume."""
_BY_OBJECT = {"object_info", "particle_info"}
_ATTRIBUTES = {"attribute": Variation.OBJECT, "grid_attribute": Variation.NOTHING}
"""Nodes that read grids where there are any, and what they depend on elsewhere."""
_BY_PLACE_IN_OBJECT = {("tex_coord", "object"), ("generated_coord", "generated")}
"""Kinds of nodes, and outputs of theirs, that know no other place than that in the object."""


@dataclasses.dataclass(frozen=True)
class Scattering:
    """A part of a medium that scatters by one phase function."""

    coefficient: NodeGraph
    """Graph whose "emission" is the scattering coefficient, 1/m."""
    model: PhaseModel = HENYEY_GREENSTEIN
    inputs: tuple[float, ...] | NodeGraph = (0.0,)
    """Inputs of the model; a graph where nodes give them, whose "emission" has them as its components."""

    @property
    def kind(self) -> PhaseFunctionKind:
        """The kind of the phase function."""
        return self.model.kind

    def parameters(self, evaluate: Evaluate) -> Parameters:
        """Return the parameters of the phase function, of which one set stands for the whole medium."""
        inputs = self.inputs
        if isinstance(inputs, NodeGraph):
            inputs = tuple(map(float, evaluate(inputs)[0, 0, : len(self.model.inputs)]))
        return self.model.parameters(*inputs)


@dataclasses.dataclass(frozen=True)
class Interior:
    """A medium by graphs whose "emission" is the coefficient; None where there is none."""

    absorption: NodeGraph | None = None
    """In 1/m."""
    emission: NodeGraph | None = None
    """In W/(m^3 sr)."""
    scattering: tuple[Scattering, ...] = ()
    variation: Variation = Variation.NOTHING

    @property
    def varies(self) -> bool:
        """Whether the coefficients may differ between places or objects."""
        return self.variation > Variation.NOTHING

    @property
    def coefficients(self) -> list[NodeGraph]:
        """The graphs of all coefficients."""
        graphs = [self.absorption, self.emission, *(part.coefficient for part in self.scattering)]
        return [graph for graph in graphs if graph is not None]

    @property
    def graphs(self) -> list[NodeGraph]:
        """The graphs of all coefficients, and of the inputs of phase functions."""
        return self.coefficients + [part.inputs for part in self.scattering if isinstance(part.inputs, NodeGraph)]

    @property
    def phases_vary(self) -> bool:
        """Whether the inputs of phase functions may depend on the place."""
        return any(
            isinstance(part.inputs, NodeGraph) and variation(part.inputs) > Variation.OBJECT for part in self.scattering
        )

    @classmethod
    def of(cls, graph: NodeGraph | None, reads_grids: bool = False) -> "Interior":
        """The medium that a graph of a volume makes. reads_grids: whether its attributes may be grids of voxels."""
        if graph is None:
            return cls()
        if any(node.kind not in KINDS for node in graph.nodes):
            return cls(graph)  # which whoever compiles it reports
        medium = cls(_sum(graph, "ABSORPTION"), _sum(graph, "EMISSION"), tuple(_scattering(graph)))
        varied = max((variation(each, reads_grids) for each in medium.coefficients), default=Variation.NOTHING)
        return dataclasses.replace(medium, variation=varied)


def variation(graph: NodeGraph, reads_grids: bool = False) -> Variation:
    """Return the variables on which the volume of a graph depends. reads_grids: as for Interior.of."""
    asked = surface_outputs(graph)
    return max((_variation_of(kind, output, reads_grids) for kind, output in asked), default=Variation.NOTHING)


def _variation_of(kind: str, output: str, reads_grids: bool) -> Variation:
    if kind in _CONSTANT:
        return Variation.NOTHING
    if kind in _BY_OBJECT:
        return Variation.OBJECT
    if kind in _ATTRIBUTES and not reads_grids:
        return _ATTRIBUTES[kind]
    if kind in _ATTRIBUTES or kind == "tex_image" or (kind, output) in _BY_PLACE_IN_OBJECT:
        return Variation.PLACE_IN_OBJECT
    return Variation.PLACE


def _sum(graph: NodeGraph, coefficient: str) -> NodeGraph | None:
    """The graph of a coefficient to which all nodes contribute; None where none does."""
    nodes = _contributing(graph, coefficient)
    return _alone(graph, nodes, coefficient) if nodes else None


def _scattering(graph: NodeGraph) -> Iterator[Scattering]:
    """The parts of each node that scatters."""
    for index in sorted(_contributing(graph, "SCATTERING")):
        node = graph.nodes[index]
        for model in MODELS[str(node.options.get("phase", PHASES[0]))]:
            coefficient = _alone(graph, {index}, "SCATTERING", model)
            yield Scattering(coefficient, model, _phase_inputs(graph, node, model))


def _contributing(graph: NodeGraph, coefficient: str) -> set[int]:
    """Indices of the nodes that contribute to a coefficient."""
    kinds = _COEFFICIENTS[coefficient]
    return {
        index
        for index in reachable(graph, graph.surface)
        if any(
            all(is_positive(graph.nodes[index], name) for name in names)
            for names in kinds.get(graph.nodes[index].kind, ())
        )
    }


def _alone(
    graph: NodeGraph, contributing: Collection[int], coefficient: str, model: PhaseModel = HENYEY_GREENSTEIN
) -> NodeGraph:
    """The graph with nothing but some of its shaders in effect, which give a coefficient; model: of the phase function
    by which they scatter."""
    options = {"coefficient": coefficient, "mie_lobe": model.mie_lobe}

    def links_to_others(value: object) -> bool:
        if not isinstance(value, Link):
            return False
        node = graph.nodes[value.node]
        return KINDS[node.kind].is_shader and node.kind not in _COMBINING and value.node not in contributing

    nodes = list(graph.nodes)
    for index, node in enumerate(nodes):
        if index in contributing:
            known = {name: value for name, value in options.items() if name in KINDS[node.kind].options}
            nodes[index] = dataclasses.replace(node, options=node.options | known, inputs=_read(node, coefficient))
        elif node.kind in _COMBINING:
            inputs = {name: value for name, value in node.inputs.items() if not links_to_others(value)}
            nodes[index] = dataclasses.replace(node, inputs=inputs)
    return dataclasses.replace(graph, nodes=nodes)


def _read(node: ShaderNode, coefficient: str) -> dict[str, object]:
    """The inputs of a node on which a coefficient depends: others would make it seem to vary."""
    read = _READ.get((node.kind, coefficient))
    if read is None:
        return node.inputs
    unread = frozenset() if node.options.get("phase") == "MIE" else {"diameter"}
    return {name: value for name, value in node.inputs.items() if name in read - unread}


def _phase_inputs(graph: NodeGraph, node: ShaderNode, model: PhaseModel) -> tuple[float, ...] | NodeGraph:
    declared = KINDS[node.kind].inputs
    values: list[Any] = [node.inputs.get(name, declared[name][1]) for name in model.inputs]
    if not any(isinstance(value, Link) for value in values):
        return tuple(float(np.mean(value)) for value in values)
    asking = dataclasses.replace(graph, nodes=list(graph.nodes))
    x, y, z = (*values, 0.0, 0.0)[:3]
    given = asking.add("combine_xyz", "vector", name=node.name, x=x, y=y, z=z)
    asking.surface = asking.add("emission", "emission", name=node.name, color=given)
    return asking

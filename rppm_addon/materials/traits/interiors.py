# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs of volumes, taken apart into what they say of a medium."""

import dataclasses
import enum
from collections.abc import Collection

from ...scene.node_graphs import Link, NodeGraph
from ..nodes import KINDS
from ..records import PhaseFunctionKind
from .emitted import is_positive, reachable

_ABSORBING = {"volume_absorption": "density"}
_EMITTING = {"emission": "strength", "background": "strength"}
"""Kinds of nodes, and the input that none of it comes from when it is 0."""
_SURFACES = {"bsdf_principled": "emission_strength"}
"""Likewise: surfaces say nothing of a volume, as in Cycles."""


_CONSTANT = {"light_path", "uvmap", "random_per_island", "tangent", "strand_value", "hair_info", "round_size"}
"""Nodes about surfaces, which give the same everywhere in a volume."""
_BY_OBJECT = {"object_info", "particle_info"}
_BY_PLACE_IN_OBJECT = {("tex_coord", "object"), ("generated_coord", "generated")}
"""Kinds of nodes, and outputs of theirs, that know no other place than that in the object."""


class Variation(enum.IntEnum):
    """Variables on which the coefficients of a medium depend; each includes those before it."""

    NOTHING = 0
    OBJECT = 1
    """The object that the medium is in."""
    PLACE_IN_OBJECT = 2
    """The place in the space of the object, or an attribute there."""
    PLACE = 3
    """The place in the world."""


@dataclasses.dataclass(frozen=True)
class Scattering:
    """A part of a medium that scatters by one phase function."""

    coefficient: NodeGraph
    """Graph whose "emission" is the scattering coefficient, 1/m."""
    kind: PhaseFunctionKind = PhaseFunctionKind.HENYEY_GREENSTEIN
    parameters: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    """Parameters of the phase function (PhaseFunctionKind)."""


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
    def graphs(self) -> list[NodeGraph]:
        """The graphs of all coefficients."""
        graphs = [self.absorption, self.emission, *(part.coefficient for part in self.scattering)]
        return [graph for graph in graphs if graph is not None]

    @classmethod
    def of(cls, graph: NodeGraph | None) -> "Interior":
        """The medium that a graph of a volume makes."""
        if graph is None:
            return cls()
        if any(node.kind not in KINDS for node in graph.nodes):
            return cls(graph)  # which whoever compiles it reports
        absorption, emission = _part(graph, _ABSORBING), _part(graph, _EMITTING)
        return cls(absorption, emission, variation=variation(graph) if absorption or emission else Variation.NOTHING)


def variation(graph: NodeGraph) -> Variation:
    """Return the variables on which the volume of a graph depends."""
    nodes = [graph.nodes[index] for index in reachable(graph, graph.surface)]
    asked = {
        (graph.nodes[value.node].kind, value.output)
        for node in nodes
        for value in node.inputs.values()
        if isinstance(value, Link) and KINDS[graph.nodes[value.node].kind].surface
    }
    return max((_variation_of(kind, output) for kind, output in asked), default=Variation.NOTHING)


def _variation_of(kind: str, output: str) -> Variation:
    if kind in _CONSTANT:
        return Variation.NOTHING
    if kind in _BY_OBJECT:
        return Variation.OBJECT
    if kind in ("attribute", "tex_image") or (kind, output) in _BY_PLACE_IN_OBJECT:
        return Variation.PLACE_IN_OBJECT
    return Variation.PLACE


def _part(graph: NodeGraph, kinds: dict[str, str]) -> NodeGraph | None:
    """The graph with nothing but nodes of some kinds in effect; None where that gives nothing."""
    nodes = [graph.nodes[index] for index in reachable(graph, graph.surface)]
    if not any(is_positive(node, kinds[node.kind]) for node in nodes if node.kind in kinds):
        return None
    others = {kind: name for kind, name in (_ABSORBING | _EMITTING | _SURFACES).items() if kind not in kinds}
    return _without(graph, others) if _has(graph, others) else graph


def _has(graph: NodeGraph, kinds: Collection[str]) -> bool:
    return any(node.kind in kinds for node in graph.nodes)


def _without(graph: NodeGraph, kinds: dict[str, str]) -> NodeGraph:
    nodes = [
        dataclasses.replace(node, inputs=node.inputs | {kinds[node.kind]: 0.0}) if node.kind in kinds else node
        for node in graph.nodes
    ]
    return dataclasses.replace(graph, nodes=nodes)

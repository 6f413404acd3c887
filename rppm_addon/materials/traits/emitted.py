# SPDX-License-Identifier: GPL-3.0-or-later
"""Emission of node graphs."""

import enum
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...scene.materials import Material
from ...scene.node_graphs import Link, NodeGraph, ShaderNode
from ..nodes import KINDS

_EMITTING = {
    "emission": ("color", "strength"),
    "background": ("color", "strength"),
    "plain_surface": ("emission",),
    "bsdf_principled": ("emission_color", "emission_strength"),
}
"""Shader nodes that emit where none of these inputs is 0."""


class Emits(enum.Enum):
    """Emission of a graph, as far as its structure and constants show."""

    NOTHING = "nothing"
    EVENLY = "evenly"
    """The same everywhere and in all directions."""
    VARYING = "varying"


def reachable(graph: NodeGraph, start: Link | None) -> set[int]:
    """Indices of the nodes that a link depends on."""
    found: set[int] = set()
    pending = [] if start is None else [start.node]
    while pending:
        index = pending.pop()
        if index not in found and 0 <= index < len(graph.nodes):  # the compiler reports links to nowhere
            found.add(index)
            pending += [value.node for value in graph.nodes[index].inputs.values() if isinstance(value, Link)]
    return found


def surface_outputs(graph: NodeGraph) -> set[tuple[str, str]]:
    """Kinds and outputs of the nodes that know where they are shaded, as far as the graph's shader depends on these."""
    return {
        (graph.nodes[value.node].kind, value.output)
        for index in reachable(graph, graph.surface)
        for value in graph.nodes[index].inputs.values()
        if isinstance(value, Link) and KINDS[graph.nodes[value.node].kind].surface
    }


def emits(graph: NodeGraph) -> Emits:
    """Whether a graph may emit light, and whether what it emits depends on place or direction."""
    nodes = reachable(graph, graph.surface)
    if not any(_may_emit(graph.nodes[index]) for index in nodes):
        return Emits.NOTHING
    # Layers above the emission of a Principled surface, and mixes with other shaders by place.
    varying = any(KINDS[graph.nodes[index].kind].surface for index in nodes) or any(
        graph.nodes[index].kind == "bsdf_principled" and _is_layered(graph.nodes[index]) for index in nodes
    )
    return Emits.VARYING if varying else Emits.EVENLY


def glowing_materials(materials: Sequence[Material]) -> set[int]:
    """Places of the materials that may emit light."""
    return {place for place, material in enumerate(materials) if emits(material.graph) is not Emits.NOTHING}


def asks_for_path(graph: NodeGraph) -> bool:
    """Whether the surface depends on what kind of ray comes to it, or from how far."""
    return any(graph.nodes[index].kind == "light_path" for index in reachable(graph, graph.surface))


_OF_MESH = {
    "uvmap", "random_per_island", "strand_value", "round_size", "tangent", "generated_coord", "fresnel", "layer_weight",
    "light_path", "hair_info",
}  # fmt: skip
_OUTPUTS_OF_MESH = {
    ("tex_coord", "uv"), ("tex_coord", "object"), ("tex_coord", "normal"), ("new_geometry", "parametric"),
    ("new_geometry", "backfacing"), ("new_geometry", "incoming"),
}  # fmt: skip
"""Nodes, and outputs of others, that tell no instance of a mesh from another but by where it is seen from."""


def emits_alike(graph: NodeGraph) -> bool:
    """Return True where all instances of a mesh emit the same light from each of its places, as far as the nodes show:
    none ask for the object, the instance or the place in the world."""
    asked = surface_outputs(graph)
    return all(
        kind in _OF_MESH or (kind, output) in _OUTPUTS_OF_MESH or _shades(kind) for kind, output in asked
    ) and not any(
        graph.nodes[index].kind == "tex_image" and graph.nodes[index].options.get("projection") == "BOX"
        for index in reachable(graph, graph.surface)
    )


def _shades(kind: str) -> bool:
    """Return True for shaders, and for textures, which depend on what their inputs do."""
    return kind == "tex_image" or kind.startswith("bsdf_") or kind in _EMITTING


@dataclass(frozen=True)
class LightVariation:
    """Variables on which the emission of a light depends."""

    place: bool
    """Its normal or the place on it."""
    direction: bool
    """Where the light goes, which a normal may not know."""
    uv: bool
    """Texture coordinates UV: places of an area light, directions of a spot."""
    distance: bool
    """How far off is what it lights."""

    def __bool__(self) -> bool:
        return self.place or self.direction or self.uv


_SAME_EVERYWHERE = {
    "light_path", "object_info", "particle_info", "attribute", "grid_attribute", "uvmap", "random_per_island",
    "vector_transform",
}  # fmt: skip
"""Nodes that give the same at all places of a light, but for what feeds them."""
_BY_DIRECTION = {("new_geometry", "incoming"), ("tex_coord", "reflection")}
_BY_UV = {("tex_coord", "uv"), ("new_geometry", "parametric")}
_BY_BOTH = {"fresnel", "layer_weight"}


def light_variation(graph: NodeGraph) -> LightVariation:
    """Return the variables on which the emission of a light's graph depends."""
    nodes = [graph.nodes[index] for index in reachable(graph, graph.surface)]
    asked = surface_outputs(graph)
    asked = {(kind, output) for kind, output in asked if kind not in _SAME_EVERYWHERE and kind != "tex_image"}
    both = any(kind in _BY_BOTH for kind, _ in asked)
    box = any(node.kind == "tex_image" and node.options.get("projection") == "BOX" for node in nodes)
    return LightVariation(
        place=both or box or bool(asked - _BY_DIRECTION - _BY_UV),
        direction=both or bool(asked & _BY_DIRECTION),
        uv=bool(asked & _BY_UV),
        distance=asks_for_path(graph),
    )


def _may_emit(node: ShaderNode) -> bool:
    names = _EMITTING.get(node.kind, ())
    return bool(names) and all(_may_be_nonzero(node, name) for name in names)


def _may_be_nonzero(node: ShaderNode, name: str) -> bool:
    value: Any = node.inputs.get(name, KINDS[node.kind].inputs[name][1])
    return isinstance(value, Link) or bool(np.any(value))


def is_positive(node: ShaderNode, name: str) -> bool:
    """Whether an input of a node is, or may be, above 0."""
    value: Any = node.inputs.get(name, KINDS[node.kind].inputs[name][1])
    if isinstance(value, Link):
        return True
    return value > 0.0 if isinstance(value, int | float) else max(value) > 0.0


def _is_layered(node: ShaderNode) -> bool:
    inputs = KINDS[node.kind].inputs
    return any(name in inputs and is_positive(node, name) for name in ("coat_weight", "sheen_weight"))

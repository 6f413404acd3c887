# SPDX-License-Identifier: GPL-3.0-or-later
"""Three glasses of red, green and blue with an index each, added: how artists show dispersion without a setting for it.

They are rendered as what they are, in three colors. One glass with an Abbe number shows all of the spectrum, with less
noise; this finds such glasses and puts one in their place.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from ..materials import dispersion
from .export.shading.nodes.links import node_tree

_GLASSES = {"BSDF_GLASS", "BSDF_REFRACTION"}
_SUMS = {"ADD_SHADER", "MIX_SHADER"}
_OF_EACH = {"Color", "IOR"}
"""Inputs in which the three glasses differ."""
_MOST_IMPURE = 0.1
"""Largest fraction of a glass's strongest color channel that each of its other two channels may have."""
_OPERATIONS: dict[str, Callable[[float, float], float]] = {
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "MULTIPLY": lambda a, b: a * b,
    "DIVIDE": lambda a, b: a / b if b else 0.0,
}
_DEEPEST = 32
"""Nodes that numbers and sums are followed through."""


@dataclass(frozen=True)
class ColoredGlasses:
    """Three glasses and what adds them."""

    root: bpy.types.Node
    """Its output is the sum."""
    parts: tuple[bpy.types.Node, ...]
    """All nodes between the root and the glasses, both included."""
    green: bpy.types.Node
    color: tuple[float, float, float]
    """Color of the sum of the three glasses."""
    indices: tuple[float, float, float]
    """Indices of refraction of the red, the green and the blue glass."""

    @property
    def fitted(self) -> tuple[float, float]:
        """IOR and Abbe number of a glass that disperses as much; negative where red has the largest index."""
        return dispersion.fitted(np.array(self.indices))


def colored_glasses(material: bpy.types.Material) -> ColoredGlasses | None:
    """The first such glasses that the material's surface is made of, groups left out."""
    tree = node_tree(material)
    output = None if tree is None else tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
    if output is None:
        return None
    for node in _shaders_before(output.inputs["Surface"]):
        found = _sum_of_glasses(node) if node.type in _SUMS else None
        if found is not None:
            return found
    return None


def convert(material: bpy.types.Material, found: ColoredGlasses) -> None:
    """One glass in their place, and dispersion by its Abbe number. Nodes that nothing else uses are removed."""
    tree, green = found.root.id_data, found.green
    ior, abbe_number = found.fitted
    glass = tree.nodes.new(green.bl_idname)
    glass.location, glass.parent, glass.distribution = found.root.location, found.root.parent, green.distribution
    for made, copied in zip(glass.inputs, green.inputs, strict=True):
        if made.name in _OF_EACH:
            continue
        if copied.is_linked:
            tree.links.new(copied.links[0].from_socket, made)
        elif hasattr(copied, "default_value"):
            made.default_value = copied.default_value
    glass.inputs["IOR"].default_value = ior
    glass.inputs["Color"].default_value = (*np.clip(found.color, 0.0, 1.0), 1.0)
    for link in list(found.root.outputs[0].links):
        tree.links.new(glass.outputs[0], link.to_socket)
    for node in found.parts:
        if not any(socket.is_linked for socket in node.outputs):
            tree.nodes.remove(node)
    material.rppm.use_dispersion = True
    material.rppm.abbe_number = abs(abbe_number)


def _source(socket: bpy.types.NodeSocket) -> tuple[bpy.types.Node | None, list[bpy.types.Node]]:
    """The node that feeds an input, and the reroutes on the way."""
    passed: list[bpy.types.Node] = []
    while socket.is_linked and len(passed) < _DEEPEST:
        link = socket.links[0]
        if link.is_muted or not link.is_valid:
            break
        if link.from_node.type != "REROUTE":
            return link.from_node, passed
        passed.append(link.from_node)
        socket = link.from_node.inputs[0]
    return None, passed


def _shader_inputs(node: bpy.types.Node) -> list[bpy.types.NodeSocket]:
    return [socket for socket in node.inputs if socket.type == "SHADER"]


def _shaders_before(socket: bpy.types.NodeSocket) -> Iterator[bpy.types.Node]:
    """The nodes that feed a shader, the nearest first, each once."""
    sockets, known = [socket], set()
    for feeding in sockets:
        node, _ = _source(feeding)
        if node is not None and node.name not in known:
            known.add(node.name)
            yield node
            sockets.extend(_shader_inputs(node))


def _sum_of_glasses(root: bpy.types.Node) -> ColoredGlasses | None:
    glasses: list[tuple[bpy.types.Node, float]] = []
    parts: list[bpy.types.Node] = []
    if not _collect(root, 1.0, glasses, parts) or len(glasses) != 3:
        return None
    colors = [_color(node.inputs["Color"]) for node, _ in glasses]
    indices = [_number(node.inputs["IOR"]) for node, _ in glasses]
    if None in colors or None in indices or min(indices) <= 1.0 or len(set(indices)) == 1:
        return None
    channels = [int(np.argmax(color)) for color in colors]
    impure = any(sorted(color)[1] > _MOST_IMPURE * max(color) or max(color) <= 0.0 for color in colors)
    if sorted(channels) != [0, 1, 2] or impure:
        return None
    order = [channels.index(channel) for channel in range(3)]
    nodes = [glasses[place][0] for place in order]
    if not all(_are_alike(nodes[1], other) for other in (nodes[0], nodes[2])):
        return None
    color = sum(weight * np.array(color) for (_, weight), color in zip(glasses, colors, strict=True))
    return ColoredGlasses(root, tuple(parts), nodes[1], tuple(color), tuple(indices[place] for place in order))


def _collect(node: bpy.types.Node, weight: float, glasses: list, parts: list) -> bool:
    """Add the glasses that a node sums up with their weights, and all nodes on the way. False where it has others."""
    if node.mute or node in parts or len(parts) > _DEEPEST:
        return False
    parts.append(node)
    if node.type in _GLASSES:
        glasses.append((node, weight))
        return True
    if node.type not in _SUMS:
        return False
    weights = [weight, weight]
    if node.type == "MIX_SHADER":
        factor = _number(node.inputs[0])
        if factor is None:
            return False
        factor = min(max(factor, 0.0), 1.0)
        weights = [weight * (1.0 - factor), weight * factor]
    for socket, input_weight in zip(_shader_inputs(node), weights, strict=True):
        source, reroutes = _source(socket)
        if source is None or input_weight <= 0.0:
            return False
        parts.extend(reroutes)
        if not _collect(source, input_weight, glasses, parts):
            return False
    return True


def _are_alike(node: bpy.types.Node, other: bpy.types.Node) -> bool:
    """Whether glasses differ in color and index only."""
    if node.type != other.type or node.distribution != other.distribution:
        return False
    for a, b in zip(node.inputs, other.inputs, strict=True):
        if a.name in _OF_EACH or not a.enabled:
            continue
        if a.is_linked or b.is_linked:
            if not (a.is_linked and b.is_linked) or a.links[0].from_socket != b.links[0].from_socket:
                return False
        elif hasattr(a, "default_value") and not np.allclose(a.default_value, b.default_value):
            return False
    return True


def _color(socket: bpy.types.NodeSocket) -> tuple[float, ...] | None:
    if not socket.is_linked:
        return tuple(socket.default_value[:3])
    source, _ = _source(socket)
    return tuple(source.outputs[0].default_value[:3]) if source is not None and source.type == "RGB" else None


def _number(socket: bpy.types.NodeSocket, depth: int = 0, known: dict[str, float | None] | None = None) -> float | None:
    """Return the number that an input gets, None where it varies or is computed in other ways than by plain
    arithmetic. known: the numbers found so far, by node, as sums may have a node twice and panels ask at each
    drawing."""
    if not socket.is_linked:
        return _finite(float(socket.default_value))
    source, _ = _source(socket)
    if source is None or source.mute or depth >= _DEEPEST:
        return None
    known = {} if known is None else known
    if source.name not in known:
        value: float | None = None
        if source.type == "VALUE":
            value = float(source.outputs[0].default_value)
        elif source.type == "MATH" and source.operation in _OPERATIONS:
            terms = [_number(term, depth + 1, known) for term in source.inputs[:2]]
            if None not in terms:
                value = _OPERATIONS[source.operation](*terms)
                value = min(max(value, 0.0), 1.0) if source.use_clamp else value
        known[source.name] = _finite(value)
    return known[source.name]


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None

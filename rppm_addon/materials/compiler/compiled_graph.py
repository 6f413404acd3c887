# SPDX-License-Identifier: GPL-3.0-or-later
"""CompiledGraph: the GLSL of a node graph, with its constants and the rays that its nodes request."""

from dataclasses import dataclass, field, replace

from ...scene.errors import RppmError

MAX_NODE_RAYS = 128
"""Largest number of samples of a node, as in Blender."""

NEUTRAL_TEXT = """void evaluate_material(Surface surface, uint first, inout ClosureBuilder builder) {
    builder.closure.diffuse = vec3(0.8);
}
"""
"""GLSL that stands in for a graph that cannot be compiled: a gray surface."""


class GraphError(RppmError):
    """A graph that does not agree with the kinds of its nodes."""


@dataclass(frozen=True)
class Resource:
    """A constant that is known only when all materials of a scene are laid out."""

    what: str
    """table, image or attribute."""
    node: int
    name: str = ""
    """Name of an attribute that is not the node's own."""


@dataclass(frozen=True)
class NodeRayCounts:
    """Counts of the rays that the nodes of a text ask for."""

    places: int = 0
    """Number of places for what rays find, for each hit."""
    levels: int = 0
    """Number of times that rays are traced: rays of a node may depend on the hits of another node's rays."""
    samples: int = 0
    """Rays of a place, at most."""
    casts: bool = False
    """Whether there are rays from any place, as of Raycast nodes."""

    def united(self, other: "NodeRayCounts") -> "NodeRayCounts":
        """Return the counts for graphs that have their text in common."""
        return replace(self, samples=max(self.samples, other.samples))


@dataclass
class CompiledGraph:
    """GLSL for a structure of graphs, and the constants of one graph."""

    text: str
    constants: list[float | Resource] = field(default_factory=list)
    rays: NodeRayCounts = NodeRayCounts()

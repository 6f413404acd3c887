# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs: what the node trees of materials, worlds and lights are once groups, reroutes and muted nodes are
resolved."""

from dataclasses import dataclass, field

import numpy as np

from .common.declared import declared


@dataclass(frozen=True)
class Link:
    """An output of a node of the same graph."""

    node: int
    """Index into NodeGraph.nodes."""
    output: str


@dataclass
class ShaderNode:
    """A node; rppm_addon/materials/nodes lists the kinds with their inputs, options and outputs."""

    kind: str
    name: str = ""
    """The name that the user sees, for messages."""
    inputs: dict[str, object] = field(default_factory=dict)
    """A float, a tuple of three floats or a Link by name; what is left out has the kind's default."""
    options: dict[str, object] = field(default_factory=dict)
    """Choices that select code; what is left out has the kind's first value."""
    table: np.ndarray | None = field(default=None, metadata=declared(types="fiu", finite=False))
    """(n, channels) float32 of a ramp, (n,) of a curve, a profile of light or tiles."""
    image: int = field(default=-1, metadata=declared(minimum=-1, below="images"))
    """Index into Scene.images, or -1."""
    attribute: str = ""
    """Name of the mesh attribute that is read."""


@dataclass
class AovOutput:
    """An AOV Output node: what a material writes into a pass of a name of the user's."""

    name: str
    """Name of the pass."""
    color: object = (0.0, 0.0, 0.0)
    """A float, a tuple of three floats or a Link; taken where the pass is one of colors."""
    value: object = 0.0
    """The same; taken where it is one of values."""


@dataclass
class NodeGraph:
    """Nodes in an order in which inputs link to earlier nodes only, and the shader that is seen."""

    nodes: list[ShaderNode] = field(default_factory=list)
    surface: Link | None = None
    """The shader of the surface (of a world: of its background); None scatters and emits nothing."""
    normal: Link | None = None
    """The shading normal that all shaders start from; None is that of the mesh."""
    displacement: Link | None = None
    """How far the mesh's vertices are moved, in world space, meters; None: not."""
    aovs: list[AovOutput] = field(default_factory=list)

    def add(
        self,
        kind: str,
        output: str = "",
        *,
        name: str = "",
        options: dict[str, object] | None = None,
        table: np.ndarray | None = None,
        image: int = -1,
        attribute: str = "",
        **inputs: object,
    ) -> Link:
        """Append a node and link to one of its outputs."""  # fmt: skip
        self.nodes.append(ShaderNode(kind, name, inputs, options or {}, table, image, attribute))
        return Link(len(self.nodes) - 1, output)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Reduction of a node graph, without evaluating it, to one plain surface."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...scene.images import Image, decode_srgb
from ...scene.node_graphs import Link, NodeGraph, ShaderNode
from ..nodes import KINDS
from ..nodes.node_kinds import SocketType

GLASS_OPACITY = 0.3
"""Opacity of the part of a surface that lets light through by refraction: what is behind it has to be seen."""
_GRAY = np.full(3, 0.8)
_MAX_PIXELS = 64
"""Along a side of an image, of which the mean is taken."""
_MAX_NODES = 200
"""Looked at in a graph, those that are used twice counted twice: ways through a graph can be without number."""
_GLOSSY = {"bsdf_glossy", "bsdf_metallic"}
_REFRACTIVE = {"bsdf_glass", "bsdf_refraction"}
_LIGHTS = {"emission", "background"}
_UV_KINDS = {"tex_coord", "uvmap"}
"""Kinds of nodes whose output "uv" is that of the UV map in use."""
_UNMAPPED = {"scale": 1.0, "location": 0.0, "rotation": 0.0}


@dataclass(frozen=True)
class PlainSurface:
    """The inputs of the shaders that a surface is mixed of, in the mean."""

    color: np.ndarray
    """(3,) float64, linear Rec.709."""
    metallic: float
    roughness: float
    emission: np.ndarray
    """(3,) float64 radiance, W/(m^2 sr)."""
    transparent: float
    """Fraction of what is behind that is seen unbent."""
    glass: float
    """Fraction of what lets light through by refraction."""
    texture: "PlainTexture | None" = None
    """Texture whose mean the color is, at least in part; None if there is none."""

    @property
    def opacity(self) -> float:
        """1 hides what is behind it."""
        return float(np.clip(1.0 - self.transparent - (1.0 - GLASS_OPACITY) * self.glass, 0.0, 1.0))


@dataclass(frozen=True)
class PlainTexture:
    """An image in the coordinates of the UV map in use."""

    image: int
    """Index into Scene.images."""
    scale: np.ndarray
    """(3,) float64, by which the coordinates are multiplied."""
    offset: np.ndarray
    """(3,) float64, what is added to them then."""


def plain_surface(graph: NodeGraph, images: Sequence[Image]) -> PlainSurface:
    """The plain surface of a graph: constants as they are, images by their mean, other textures by that of their
    colors. No graph is too broken for it."""
    return _Mean(graph, images).surface()


class _Mean:
    """Sums over the shaders of a graph, by their weights."""

    def __init__(self, graph: NodeGraph, images: Sequence[Image]) -> None:
        self._graph = graph
        self._images = images
        self._nodes_left = _MAX_NODES
        self._weight = self._metallic = self._roughness = self._transparent = self._glass = 0.0
        self._texture: PlainTexture | None = None
        self._color, self._emission = np.zeros(3), np.zeros(3)

    def surface(self) -> PlainSurface:
        if self._graph.surface is not None:
            self._add(self._graph.surface, 1.0)
        weight = self._weight or 1.0
        return PlainSurface(
            np.clip(self._color / weight, 0.0, 1.0),
            float(np.clip(self._metallic / weight, 0.0, 1.0)),
            float(np.clip(self._roughness / weight, 0.0, 1.0)) if self._weight else 1.0,
            np.maximum(self._emission, 0.0),
            float(np.clip(self._transparent, 0.0, 1.0)),
            float(np.clip(self._glass, 0.0, 1.0)),
            self._texture,
        )

    def _add(self, shader: Link, weight: float) -> None:
        node = self._node(shader)
        if node is None:
            return
        inputs = [node.inputs.get(name) for name in ("shader", "shader_001")]
        if node.kind == "mix_shader":
            factor = float(np.clip(self._number(node, "fac", 0.5), 0.0, 1.0))
            weights = [weight * (1.0 - factor), weight * factor]
        elif node.kind == "add_shader":
            weights = [weight, weight]
        else:
            self._add_shader(node, weight)
            return
        for linked, part in zip(inputs, weights, strict=True):
            if isinstance(linked, Link):
                self._add(linked, part)

    def _add_shader(self, node: ShaderNode, weight: float) -> None:
        if node.kind in _LIGHTS:
            self._emission += weight * self._number(node, "strength", 1.0) * self._color_of(node, "color")
            return
        if node.kind == "volume_boundary":
            self._transparent += weight
            return
        if node.kind == "bsdf_transparent":
            self._transparent += weight * float(np.clip(self._color_of(node, "color"), 0.0, 1.0).mean())
            return
        metallic, glass, alpha = float(node.kind in _GLOSSY), float(node.kind in _REFRACTIVE), 1.0
        color = self._color_of(node, "base_color" if "base_color" in KINDS[node.kind].inputs else "color")
        if node.kind == "bsdf_principled":
            metallic = self._number(node, "metallic", 0.0)
            glass = (1.0 - metallic) * self._number(node, "transmission_weight", 0.0)
            alpha = self._number(node, "alpha", 1.0)
            strength, texture = self._number(node, "emission_strength", 0.0), self._texture
            self._emission += weight * alpha * strength * self._color_of(node, "emission_color")
            self._texture = texture
        self._transparent += weight * (1.0 - alpha)
        self._glass += weight * alpha * glass
        self._weight += weight
        self._color += weight * color
        self._metallic += weight * metallic
        self._roughness += weight * self._number(node, "roughness", 1.0)

    def _node(self, link: Link) -> ShaderNode | None:
        nodes = self._graph.nodes
        self._nodes_left -= 1
        if self._nodes_left < 0:
            return None
        node = nodes[link.node] if 0 <= link.node < len(nodes) else None
        return node if node is not None and node.kind in KINDS else None

    def _number(self, node: ShaderNode, name: str, otherwise: float) -> float:
        """An input; what is linked has its default."""
        _, default = KINDS[node.kind].inputs.get(name, (None, otherwise))
        value = node.inputs.get(name, default)
        number = float(np.asarray(default if isinstance(value, Link) else value, np.float64).mean())
        return number if np.isfinite(number) else otherwise

    def _color_of(self, node: ShaderNode, name: str) -> np.ndarray:
        """(3,) of an input; what is linked is found among what the linked node mixes."""
        _, default = KINDS[node.kind].inputs.get(name, (None, _GRAY))
        value = node.inputs.get(name, default)
        if isinstance(value, Link):
            return self._output(value)
        color = np.broadcast_to(np.asarray(value, np.float64), 3)
        return color if np.isfinite(color).all() else _GRAY

    def _output(self, link: Link) -> np.ndarray:
        node = self._node(link)
        if node is None:
            return _GRAY
        if 0 <= node.image < len(self._images):
            self._texture = self._texture or self._texture_of(node)
            return mean_color(self._images[node.image])
        colors = [name for name, (kind, _) in KINDS[node.kind].inputs.items() if kind is SocketType.COLOR]
        if colors:
            return np.mean([self._color_of(node, name) for name in colors], axis=0)
        if node.table is not None and node.table.ndim == 2 and node.table.shape[1] >= 3:  # a color ramp
            return node.table[:, :3].mean(axis=0, dtype=np.float64)
        return _GRAY

    def _texture_of(self, node: ShaderNode) -> PlainTexture | None:
        """The image of a node, if it lies flat on the UV map in use, moved and scaled at most."""
        place = node.inputs.get("vector")
        scale, offset = np.ones(3), np.zeros(3)
        mapping = self._node(place) if isinstance(place, Link) else None
        if mapping is not None and mapping.kind == "mapping" and mapping.options.get("vector_type", "POINT") == "POINT":
            place = mapping.inputs.get("vector")
            values = [mapping.inputs.get(name, start) for name, start in _UNMAPPED.items()]
            if any(isinstance(value, Link) for value in values):
                return None
            scale, offset, rotation = (np.broadcast_to(np.asarray(value, np.float64), 3) for value in values)
            if rotation.any():
                return None
        start = self._node(place) if isinstance(place, Link) else None
        flat = node.kind == "tex_image" and node.options.get("projection", "FLAT") == "FLAT"
        if not flat or start is None or start.kind not in _UV_KINDS:
            return None
        if not isinstance(place, Link) or place.output != "uv":
            return None
        return PlainTexture(node.image, scale, offset)


def mean_color(image: Image) -> np.ndarray:
    """(3,) float64, linear Rec.709: the mean of some pixels that lie evenly."""
    height, width = image.pixels.shape[:2]
    steps = (max(1, -(-size // _MAX_PIXELS)) for size in (height, width))
    pixels = image.pixels[tuple(slice(step // 2, None, step) for step in steps)][..., :3]
    colors = pixels / 255.0 if pixels.dtype == np.uint8 else pixels.astype(np.float64)
    if image.encoding == "SRGB":
        colors = decode_srgb(colors)
    return np.nan_to_num(colors.reshape(-1, 3), posinf=0.0, neginf=0.0).mean(axis=0)

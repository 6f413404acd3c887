# SPDX-License-Identifier: GPL-3.0-or-later
"""Stand-ins that are rendered for materials until their own programs are compiled.

All stand-ins have the same structure, so one program renders them: the plain surface of a graph (plain_surface.py) with
the image of its color, a glossy or a glass part, transparency and emission.
"""

from collections.abc import Sequence

import numpy as np

from ...scene.images import Image
from ...scene.node_graphs import NodeGraph
from .plain_surface import mean_color, plain_surface

_DARKEST = 1e-3
"""Lower limit of an image's mean where a color is divided by it: it limits how far the image may be brightened."""


def stand_in_graph(graph: NodeGraph, images: Sequence[Image]) -> NodeGraph:
    """A graph that approximates another one and has the structure of all stand-ins. No graph is too broken for it."""
    plain = plain_surface(graph, images)
    texture = plain.texture
    scale, offset, tint = np.ones(3), np.zeros(3), plain.color
    if texture is not None:
        scale, offset = texture.scale, texture.offset
        tint = plain.color / np.maximum(mean_color(images[texture.image]), _DARKEST)
    made = NodeGraph()
    place = made.add(
        "vector_math",
        "vector",
        options={"operation": "MULTIPLY_ADD"},
        vector=made.add("tex_coord", "uv"),
        vector_001=_three(scale),
        vector_002=_three(offset),
    )
    image = made.add("tex_image", "color", image=-1 if texture is None else texture.image, vector=place)
    made.surface = made.add(
        "plain_surface",
        "surface",
        color=_three(tint),
        texture=image,
        texture_factor=float(texture is not None),
        metallic=plain.metallic,
        roughness=plain.roughness,
        glass=min(plain.glass / max(1.0 - plain.transparent, 1e-6), 1.0),
        transparent=plain.transparent,
        emission=_three(plain.emission),
    )
    return made


def _three(values: np.ndarray) -> tuple[float, ...]:
    return tuple(float(value) for value in values)

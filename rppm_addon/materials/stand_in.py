# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in for a material until its own program is compiled.

All stand-ins have the same structure, so one program renders them: the plain surface of a graph (plain_surface.py) as
diffuse, glossy and glass parts, with the image of its color, transparency and emission.
"""

from collections.abc import Sequence

import numpy as np

from ..scene.images import Image
from ..scene.node_graphs import NodeGraph
from .plain_surface import mean_color, plain_surface

_DIELECTRIC = 0.04
"""What a smooth surface that is no metal reflects, seen from the front."""
_DARKEST = 1e-3
"""Of an image's mean, as far as it may be brightened."""
_IOR = 1.45


def stand_in_graph(graph: NodeGraph, images: Sequence[Image]) -> NodeGraph:
    """A graph that looks much like another one, of the structure that all stand-ins share. None is too broken."""
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
    has_image = float(texture is not None)
    textured = made.add("mix_color", "result_color", factor_float=has_image, a_color=1.0, b_color=image)
    color = made.add(
        "mix_color",
        "result_color",
        options={"blend_type": "MULTIPLY"},
        factor_float=1.0,
        a_color=textured,
        b_color=_three(tint),
    )
    reflected = made.add("mix_color", "result_color", factor_float=plain.metallic, a_color=1.0, b_color=color)
    ggx: dict[str, object] = {"distribution": "GGX"}
    glossy = made.add("bsdf_glossy", "bsdf", options=ggx, color=reflected, roughness=plain.roughness)
    glass = made.add("bsdf_glass", "bsdf", options=ggx, color=color, roughness=plain.roughness, ior=_IOR)
    diffuse = made.add("bsdf_diffuse", "bsdf", color=color)
    shine = plain.metallic + (1.0 - plain.metallic) * (1.0 - plain.roughness) * _DIELECTRIC
    share = plain.glass / max(1.0 - plain.transparent, 1e-6)
    opaque = made.add("mix_shader", "shader", fac=shine, shader=diffuse, shader_001=glossy)
    solid = made.add("mix_shader", "shader", fac=min(share, 1.0), shader=opaque, shader_001=glass)
    clear = made.add("bsdf_transparent", "bsdf")
    seen = made.add("mix_shader", "shader", fac=plain.transparent, shader=solid, shader_001=clear)
    light = made.add("emission", "emission", color=_three(plain.emission), strength=1.0)
    made.surface = made.add("add_shader", "shader", shader=seen, shader_001=light)
    return made


def _three(values: np.ndarray) -> tuple[float, ...]:
    return tuple(float(value) for value in values)

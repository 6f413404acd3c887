# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustic casters and media: the objects that make caustics or scatter light inside, at which photons are aimed."""

from typing import Any, cast

import numpy as np

from ...materials.compiler.graph_constants import LUMINANCE
from ...materials.nodes import KINDS
from ...materials.traits.interiors import Interior
from ...scene.materials import Material
from ...scene.node_graphs import Link, NodeGraph, ShaderNode
from ...scene.scene import Scene
from ..surfaces.geometry import Geometry

_MOST = 64
_SHARPEST_ROUGHNESS = 0.22
_LARGEST = 0.5


_LEAST = 0.05
"""Weight of a shader, and fraction of metal or glass in a Principled one, from which on it counts."""

_SPECULAR = {"bsdf_glass", "bsdf_refraction", "bsdf_glossy", "bsdf_metallic", "bsdf_principled"}


def _number(node: ShaderNode, name: str, unknown: float) -> float:
    """A constant input, of a color its luminance; what varies counts as ``unknown``."""
    value = node.inputs.get(name, KINDS[node.kind].inputs[name][1])
    if isinstance(value, Link):
        return unknown
    numbers = np.ravel(cast(Any, value))
    return float(numbers @ LUMINANCE if len(numbers) == 3 else numbers[0])


def _makes_caustics(node: ShaderNode) -> bool:
    if node.kind not in _SPECULAR or _number(node, "roughness", 0.0) > _SHARPEST_ROUGHNESS:
        return False
    if node.kind != "bsdf_principled":
        return True
    # A thin wall bends no light.
    bright = ("metallic",) if node.options.get("thin_wall") else ("metallic", "transmission_weight")
    fraction = max(_number(node, name, 1.0) for name in bright)
    return _number(node, "alpha", 1.0) * fraction > 2 * _LEAST


def _visible_shaders(graph: NodeGraph) -> list[ShaderNode]:
    """Shader nodes whose weight, as far as it is constant, is not next to nothing."""
    found: list[ShaderNode] = []
    pending: list[tuple[object, float]] = [(graph.surface, 1.0)]
    while pending:
        link, weight = pending.pop()
        if not isinstance(link, Link) or weight < _LEAST or not 0 <= link.node < len(graph.nodes):
            continue
        node = graph.nodes[link.node]
        shaders = node.inputs.get("shader"), node.inputs.get("shader_001")
        if node.kind == "mix_shader":
            factor = _number(node, "fac", np.nan)
            fractions = (1.0, 1.0) if np.isnan(factor) else (1.0 - factor, factor)
            pending += [(shader, weight * fraction) for shader, fraction in zip(shaders, fractions, strict=True)]
        elif node.kind == "add_shader":
            pending += [(shader, weight) for shader in shaders]
        else:
            found.append(node)
    return found


def caustic_targets(scene: Scene, geometry: Geometry) -> np.ndarray:
    """(n, 4) float32 bounding spheres, center and radius in meters, of up to 64 objects with sharp
    specular lobes or media that scatter. Objects half as large as the scene are none: photons meet them anyway."""

    def is_aimed_at(material: Material) -> bool:
        return bool(Interior.of(material.interior).scattering) or any(
            _makes_caustics(node) for node in _visible_shaders(material.graph)
        )

    casters = {index for index, material in enumerate(scene.materials) if is_aimed_at(material)}
    placements, spheres = geometry.placements if casters else [], []
    are_casters = [not casters.isdisjoint(placement.instance.materials) for placement in placements]
    for low, high in np.asarray(geometry.boxes)[np.flatnonzero(are_casters)]:
        radius = 0.5 * float(np.linalg.norm(high - low))
        if np.isfinite(radius) and 0 < radius < _LARGEST * geometry.radius:
            spheres.append([*(0.5 * (low + high)), radius])
    spheres.sort(key=lambda sphere: -sphere[3])
    return np.array(spheres[:_MOST], np.float32).reshape(-1, 4)

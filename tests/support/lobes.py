# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of scenes made without Blender: weighted sums of shader nodes with constant inputs."""

import enum

import numpy as np

from rppm_addon.materials.nodes import KINDS
from rppm_addon.scene import Link, Material, NodeGraph, World


class LobeKind(enum.Enum):
    """Shader nodes, with the names of their color and of their output."""

    DIFFUSE = "bsdf_diffuse"
    GLOSSY = "bsdf_glossy"
    GLASS = "bsdf_glass"
    REFRACTION = "bsdf_refraction"
    TRANSPARENT = "bsdf_transparent"
    TRANSLUCENT = "bsdf_translucent"
    SHEEN = "bsdf_sheen"
    HOLDOUT = "holdout"
    EMISSION = "emission"
    PRINCIPLED = "bsdf_principled"


class Lobe:
    """One shader node; further inputs of the node come by their names."""

    def __init__(
        self,
        kind: LobeKind,
        weight: float = 1.0,
        color: tuple[float, float, float] = (1.0, 1.0, 1.0),
        color_image: int = -1,
        roughness: float = 0.0,
        ior: float = 1.5,
        multiscatter: bool = True,
        **inputs: object,
    ) -> None:
        """color_image: index into Scene.images; it is placed by the UV map and multiplies ``color``."""
        self.kind, self.weight, self.color, self.color_image = kind, weight, color, color_image
        self.roughness, self.ior, self.multiscatter, self.inputs = roughness, ior, multiscatter, inputs


def material(name: str, *lobes: Lobe, absorption: np.ndarray | None = None, glow: np.ndarray | None = None) -> Material:
    """A material whose surface is the sum of the lobes, with a medium inside: its absorption, 1/m, and what it emits,
    W/(m^3 sr)."""
    graph = NodeGraph()
    for lobe in lobes:
        shader = _shader(graph, lobe)
        if lobe.weight != 1.0:
            shader = graph.add("mix_shader", "shader", fac=lobe.weight, shader_001=shader)
        graph.surface = (
            shader
            if graph.surface is None
            else graph.add("add_shader", "shader", shader=graph.surface, shader_001=shader)
        )
    if absorption is None and glow is None:
        return Material(name, graph)
    interior = NodeGraph()
    most = float(np.max(absorption)) if absorption is not None else 0.0
    color = tuple(1.0 - float(a) / most for a in absorption) if most > 0.0 else (1.0, 1.0, 1.0)
    interior.surface = interior.add("volume_absorption", "volume", color=color, density=most)
    if glow is not None:
        emission = interior.add("emission", "emission", color=tuple(float(e) for e in glow))
        interior.surface = interior.add("add_shader", "shader", shader=interior.surface, shader_001=emission)
    return Material(name, graph, interior)


def _shader(graph: NodeGraph, lobe: Lobe) -> Link:
    inputs: dict[str, object] = dict(lobe.inputs)
    color: object = lobe.color
    if lobe.color_image >= 0:
        place = graph.add("tex_coord", "uv")
        image = graph.add("tex_image", "color", image=lobe.color_image, vector=place)
        color = graph.add(
            "vector_math", "vector", options={"operation": "MULTIPLY"}, vector=image, vector_001=lobe.color
        )
    inputs["base_color" if lobe.kind is LobeKind.PRINCIPLED else "color"] = color
    options = {}
    if lobe.kind not in {LobeKind.TRANSPARENT, LobeKind.TRANSLUCENT, LobeKind.EMISSION, LobeKind.HOLDOUT}:
        inputs["roughness"] = lobe.roughness
    if lobe.kind in {LobeKind.GLASS, LobeKind.REFRACTION, LobeKind.PRINCIPLED}:
        inputs["ior"] = lobe.ior
    if lobe.kind in {LobeKind.GLOSSY, LobeKind.GLASS, LobeKind.PRINCIPLED}:
        options["distribution"] = "MULTI_GGX" if lobe.multiscatter else "GGX"
    if lobe.kind is LobeKind.REFRACTION:
        options["distribution"] = "GGX"
    output = next(iter(KINDS[lobe.kind.value].outputs))
    return graph.add(lobe.kind.value, output, options=options, **inputs)


def image_world(image: int) -> World:
    """A world that shows an equirectangular image of Scene.images."""
    graph = NodeGraph()
    direction = graph.add("new_geometry", "position")
    color = graph.add("tex_environment", "color", image=image, vector=direction)
    graph.surface = graph.add("background", "background", color=color, strength=1.0)
    return World(np.ones(3), graph)

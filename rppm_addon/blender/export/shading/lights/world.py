# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's world to a node graph."""

import copy
import functools

import bpy
import numpy as np
from mathutils import Vector

from .....materials.sky.sun import sun_disc
from .....scene import Light, LightKind, Link, Mist, NodeGraph, RayVisibility, ShaderNode, World
from .....scene.sky import Sky
from ...context import ExportContext
from ...images.color_spaces import working_space
from ...view_layer.layers import light_group_of
from ..nodes.graphs import GraphExporter
from ..nodes.inlining import readable_tree
from ..nodes.material_outputs import export_volume
from .lights import max_bounces_of

_EXPONENTS = {"LINEAR": 1.0, "QUADRATIC": 2.0, "INVERSE_QUADRATIC": 0.5}
"""Exponents of mist, by its falloff."""


_KINDS_OF_RAYS = {
    "camera": RayVisibility.CAMERA,
    "diffuse": RayVisibility.DIFFUSE,
    "glossy": RayVisibility.GLOSSY,
    "transmission": RayVisibility.TRANSMISSION,
    "scatter": RayVisibility.VOLUME_SCATTER,
}
"""Kinds of rays by the names that Cycles' properties of worlds have."""


def export_world(world: bpy.types.World | None, context: ExportContext) -> tuple[World, list[Light]]:
    """The environment, black where the scene has no world, and the suns of its skies, which no picture resolves."""
    if world is None:
        return World(), []
    environment, suns = _environment(world, context) if context.filter.environment else (World(), [])
    mist = world.mist_settings
    environment.mist = Mist(mist.start, mist.depth, _EXPONENTS[mist.falloff])
    environment.ambient_occlusion_distance = world.light_settings.distance
    for light in (environment, *suns):
        light.light_group = light_group_of(world)
        light.visibility, light.max_bounces = _visibility_of(world), max_bounces_of(world)
    return environment, suns


def _visibility_of(world: bpy.types.World) -> RayVisibility:
    """The rays that see the world; all where Cycles, whose property it is, is switched off."""
    said = getattr(world, "cycles_visibility", None)
    hidden = (kind for name, kind in _KINDS_OF_RAYS.items() if not getattr(said, name, True))
    return functools.reduce(lambda visibility, kind: visibility & ~kind, hidden, RayVisibility.ALL)


def _environment(world: bpy.types.World, context: ExportContext) -> tuple[World, list[Light]]:
    tree = readable_tree(world)
    if tree is None:
        return World(radiance=_finite(np.array(world.color, np.float64))), []
    owner = f'World "{world.name}"'
    output = tree.output
    if output is None:
        return World(), []
    exporter = GraphExporter(owner, context, tree)
    exporter.graph.surface = exporter.surface()
    volume = export_volume(owner, context, tree) if exporter.is_linked(output.inputs["Volume"], ()) else None
    if exporter.graph.surface is None:
        return World(volume=volume), []
    suns = [_sun(exporter.graph, index, sky, owner) for index, sky in exporter.skies.items()]
    return World(np.ones(3), exporter.graph, volume), [sun for sun in suns if sun is not None]


def _sun(graph: NodeGraph, index: int, sky: Sky, owner: str) -> Light | None:
    """The sun of a sky texture: what the world makes of its irradiance, apart from what does not depend on it."""
    disk = sun_disc(sky, working_space())
    if disk is None:
        return None
    nodes = copy.deepcopy(graph.nodes)
    nodes[index] = ShaderNode(
        "combine_color", inputs=dict(zip(("red", "green", "blue"), map(float, disk.irradiance())))
    )
    depends = {index}
    for number, node in enumerate(nodes):
        if any(isinstance(value, Link) and value.node in depends for value in node.inputs.values()):
            depends.add(number)
        elif node.kind in {"background", "emission"}:
            node.inputs["strength"] = 0.0
    backward = np.asarray(disk.direction, np.float64)  # lights shine along -Z
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(Vector(backward).to_track_quat("Z", "Y").to_matrix())
    return Light(f"{owner} sun", LightKind.SUN, matrix, np.ones(3), sun_angle=disk.angle,
                 graph=NodeGraph(nodes, graph.surface), of_world=True)  # fmt: skip


def _finite(radiance: np.ndarray) -> np.ndarray:
    return np.maximum(np.nan_to_num(radiance, nan=0.0, posinf=0.0, neginf=0.0), 0.0)

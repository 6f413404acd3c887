# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's world to constant radiance or an environment image."""

import bpy
import numpy as np
from mathutils import Euler

from ...scene import World
from .images import ImageTable
from .links import Path, Source, find_source, node_tree
from .report import Report
from .values import Evaluator


def export_world(world: bpy.types.World | None, report: Report, images: ImageTable) -> World:
    """The surroundings; black where the scene has no world."""
    if world is None:
        return World()
    tree = node_tree(world)
    if tree is None:
        return World(radiance=_finite(np.array(world.color, np.float64)))
    evaluator = Evaluator(f'World "{world.name}"', report, images)
    output = tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
    if output is None:
        return World()
    exported = World()
    if output.inputs["Volume"].is_linked:
        report.warn(f'World "{world.name}": its volume is not rendered yet and is ignored')
    for shader in evaluator.shaders(output.inputs["Surface"]):
        node, path = shader.node, shader.path
        if shader.type == "COLOR":
            _add_color(exported, shader.weight * evaluator.mean(shader.color), evaluator, node)
            continue
        if node.type not in {"BACKGROUND", "EMISSION"}:
            evaluator.warn(node, "gives no light in a world and counts as black")
            continue
        strength = shader.weight * max(evaluator.scalar(node.inputs["Strength"], path), 0.0)
        source = find_source(node.inputs["Color"], path)
        if isinstance(source, Source) and source.node.type == "TEX_ENVIRONMENT":
            _add_image(exported, strength, source, evaluator)
        elif isinstance(source, Source) and source.node.type == "TEX_SKY":
            evaluator.warn(source.node, "is not rendered yet; a plain blue sky stands in")
            _add_color(exported, strength * np.array(SKY), evaluator, node)
        else:
            _add_color(exported, strength * evaluator.mean_color(node.inputs["Color"], path), evaluator, node)
    return exported


SKY = (0.28, 0.40, 0.62)
"""Stands in for a sky texture: roughly the mean of a clear one."""


def _add_color(world: World, radiance: np.ndarray, evaluator: Evaluator, node: bpy.types.Node) -> None:
    if world.image >= 0:
        if radiance.any():
            evaluator.warn(node, "adds a colour to an environment image, which is not rendered yet; it is ignored")
        return
    world.radiance = world.radiance + _finite(radiance)


def _add_image(world: World, strength: float, source: Source, evaluator: Evaluator) -> None:
    node = source.node
    if strength == 0.0:
        return
    if node.image is None:
        evaluator.warn(node, "has no image and counts as magenta; choose one")
        _add_color(world, strength * np.array([1.0, 0.0, 1.0]), evaluator, node)
        return
    index = evaluator.images.index(node.image, node, evaluator)
    if index is None:
        _add_color(world, strength * np.array([1.0, 0.0, 1.0]), evaluator, node)
    elif node.projection != "EQUIRECTANGULAR":
        evaluator.warn(node, f"has the projection {node.projection}, which is not rendered yet; its mean is used")
        _add_color(world, strength * evaluator.images.mean(index), evaluator, node)
    elif world.image >= 0:
        evaluator.warn(node, "adds a second environment image, which is not rendered yet; it is ignored")
    else:
        if world.radiance.any():
            evaluator.warn(node, "is mixed with a colour, which is not rendered yet; the colour is ignored")
        world.image = index
        world.radiance = np.full(3, strength)
        world.rotation = _rotation(node, source.path, evaluator)


def _rotation(node: bpy.types.Node, path: Path, evaluator: Evaluator) -> np.ndarray:
    """(3, 3) float64 that turns a world direction to the direction looked up in the image."""
    source = find_source(node.inputs["Vector"], path)
    if not isinstance(source, Source) or source.node.type == "TEX_COORD":
        if isinstance(source, Source) and source.output.name not in {"Generated", "Object"}:
            evaluator.warn(source.node, f'places an environment by "{source.output.name}"; the direction is used')
        return np.eye(3)
    mapping = source.node
    if mapping.type != "MAPPING":
        evaluator.warn(mapping, "places an environment image, which is not rendered yet; it stays unrotated")
        return np.eye(3)
    inner = find_source(mapping.inputs["Vector"], source.path)
    if isinstance(inner, Source) and inner.node.type != "TEX_COORD":
        evaluator.warn(inner.node, "places an environment image, which is not rendered yet; it is ignored")
    angles = _vector(mapping, "Rotation", source.path, evaluator)
    if (_vector(mapping, "Scale", source.path, evaluator) != 1.0).any():
        evaluator.warn(mapping, "scales an environment image, which is not rendered yet; only its rotation is used")
    if mapping.vector_type in {"POINT", "TEXTURE"} and _vector(mapping, "Location", source.path, evaluator).any():
        evaluator.warn(mapping, "moves an environment image, which is not rendered yet; only its rotation is used")
    rotation = np.array(Euler(angles.tolist()).to_matrix(), np.float64)
    return rotation.T if mapping.vector_type == "TEXTURE" else rotation


def _vector(node: bpy.types.Node, name: str, path: Path, evaluator: Evaluator) -> np.ndarray:
    socket = next((socket for socket in node.inputs if socket.name == name), None)
    if socket is None:
        return np.zeros(3)
    return evaluator.mean_color(socket, path)


def _finite(radiance: np.ndarray) -> np.ndarray:
    return np.maximum(np.nan_to_num(radiance, nan=0.0, posinf=0.0, neginf=0.0), 0.0)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Differences between two scenes that share the members that did not change."""

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...scene.node_graphs import Link, NodeGraph
from ...scene.scene import Scene
from ...scene.storage.sharing import LISTS, same_members

_CAMERA_OUTPUTS = {("tex_coord", "camera"), ("tex_coord", "window")}


@dataclass
class Changes:
    """The parts of a scene that are not those of the scene before."""

    materials: bool
    """Node graphs and images, those of lights and the world included."""
    geometry: bool
    lights: bool
    """Lights, the world, or how many photons they are allocated."""
    world: bool
    """The world, its images, or the camera if its nodes ask for it."""
    light_objects: bool
    """Light objects, their images, or the camera if their nodes ask for it."""
    cubemap: bool
    """Where the deep cubemap is asked to be, and how fine."""
    levels: bool
    """Settings, and what is baked, by which instances are expanded (instancing.py), and the numbers of paths, each of
    which needs places for what it hits on the others."""


def changes_between(before: Scene | None, after: Scene) -> Changes:
    """Members are compared by identity, the settings by value; all has changed where before is None, or where the
    working space is another."""
    if before is None or before.working_space != after.working_space:
        return Changes(True, True, True, True, True, True, True)
    images = not same_members(before.images, after.images)
    camera = before.camera is not after.camera
    world = images or before.world is not after.world or (camera and _asks_for_camera([after.world.graph]))
    graphs = [light.graph for light in after.lights]
    graphs_before = [light.graph for light in before.lights]
    light_objects = images or not same_members(before.lights, after.lights) or (camera and _asks_for_camera(graphs))
    return Changes(
        materials=images
        or before.settings.aovs != after.settings.aovs
        or not same_members(before.materials, after.materials)
        or not same_members(
            [*graphs_before, before.world.graph, before.world.volume], [*graphs, after.world.graph, after.world.volume]
        ),
        geometry=not same_members(before.instances, after.instances)
        or not same_members(before.meshes, after.meshes)
        or len(before.materials) != len(after.materials),
        lights=world
        or light_objects
        or after.photon_count != before.photon_count
        or before.settings.light_groups != after.settings.light_groups,
        world=world,
        light_objects=light_objects,
        cubemap=after.settings.cubemap_resolution != before.settings.cubemap_resolution
        or not np.array_equal(_point(before), _point(after), equal_nan=True),
        levels=_levels(before) != _levels(after),
    )


def snapshot(scene: Scene) -> Scene:
    """The scene as it is now, to be compared with later: its lists may grow afterwards."""
    copies: dict[str, Any] = {name: list(getattr(scene, name)) for name in LISTS}
    return dataclasses.replace(scene, settings=dataclasses.replace(scene.settings), **copies)


def _point(scene: Scene) -> np.ndarray:
    return np.full(3, np.nan) if scene.cubemap_center is None else np.asarray(scene.cubemap_center)


def _levels(scene: Scene) -> tuple[object, ...]:
    settings, texels = scene.settings, scene.camera.texels
    return (
        settings.instancing,
        settings.first_camera_hits,
        None if texels is None else texels.instance,
        scene.camera.resolution,
        scene.photon_count,
        scene.shutter is not None and scene.shutter.is_rolling,
    )


def _asks_for_camera(graphs: list[NodeGraph | None]) -> bool:
    """Whether a graph that is evaluated beforehand holds a node that may look at the camera."""
    nodes = [(graph, node) for graph in graphs if graph is not None for node in graph.nodes]
    return any(
        node.kind == "camera"
        or (node.kind == "vector_transform" and "CAMERA" in node.options.values())
        or any(
            isinstance(value, Link) and (graph.nodes[value.node].kind, value.output) in _CAMERA_OUTPUTS
            for value in node.inputs.values()
        )
        for graph, node in nodes
    )

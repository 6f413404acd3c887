# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripted scenes of many instances, saved as .blend files that either engine renders."""

import math
from collections.abc import Callable
from pathlib import Path

import bpy
import mathutils
import numpy as np

from .shapes import Shape, building, car, lamp, leaves, mesh_of, window

WIDTH, HEIGHT = 240, 160
MOVED = "Moved"
"""Name of the object that move() moves: an object of its own, or the points that have the instances."""


def _stage(eye: tuple[float, ...], target: tuple[float, ...]) -> bpy.types.Scene:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.clip_end = 1e5
    way = mathutils.Vector(target) - mathutils.Vector(eye)
    camera.location, camera.rotation_euler = eye, way.to_track_quat("-Z", "Y").to_euler()
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler, sun.data.energy = (0.7, 0.2, 0.4), 3.0
    for added in (camera, sun):
        scene.collection.objects.link(added)
    scene.camera, scene.world = camera, bpy.data.worlds.new("World")
    return scene


def _material(name: str, color: tuple[float, float, float]) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1.0)
    return material


def _link(name: str, data: bpy.types.ID) -> bpy.types.Object:
    added = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(added)
    return added


def _ground(half: float) -> None:
    corners = np.array([[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]])
    _link("Ground", mesh_of("Ground", (corners, np.arange(4)[None]), _material("Earth", (0.4, 0.3, 0.2))))


def _places(count: int, spacing: float, rng: np.random.Generator) -> np.ndarray:
    """(n, 3) places in a square, a bit off a grid, meters."""
    side = math.ceil(math.sqrt(count))
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)[:count]
    places = (grid - 0.5 * side) * spacing + rng.uniform(-0.3, 0.3, (count, 2)) * spacing
    return np.pad(places, ((0, 0), (0, 1)))


def _instances_on_points(source: bpy.types.Object) -> bpy.types.NodeTree:
    """Geometry nodes that put an object on each vertex, turned and scaled by chance."""
    tree = bpy.data.node_groups.new("Trees", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    make = tree.nodes.new
    points, result, place = make("NodeGroupInput"), make("NodeGroupOutput"), make("GeometryNodeInstanceOnPoints")
    of_source, turn, scale = (
        make("GeometryNodeObjectInfo"),
        make("FunctionNodeRandomValue"),
        make("FunctionNodeRandomValue"),
    )
    of_source.inputs["Object"].default_value = source
    of_source.inputs["As Instance"].default_value = True
    turn.data_type = "FLOAT_VECTOR"
    turn.inputs[0].default_value, turn.inputs[1].default_value = (0.0, 0.0, 0.0), (0.0, 0.0, 2.0 * math.pi)
    scale.inputs[2].default_value, scale.inputs[3].default_value = 0.7, 1.3
    for output, target in (
        (points.outputs[0], place.inputs["Points"]),
        (of_source.outputs["Geometry"], place.inputs["Instance"]),
        (turn.outputs[0], place.inputs["Rotation"]),
        (scale.outputs[1], place.inputs["Scale"]),
        (place.outputs["Instances"], result.inputs[0]),
    ):
        tree.links.new(output, target)
    return tree


def forest(trees: int, triangles: int) -> None:
    """Trees of so many triangles each, seen from above their tops at the edge."""
    half = 1.5 * math.ceil(math.sqrt(trees))
    _stage((0.0, -0.6 * half, 8.0), (0.0, 0.0, 0.0))
    _ground(2.0 * half)
    tree = _link("Tree", mesh_of("Tree", leaves(triangles, 0), _material("Leaves", (0.1, 0.5, 0.1))))
    tree.hide_render = tree.hide_viewport = True
    points = bpy.data.meshes.new(MOVED)
    points.vertices.add(trees)
    points.vertices.foreach_set("co", _places(trees, 3.0, np.random.default_rng(0)).astype(np.float32).ravel())
    _link(MOVED, points).modifiers.new("Trees", "NODES").node_group = _instances_on_points(tree)


_KINDS: dict[str, tuple[Callable[[np.random.Generator], Shape], float, float, tuple[float, float, float]]] = {
    "Building": (building, 0.15, 0.03, (0.6, 0.55, 0.5)),
    "Window": (window, 0.5, 0.77, (0.3, 0.4, 0.5)),
    "Car": (car, 0.25, 0.16, (0.5, 0.1, 0.1)),
    "Lamp": (lamp, 0.1, 0.04, (0.2, 0.2, 0.2)),
}
"""Each with its part of the meshes and of the objects, and its color."""


def city(objects: int, meshes: int) -> None:
    """Objects of some hundred to some thousand triangles that share meshes: buildings, their windows, cars, lamps."""
    rng = np.random.default_rng(1)
    towers = _places(max(1, round(objects * _KINDS["Building"][2])), 30.0, rng)
    half = float(np.abs(towers).max()) + 30.0
    _stage((0.0, -0.9 * half, 60.0), (0.0, 0.0, 15.0))
    _ground(2.0 * half)
    left = objects
    for name, (make, of_meshes, of_objects, color) in _KINDS.items():
        material = _material(name, color)
        made = [mesh_of(f"{name}{n}", make(rng), material) for n in range(max(1, round(meshes * of_meshes)))]
        count = left if name == list(_KINDS)[-1] else max(1, round(objects * of_objects))
        left -= count
        towers_of = towers[rng.integers(len(towers), size=count)] if name != "Building" else towers[:count]
        angles = rng.uniform(0.0, 2.0 * math.pi, count)
        outward = np.stack([np.cos(angles), np.sin(angles), np.zeros(count)], axis=1)
        away = {"Building": 0.0, "Window": 9.5}.get(name, 0.0) + (
            rng.uniform(12, 16, count) if name in ("Car", "Lamp") else 0
        )
        places = towers_of + outward * np.broadcast_to(away, count)[:, None]
        if name == "Window":
            places[:, 2] = rng.uniform(2.0, 40.0, count)
        for number, (place, angle) in enumerate(zip(places.tolist(), angles.tolist(), strict=True)):
            moved = name == "Car" and number == 0
            added = _link(MOVED if moved else f"{name}{number}", made[number % len(made)])
            added.location, added.rotation_euler = place, (0.0, 0.0, angle + 0.5 * math.pi)


SCENES: dict[str, tuple[Callable[[int, int], None], tuple[int, int]]] = {
    "forest": (forest, (1_000_000, 100_000)),
    "city": (city, (50_000, 2_000)),
}
"""Each with its sizes: trees and triangles of each; objects and meshes."""


def saved(name: str, divisor: int, folder: Path) -> Path:
    """Path of a scene's .blend file, which is made where it is not there yet. divisor: of all its sizes."""
    make, sizes = SCENES[name]
    sizes = tuple(max(size // divisor, 4) for size in sizes)
    path = folder / f"{name}_{sizes[0]}_{sizes[1]}.blend"
    if not path.exists():
        make(*sizes)
        folder.mkdir(parents=True, exist_ok=True)
        bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    return path


def settle() -> None:
    """Give the open file the resolution of the scenes, and show the children of particles that are rendered."""
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = WIDTH, HEIGHT, 100
    for particles in bpy.data.particles:
        particles.child_percent = particles.rendered_child_count


def has_moved() -> bool:
    """Return True where the open file is one of these scenes, of which one instance can be moved."""
    return MOVED in bpy.data.objects


def move() -> None:
    """Move one instance of the open scene by a meter."""
    moved = bpy.data.objects[MOVED]
    if moved.data.polygons:
        moved.location.x += 1.0
    else:
        moved.data.vertices[len(moved.data.vertices) // 2].co.x += 1.0
        moved.data.update()

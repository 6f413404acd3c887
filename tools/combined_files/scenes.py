# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of the kinds of files, and the objects, lights, cameras and worlds that they are put together from."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import bmesh
import bpy
from mathutils import Vector

from .draws import Draws

KINDS: dict[str, Callable[[Draws], None]] = {}
"""Functions that fill the empty scene with a file of each kind, by name."""
SIZE = (64, 48)
"""Pixels of the pictures."""
Place = Sequence[float]


def kind(make: Callable[[Draws], None]) -> Callable[[Draws], None]:
    """Put a kind of file on the list, by the name of its function."""
    KINDS[make.__name__] = make
    return make


def begin() -> bpy.types.Scene:
    """An empty scene with a camera, in Cycles."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    return scene


def camera(at: Place, toward: Place, lens: float = 35.0) -> bpy.types.Camera:
    """The scene's camera, at a place and turned toward another."""
    data = bpy.data.cameras.new("Camera")
    data.lens = lens
    bpy.context.scene.camera = add("Camera", data, at, rotation=turned(at, toward))
    return data


def turned(at: Place, toward: Place) -> Place:
    """The rotation of what stands at a place and faces another along its -Z."""
    return (Vector(toward) - Vector(at)).to_track_quat("-Z", "Y").to_euler()


def add(
    name: str, data: Any, at: Place = (0, 0, 0), rotation: Place = (0, 0, 0), scale: Place = (1, 1, 1)
) -> bpy.types.Object:
    """An object with data, which several may share, in the scene's collection."""
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler, made.scale = at, rotation, scale
    bpy.context.scene.collection.objects.link(made)
    return made


def lamp(kind: str, at: Place, watts: float, toward: Place | None = None, **settings: Any) -> bpy.types.Object:
    """A light; settings by the names of its properties."""
    data = bpy.data.lights.new(kind.title(), kind)
    data.energy = watts
    for name, value in settings.items():
        setattr(data, name, value)
    return add(kind.title(), data, at, turned(at, toward) if toward is not None else (0, 0, 0))


def world(color: Place, strength: float = 1.0) -> bpy.types.NodeTree:
    """A world of a color; its node tree."""
    made = bpy.data.worlds.new("World")
    made.use_nodes = True
    background = made.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color[:3], 1.0)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = made
    return made.node_tree


def shape(
    kind: str, paint: bpy.types.Material | Sequence[bpy.types.Material] | None, smooth: bool = False, **options: Any
) -> bpy.types.Mesh:
    """A primitive with texture coordinates; options are those of bmesh.ops.create_*."""
    defaults: dict[str, dict[str, Any]] = {
        "cube": {"size": 1.0},
        "uvsphere": {"u_segments": 24, "v_segments": 12, "radius": 0.5},
        "icosphere": {"subdivisions": 2, "radius": 0.5},
        "cone": {"segments": 20, "radius1": 0.5, "radius2": 0.0, "depth": 1.0, "cap_ends": True},
        "grid": {"x_segments": 1, "y_segments": 1, "size": 0.5},
        "monkey": {},
    }
    made = bpy.data.meshes.new(kind.title())
    building = bmesh.new()
    building.loops.layers.uv.new("UVMap")
    getattr(bmesh.ops, f"create_{kind}")(building, calc_uvs=True, **{**defaults[kind], **options})
    for face in building.faces:
        face.smooth = smooth
    building.to_mesh(made)
    building.free()
    for one in paint if isinstance(paint, Sequence) else [paint] if paint else []:
        made.materials.append(one)
    return made


def cylinder(paint: bpy.types.Material | None, radius: float, depth: float, segments: int = 20) -> bpy.types.Mesh:
    """A closed cylinder around Z."""
    return shape("cone", paint, radius1=radius, radius2=radius, depth=depth, segments=segments)


def modifier(thing: bpy.types.Object, kind: str, **settings: Any) -> bpy.types.Modifier:
    """A modifier at the end of an object's stack."""
    made = thing.modifiers.new(kind.title(), kind)
    for name, value in settings.items():
        setattr(made, name, value)
    return made


def text(
    words: str, paint: bpy.types.Material, at: Place, rotation: Place = (math.pi / 2, 0, 0), **settings: Any
) -> Any:
    """A text object."""
    data = bpy.data.curves.new("Text", "FONT")
    data.body = words
    data.materials.append(paint)
    for name, value in settings.items():
        setattr(data, name, value)
    return add("Text", data, at, rotation)


def curve(points: Sequence[Place], paint: bpy.types.Material, bevel: float, kind: str = "BEZIER") -> bpy.types.Object:
    """A curve through points, a round tube."""
    data = bpy.data.curves.new("Curve", "CURVE")
    data.dimensions, data.bevel_depth, data.use_fill_caps = "3D", bevel, True
    spline = data.splines.new(kind)
    if kind == "BEZIER":
        spline.bezier_points.add(len(points) - 1)
        for point, place in zip(spline.bezier_points, points, strict=True):
            point.co, point.handle_left_type, point.handle_right_type = place, "AUTO", "AUTO"
    else:
        spline.points.add(len(points) - 1)
        for point, place in zip(spline.points, points, strict=True):
            point.co = (*place, 1.0)
        spline.use_endpoint_u = True
    data.materials.append(paint)
    return add("Curve", data)


def collection(name: str, things: Sequence[bpy.types.Object]) -> bpy.types.Collection:
    """A collection of objects that is in the scene by its instances alone."""
    made = bpy.data.collections.new(name)
    for thing in things:
        for holder in list(thing.users_collection):
            holder.objects.unlink(thing)
        made.objects.link(thing)
    return made


def instance(of: bpy.types.Collection, at: Place, rotation: Place = (0, 0, 0), scale: Place = (1, 1, 1)) -> Any:
    """An instance of a collection."""
    made = add(of.name, None, at, rotation, scale)
    made.instance_type, made.instance_collection = "COLLECTION", of
    return made


def keyed(thing: Any, path: str, values: Sequence[tuple[float, Any]]) -> None:
    """Animate a property by keyframes of a frame and a value."""
    for frame, value in values:
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)

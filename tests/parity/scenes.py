# SPDX-License-Identifier: GPL-3.0-or-later
"""Small Blender scenes made in Python."""

import functools
import math
from collections.abc import Sequence

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .net import Net
from .net import material as net_material

RESOLUTION = 64
DIFFUSE, GLOSSY, GLASS = "ShaderNodeBsdfDiffuse", "ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfGlass"
PRINCIPLED, EMISSION = "ShaderNodeBsdfPrincipled", "ShaderNodeEmission"


@functools.cache
def _take_factory_preferences() -> None:
    """Once: with the preferences Blender brings up its add-ons anew, which takes five times as long as a scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)


def new_scene(resolution: int = RESOLUTION, world: float = 0.0) -> bpy.types.Scene:
    """An empty scene whose Cycles settings leave nothing out and clamp nothing."""
    _take_factory_preferences()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.blur_glossy = cycles.sample_clamp_indirect = cycles.sample_clamp_direct = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 64
    cycles.transmission_bounces = cycles.transparent_max_bounces = 64
    scene.render.resolution_x = scene.render.resolution_y = resolution
    image = scene.render.image_settings
    if hasattr(image, "media_type"):  # Blender 5
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format = "OPEN_EXR_MULTILAYER"
    image.color_depth = "32"
    scene.world = bpy.data.worlds.new("World")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    background().inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    background().inputs["Strength"].default_value = world
    return scene


def material(shader: str, distribution: str | None = None, **inputs: float | Sequence[float]) -> bpy.types.Material:
    """One shader node on the surface output; inputs by socket name with _ for a space."""
    made, net = net_material("Material")
    properties = {} if distribution is None else {"distribution": distribution}
    given = {name.replace("_", " "): value for name, value in inputs.items()}
    net.output(net.out(shader.removeprefix("ShaderNode"), 0, given, **properties))
    return made


def background() -> bpy.types.Node:
    """The Background of the current scene's world."""
    return Net(bpy.context.scene.world.node_tree).find("BACKGROUND")


def place(
    at: Sequence[float] = (0, 0, 0), turn: Sequence[float] = (0, 0, 0), scale: Sequence[float] = (1, 1, 1)
) -> Matrix:
    """Object to world: scaled, turned about X, Y, Z in turn (degrees), moved."""
    rotation = Matrix.Identity(4)
    for angle, axis in zip(turn, "XYZ"):
        rotation = Matrix.Rotation(math.radians(angle), 4, axis) @ rotation
    return Matrix.Translation(Vector(at)) @ rotation @ Matrix.Diagonal((*scale, 1.0))


def mesh_object(
    vertices: Sequence, faces: Sequence, surface: bpy.types.Material, matrix: Matrix | None = None, name: str = "Mesh"
) -> bpy.types.Object:
    """An object of a mesh of one material, in the current scene."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(vertices, [], faces)
    data.materials.append(surface)
    return link_object(data, matrix)


def link_object(data: bpy.types.ID | None, matrix: Matrix | None = None, name: str = "") -> bpy.types.Object:
    """An object of some data, by the data's name if none is given, in the current scene."""
    made = bpy.data.objects.new(name or data.name, data)
    bpy.context.scene.collection.objects.link(made)
    if matrix is not None:
        made.matrix_world = matrix
    return made


def plane(half: float, surface: bpy.types.Material, matrix: Matrix | None = None) -> bpy.types.Object:
    """A square in XY that faces +Z."""
    corners = [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)]
    return mesh_object(corners, [(0, 1, 2, 3)], surface, matrix)


def box(half: Sequence[float], surface: bpy.types.Material, matrix: Matrix | None = None) -> bpy.types.Object:
    """A closed box about the origin, normals outward."""
    x, y, z = half
    corners = [(i * x, j * y, k * z) for k in (-1, 1) for j in (-1, 1) for i in (-1, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return mesh_object(corners, faces, surface, matrix)


def ball(
    radius: float, surface: bpy.types.Material, matrix: Matrix | None = None, segments: int = 64
) -> bpy.types.Object:
    """A smooth sphere of segments x segments / 2 faces."""
    around, rings = np.arange(segments) * 2 * np.pi / segments, segments // 2
    vertices = [(0, 0, -radius)]
    for ring in range(1, rings):
        height = -math.cos(math.pi * ring / rings)
        width = math.sin(math.pi * ring / rings)
        vertices += [(radius * width * math.cos(a), radius * width * math.sin(a), radius * height) for a in around]
    vertices.append((0, 0, radius))
    top, faces = len(vertices) - 1, []
    for i in range(segments):
        j = (i + 1) % segments
        faces.append((0, 1 + j, 1 + i))
        faces.append((top, top - segments + i, top - segments + j))
        for ring in range(rings - 2):
            low, high = 1 + ring * segments, 1 + (ring + 1) * segments
            faces.append((low + i, low + j, high + j, high + i))
    made = mesh_object(vertices, faces, surface, matrix)
    made.data.shade_smooth()
    return made


def light(kind: str, energy: float, matrix: Matrix, **properties: object) -> bpy.types.Object:
    """A light object; properties by Blender's names."""
    data = bpy.data.lights.new("Light", kind)
    data.energy = energy
    for name, value in properties.items():
        setattr(data, name, value)
    return link_object(data, matrix)


def camera(at: Sequence[float], toward: Sequence[float], angle: float = 40.0) -> bpy.types.Object:
    """The scene's camera; ``angle`` is the field of view in degrees."""
    data = bpy.data.cameras.new("Camera")
    data.angle = math.radians(angle)
    data.clip_start, data.clip_end = 0.01, 100.0
    direction = Vector(toward) - Vector(at)
    made = link_object(data, Matrix.Translation(Vector(at)) @ direction.to_track_quat("-Z", "Y").to_matrix().to_4x4())
    bpy.context.scene.camera = made
    return made


def orthographic_camera(scale: float, matrix: Matrix | None = None) -> bpy.types.Object:
    """The scene's camera, which looks along its -Z at ``scale`` meters."""
    data = bpy.data.cameras.new("Camera")
    data.type, data.ortho_scale = "ORTHO", scale
    bpy.context.scene.camera = link_object(data, matrix)
    return bpy.context.scene.camera

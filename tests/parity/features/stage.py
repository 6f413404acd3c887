# SPDX-License-Identifier: GPL-3.0-or-later
"""The sets that features are shown on."""

import itertools
import math

import bmesh
import bpy

from ..scenes import background, camera, light, link_object, new_scene, place

BALL = {"at": (0.1, 0.0, 0.95), "turn": (25.0, -15.0, 40.0), "scale": (1.0, 0.85, 1.1)}
GROUND = {"at": (0.0, 0.2, 0.0), "turn": (0.0, 0.0, 20.0), "scale": (1.0, 1.3, 1.0)}


def mesh_object(mesh: bmesh.types.BMesh, name: str, surface: bpy.types.Material | None, where: dict):
    """An object of a mesh, which is freed."""
    data = bpy.data.meshes.new(name)
    mesh.to_mesh(data)
    mesh.free()
    if surface is not None:
        data.materials.append(surface)
    return link_object(data, place(**where), name)


def ball(surface: bpy.types.Material | None, where: dict = BALL, segments: int = 32) -> bpy.types.Object:
    """A smooth sphere of radius 0.9 with a UV map.

    Its own mesh, since bmesh's sphere orders its parts differently in each run, and so gives other random numbers.
    """
    rings = segments // 2
    mesh = bmesh.new()
    uv = mesh.loops.layers.uv.new("UVMap")
    poles = mesh.verts.new((0.0, 0.0, -0.9)), mesh.verts.new((0.0, 0.0, 0.9))
    rows = [[poles[0]] * segments]
    for ring in range(1, rings):
        z, radius = -0.9 * math.cos(math.pi * ring / rings), 0.9 * math.sin(math.pi * ring / rings)
        turns = [2.0 * math.pi * segment / segments for segment in range(segments)]
        rows.append([mesh.verts.new((radius * math.cos(turn), radius * math.sin(turn), z)) for turn in turns])
    rows.append([poles[1]] * segments)
    for ring, segment in itertools.product(range(rings), range(segments)):
        # Cycles stretches hair along an edge of each triangle: corners 0 and 2, about as bmesh's sphere has it.
        corners = [(ring + 1, segment), (ring, segment), (ring, segment + 1), (ring + 1, segment + 1)]
        if ring == 0:
            del corners[2]
        if ring == rings - 1:
            del corners[3]
        face = mesh.faces.new([rows[row][column % segments] for row, column in corners])
        for loop, (row, column) in zip(face.loops, corners, strict=True):
            at_pole = 0.5 if row in (0, rings) else 0.0
            loop[uv].uv = ((column + at_pole) / segments, row / rings)
    made = mesh_object(mesh, "Ball", surface, where)
    made.data.shade_smooth()
    return made


def ground(surface: bpy.types.Material | None, half: float = 2.2, where: dict = GROUND) -> bpy.types.Object:
    """A square of 2 x 2 faces with a UV map."""
    mesh = bmesh.new()
    mesh.loops.layers.uv.new("UVMap")
    bmesh.ops.create_grid(mesh, x_segments=2, y_segments=2, size=half, calc_uvs=True)
    return mesh_object(mesh, "Ground", surface, where)


def set_up(surface: bpy.types.Material | None, world: float = 0.0, ground_surface: bpy.types.Material | None = None):
    """A ball on the ground before the camera, of the same material unless the ground's is given. An empty scene must
    be there (empty)."""
    made = ball(surface), ground(ground_surface or surface)
    camera((0.4, -4.6, 2.3), (0.1, 0.0, 0.62), 34.0)
    background().inputs["Strength"].default_value = world
    # By itself Cycles takes seconds for a map of a world's nodes.
    bpy.context.scene.world.cycles.sampling_method = "MANUAL"
    bpy.context.scene.world.cycles.sample_map_resolution = 256
    return made


def empty() -> None:
    """A new scene with a black world."""
    new_scene()


def area_light() -> bpy.types.Object:
    """The area light that lights what is lit."""
    return light("AREA", 90.0, place(at=(1.6, -1.6, 3.0), turn=(35.0, 25.0, 0.0)), shape="SQUARE", size=1.4)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading normals of meshes as the running Blender's Cycles has them, pixel by pixel: flat faces that are not plane,
smooth ones beside flat, sharp edges, edges of three faces, custom normals; from both sides, and mirrored."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Vector

from ..engines import cycles_pass, render_final, unfilter
from ..scenes import camera, new_scene
from .edited import add

N = 3
"""Faces a side of a square that bends."""


def bent(smooth: bool = True, flat: tuple[int, ...] = (), sharp: tuple[int, ...] = ()) -> bpy.types.Object:
    """flat: faces; sharp: edges."""

    def height(x: float, y: float) -> float:
        return 0.3 * x * y + 0.2 * x * x

    places = [(-1 + 2 * i / N, -1 + 2 * j / N) for j in range(N + 1) for i in range(N + 1)]
    corners = ((0, 0), (1, 0), (1, 1), (0, 1))
    faces = [[(j + y) * (N + 1) + i + x for x, y in corners] for j in range(N) for i in range(N)]
    made = add("Bent", ([(x, y, height(x, y)) for x, y in places], faces))
    for number, polygon in enumerate(made.data.polygons):
        polygon.use_smooth = smooth and number not in flat
    for edge in sharp:
        made.data.edges[edge].use_edge_sharp = True
    return made


def tube(sharp: tuple[int, ...] = ()) -> bpy.types.Object:
    """It lies along y, with a disk in its middle, around which each edge has three faces."""
    around = [2 * math.pi * i / 16 for i in range(16)]
    vertices = [(math.cos(angle), y, -math.sin(angle)) for y in (-1, 0, 1) for angle in around]
    quad = ((0, 0), (0, 1), (1, 1), (1, 0))
    faces = [[16 * (k + up) + (i + on) % 16 for up, on in quad] for k in (0, 1) for i in range(16)]
    made = add("Tube", (vertices, [*faces, list(range(16, 32))]))
    made.data.shade_smooth()
    for edge in sharp:
        made.data.edges[edge].use_edge_sharp = True
    return made


def with_custom_normals(made: bpy.types.Object) -> bpy.types.Object:
    """The same on all of a face."""
    normals = [_leaning(face.index) for face in made.data.polygons for _ in face.vertices]
    made.data.normals_split_custom_set(normals)
    return made


def with_free_normals(made: bpy.types.Object) -> bpy.types.Object:
    """As with_custom_normals, but no edge is sharp by them."""
    attribute = made.data.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER")
    for face in made.data.polygons:
        for corner in face.loop_indices:
            attribute.data[corner].vector = _leaning(face.index)
    return made


def _leaning(number: int) -> Vector:
    return Vector((math.sin(number), math.cos(number), 2.0)).normalized()


CASES = {
    "flat": lambda: bent(smooth=False),
    "flat with a sharp edge": lambda: bent(smooth=False, sharp=(3,)),
    "mixed": lambda: bent(flat=(0, 4, 7)),
    "mixed with a sharp edge": lambda: bent(flat=(0, 4, 7), sharp=(0,)),
    "smooth": bent,
    "smooth with sharp edges": lambda: bent(sharp=(3, 8, 9, 15)),
    "three faces": tube,
    "three faces and a sharp edge": lambda: tube(sharp=(0,)),
    "custom": lambda: with_custom_normals(bent()),
    "custom on flat faces": lambda: with_custom_normals(bent(flat=(0, 4, 7))),
    "free": lambda: with_free_normals(bent()),
}


SCALES = [
    pytest.param((1.0, 1.0, 1.0), id="plain"),
    pytest.param((1.0, -0.8, 1.3), id="mirrored", marks=pytest.mark.long),
]


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("side", ["front", "back"])
@pytest.mark.parametrize("case", CASES)
def test_normals_of_meshes(renderer, case, side, scale):
    if case == "free" and bpy.app.version < (5, 0):
        pytest.skip("such normals came with Blender 5")
    new_scene(32)
    unfilter()
    scene = bpy.context.scene
    CASES[case]().scale = scale
    seen = camera((0.013, 0.007, 5.0 if side == "front" else -5.0), (0.013, 0.007, 0.0))
    seen.data.type, seen.data.ortho_scale = "ORTHO", 1.47
    scene.rppm.filter_width = 0.0
    reference = cycles_pass()
    (picture,) = render_final(samples=1, seeds=1)
    assert reference.min() >= 0.0 and reference.std(axis=(0, 1)).max() > 0.02
    difference = np.abs(picture - reference).max(axis=-1)
    assert np.count_nonzero(difference > 2e-3) <= 2, np.sort(difference.ravel())[-5:]  # at edges of triangles

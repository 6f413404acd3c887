# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangles of a Blender mesh as an array, by the quickest way that is right."""

import ctypes
import logging

import bpy
import numpy as np

logger = logging.getLogger(__name__)

_pointer_view_is_right: bool | None = None
"""What the first mesh of this session with two triangles or more has shown; None before it."""


def triangle_corners(mesh: bpy.types.Mesh) -> np.ndarray:
    """Corner (loop) indices of the mesh's triangles.

    calc_loop_triangles() must have been called. Returns a copy: (triangles, 3) int32.
    """
    global _pointer_view_is_right
    if len(mesh.loop_triangles) < 2:
        return _by_foreach_get(mesh)
    if _pointer_view_is_right is None:
        _pointer_view_is_right = pointer_view_is_right(mesh)
        if not _pointer_view_is_right:
            logger.info("Blender's triangles are not three ints in a row; they are read through foreach_get")
    return _by_pointer(mesh) if _pointer_view_is_right else _by_foreach_get(mesh)


def pointer_view_is_right(mesh: bpy.types.Mesh) -> bool:
    """Whether Blender stores this mesh's triangles as three ints in a row, and foreach_get agrees.

    That layout is not documented, but reading it is some hundred times quicker than foreach_get.
    """
    triangles = mesh.loop_triangles
    # Reading past the array is what no comparison would survive: first ask Blender for the
    # addresses of the first, the second and the last triangle.
    start = triangles[0].as_pointer()
    if triangles[1].as_pointer() - start != 12 or triangles[-1].as_pointer() - start != 12 * (len(triangles) - 1):
        return False
    return bool(np.array_equal(_by_pointer(mesh), _by_foreach_get(mesh)))


def _by_pointer(mesh: bpy.types.Mesh) -> np.ndarray:
    count = len(mesh.loop_triangles)
    memory = (ctypes.c_int32 * (3 * count)).from_address(mesh.loop_triangles[0].as_pointer())
    return np.frombuffer(memory, np.int32).reshape(count, 3).copy()


def _by_foreach_get(mesh: bpy.types.Mesh) -> np.ndarray:
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    return corners.reshape(-1, 3)

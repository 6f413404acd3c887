# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals of meshes whose vertices have been moved, as Cycles 5.2 finds them."""

import numpy as np

from ...scene.meshes import SMOOTH_NORMALS, Mesh
from .unit_vectors import unit_vectors


def displaced_normals(
    mesh: Mesh,
    renews: np.ndarray,
    bumped: np.ndarray,
    before: np.ndarray,
    after: np.ndarray,
    normals: np.ndarray,
) -> np.ndarray:
    """(corners, 3) float32: those of the corners once vertices went from places ``before`` to places ``after``.

    renews, bumped: (triangles,) which are displaced without bump and with: the latter keep the normals that they had,
    as bump turns these. before, after: (vertices, 3); normals: (corners, 3) before. A normal of 0 is that of the
    triangle, as all of flat faces are.
    """
    vertices, smooth = mesh.corner_vertices[mesh.triangle_corners], mesh.attributes.get(SMOOTH_NORMALS)
    if smooth is None:
        new = _vertex_normals(vertices[renews], after)[mesh.corner_vertices] if renews.any() else np.zeros_like(normals)
        result = np.where(new.any(axis=1)[:, None], new, normals)
    elif not smooth.values[:, 3].any():
        return np.zeros_like(normals)
    else:  # corners of a vertex differ where edges are sharp, and all turn by as much
        turn = _vertex_normals(vertices, after) - _vertex_normals(vertices, before)
        result = unit_vectors(normals + turn[mesh.corner_vertices])
    corners = mesh.triangle_corners[bumped]
    result[corners] = normals[corners]
    return result if smooth is None else np.where(smooth.values[:, 3:] > 0.0, result, np.float32(0.0))


def _vertex_normals(triangles: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(vertices, 3) float32 means of the normals of triangles (n, 3), each counted alike; 0 of none."""
    corners = positions[triangles].astype(np.float64)
    faces = unit_vectors(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    vertices, count = triangles.ravel(), len(positions)
    sums = [np.bincount(vertices, np.repeat(faces[:, axis], 3), count) for axis in range(3)]
    return unit_vectors(np.stack(sums, axis=-1)).astype(np.float32)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals of meshes whose vertices have been moved, as Cycles 5.2 finds them."""

import numpy as np

from ...scene.meshes import SMOOTH_NORMALS, Mesh


def displaced_normals(
    mesh: Mesh,
    renews: np.ndarray,
    bumped: np.ndarray,
    before: np.ndarray,
    after: np.ndarray,
    normals: np.ndarray,
) -> np.ndarray:
    """(corners, 3) float32: those of the corners once vertices went from places ``before`` to places ``after``.

    renews, bumped: (triangles,) which are displaced, and of those that are bumped as well: these have the normals that
    their vertices had before, as bump turns them. before, after: (vertices, 3); normals: (corners, 3) before. A normal
    of 0 is that of the triangle.
    """
    vertices, smooth = mesh.corner_vertices[mesh.triangle_corners], mesh.attributes.get(SMOOTH_NORMALS)
    if smooth is None:
        new = _vertex_normals(vertices[renews], after)[mesh.corner_vertices] if renews.any() else np.zeros_like(normals)
        result, kept = np.where(new.any(axis=1)[:, None], new, normals), normals
    else:
        kept, is_smooth = smooth.values[:, :3], smooth.values[:, 3:] > 0.0
        result = np.zeros_like(normals)
        if is_smooth.any():  # corners of a vertex differ where edges are sharp, and all turn by as much
            turn = _vertex_normals(vertices, after) - _vertex_normals(vertices, before)
            result = np.where(is_smooth, _unit(normals + turn[mesh.corner_vertices]), result)
    corners = mesh.triangle_corners[bumped]
    result[corners] = kept[corners]
    return result


def _vertex_normals(triangles: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(vertices, 3) float32 means of the normals of triangles (n, 3), each counted alike; 0 of none."""
    corners = positions[triangles].astype(np.float64)
    faces = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    vertices, count = triangles.ravel(), len(positions)
    sums = [np.bincount(vertices, np.repeat(faces[:, axis], 3), count) for axis in range(3)]
    return _unit(np.stack(sums, axis=-1)).astype(np.float32)


def _unit(vectors: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 1e-30)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangents of UV maps as normal maps are baked for: the convention of Mikkelsen (2008)."""

import numpy as np

from .....scene import Mesh


def corner_tangents(mesh: Mesh, uv: np.ndarray, goes_round: bool = False) -> np.ndarray:
    """(corners, 4) float32 unit tangents along u in object space, and the sign of the bitangent.

    uv: (corners, 2). goes_round: whether u is a longitude, of which triangles go the shorter way, as in Cycles.
    Triangles around a vertex share a tangent where normal, UV and handedness are the same: the mean of their own
    tangents, by the angles that they take up around it. 0 where the map is degenerate.
    """
    triangles = mesh.triangle_corners
    points = mesh.positions[mesh.corner_vertices[triangles]].astype(np.float64)
    edges, steps = points[:, 1:] - points[:, :1], uv[triangles[:, 1:]].astype(np.float64) - uv[triangles[:, :1]]
    if goes_round:
        steps[..., 0] -= np.round(steps[..., 0])
    area = steps[:, 0, 0] * steps[:, 1, 1] - steps[:, 1, 0] * steps[:, 0, 1]
    sign = np.where(area > 0.0, 1.0, -1.0)
    along = sign[:, None] * (edges[:, 0] * steps[:, 1, 1:] - edges[:, 1] * steps[:, 0, 1:])

    filled = mesh.face_normals_filled(mesh.corner_normals, mesh.positions)
    normals = filled[triangles].astype(np.float64)
    tangents = _unit(_across(along[:, None], normals))
    before = _unit(_across(np.roll(points, 1, axis=1) - points, normals))
    after = _unit(_across(np.roll(points, -1, axis=1) - points, normals))
    angles = np.arccos(np.clip(np.einsum("tci,tci->tc", before, after), -1.0, 1.0)) * (area != 0.0)[:, None]

    group = 2 * _welded(mesh, filled, uv)[triangles] + (area > 0.0)[:, None]
    weighted = (angles[..., None] * tangents).reshape(-1, 3)
    count = int(group.max()) + 1
    sums = np.stack([np.bincount(group.ravel(), weighted[:, k], count) for k in range(3)], axis=-1)
    result = np.zeros((len(uv), 4), np.float32)
    # Where a corner lies in triangles with and without area on the map, those with area come last and count.
    order = np.argsort(area != 0.0, kind="stable")
    corners = triangles[order].ravel()
    result[corners, :3] = _unit(sums)[group[order].ravel()]
    result[corners, 3] = np.repeat(sign[order], 3)
    return result


def _across(vectors: np.ndarray, normals: np.ndarray) -> np.ndarray:
    return vectors - (vectors * normals).sum(axis=-1, keepdims=True) * normals


def _unit(vectors: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(lengths > 1e-20, vectors / np.maximum(lengths, 1e-20), 0.0)


def _welded(mesh: Mesh, normals: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """(corners,) the same number for corners of the same place, normal and UV."""
    keys = np.concatenate([mesh.positions[mesh.corner_vertices], normals, uv], axis=1) + np.float32(0.0)
    keys = np.ascontiguousarray(keys, np.float32)
    rows = keys.view(np.dtype((np.void, keys.dtype.itemsize * keys.shape[1])))
    return np.unique(rows, return_inverse=True)[1].ravel()


def sphere_uv(places: np.ndarray) -> np.ndarray:
    """(n, 2) float32: longitude and latitude of (n, 3) places about the origin, a map for meshes without one."""
    x, y, z = np.asarray(places, np.float64).T
    length = np.sqrt(x * x + y * y + z * z)
    u = np.where((x == 0.0) & (y == 0.0), 0.0, 0.5 * (1.0 - np.arctan2(x, y) / np.pi))
    v = np.where(length > 0.0, 1.0 - np.arccos(np.clip(z / np.maximum(length, 1e-20), -1.0, 1.0)) / np.pi, 0.0)
    return np.stack([u, v], axis=-1).astype(np.float32)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Points to spheres of triangles, the finer the fewer there are.

A sphere's triangles have its area, so that the mean of what they hide over all directions is pi r^2 (Cauchy).
"""

import functools
import math

import numpy as np

_MOST_POINTS = ((3, 1 << 8), (2, 1 << 12), (1, 1 << 17))
"""Levels of subdivision, and up to how many points they are for: 1280, 320 and 80 triangles a sphere, or else 20."""


def level_of(points: int) -> int:
    """How often the sphere of each of so many points is subdivided."""
    return next((level for level, most in _MOST_POINTS if points <= most), 0)


@functools.cache
def unit_sphere(level: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Unit vectors (n, 3) float32 of a subdivided icosahedron, its triangles (m, 3) int32, counterclockwise from
    outside, and how far from the middle its vertices lie where it has the area of the unit sphere."""
    g = (1.0 + math.sqrt(5.0)) / 2.0
    vertices = np.array([(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
                         (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)])  # fmt: skip
    faces = np.array([
        (0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
        (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7),
        (9, 8, 1),
    ])  # fmt: skip
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    for _ in range(level):
        vertices, faces = _subdivided(vertices, faces)
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    return vertices.astype(np.float32), faces.astype(np.int32), math.sqrt(4.0 * math.pi / area)


def _subdivided(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, middle = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (len(vertices) + middle.reshape(-1, 3)).T
    a, b, c = faces.T
    middles = vertices[edges].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1, keepdims=True)
    parts = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.concatenate([vertices, middles]), np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(
        -1, 3
    )


def sphere_vertices(places: np.ndarray, radii: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of spheres about places (n, 3) of radii (n,), and their unit normals, each (n * k, 3) float32."""
    unit, _, reach = unit_sphere(level)
    positions = (np.float32(reach) * radii)[:, None, None] * unit
    positions += places[:, None, :]
    return positions.reshape(-1, 3), np.tile(unit, (len(places), 1))


def sphere_triangles(points: int, level: int) -> np.ndarray:
    """(triangles, 3) int32 vertices of the triangles of so many spheres."""
    unit, faces, _ = unit_sphere(level)
    firsts = np.arange(points, dtype=np.int32) * np.int32(len(unit))
    return (firsts[:, None, None] + faces).reshape(-1, 3)

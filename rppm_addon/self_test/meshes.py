# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes and matrices of scenes that are made of arrays, without Blender."""

import numpy as np

from ..scene.meshes import Mesh


def polygons(name: str, positions: np.ndarray, faces: list[tuple[int, ...]], smooth: bool = False) -> Mesh:
    """A mesh of convex faces, (n, 3) positions in meters; smooth normals point away from the origin."""
    positions = np.asarray(positions, np.float32)
    sizes, corners = np.array([len(face) for face in faces]), np.concatenate(faces).astype(np.int32)
    first = np.cumsum(sizes) - sizes
    a, b, c = (positions[corners[first + k]].astype(float) for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.repeat(normals, sizes, axis=0).astype(np.float32)
    if smooth:
        normals = positions[corners] / np.linalg.norm(positions[corners], axis=1, keepdims=True)
    fan = np.arange(1, sizes.max() - 1)
    triangles = first[:, None, None] + np.stack([0 * fan, fan, fan + 1], -1)
    triangles = triangles[fan < sizes[:, None] - 1].astype(np.int32)
    return Mesh(name, positions, corners, normals, triangles, np.zeros(len(triangles), np.int32))


def rectangle(name: str, *corners: tuple[float, float, float]) -> Mesh:
    """A mesh of one face with four corners, which is seen from where they turn to the left."""
    return polygons(name, np.array(corners), [(0, 1, 2, 3)])


def sphere(name: str, columns: int = 32, rows: int = 16) -> Mesh:
    """A unit sphere of quads with smooth normals."""
    theta, phi = np.pi * np.arange(rows + 1) / rows, 2 * np.pi * np.arange(columns) / columns
    s, c = np.sin(theta)[:, None], np.cos(theta)[:, None]
    points = np.stack([s * np.cos(phi), s * np.sin(phi), c * np.ones(columns)], -1).reshape(-1, 3)
    faces: list[tuple[int, ...]] = []
    for j in range(rows):
        for i in range(columns):
            a, b = j * columns + i, j * columns + (i + 1) % columns
            d, e = a + columns, b + columns
            faces.append((a, d, e) if j == 0 else (a, d, b) if j == rows - 1 else (a, d, e, b))
    return polygons(name, points, faces, smooth=True)


def box_sides() -> list[Mesh]:
    """The walls of a closed box from -1 to 1, all facing inwards: floor, ceiling, back, front, left, right."""
    return [
        rectangle("floor", (-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)),
        rectangle("ceiling", (-1, -1, 1), (-1, 1, 1), (1, 1, 1), (1, -1, 1)),
        rectangle("back", (-1, 1, -1), (1, 1, -1), (1, 1, 1), (-1, 1, 1)),
        rectangle("left", (-1, -1, -1), (-1, 1, -1), (-1, 1, 1), (-1, -1, 1)),
        rectangle("right", (1, -1, -1), (1, -1, 1), (1, 1, 1), (1, 1, -1)),
        rectangle("front", (-1, -1, -1), (-1, -1, 1), (1, -1, 1), (1, -1, -1)),
    ]


def placed(x: float, y: float, z: float, scale: float = 1.0) -> np.ndarray:
    """(4, 4) matrix of something scaled and then moved."""
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = x, y, z
    return matrix


def looking(position: tuple[float, float, float], target: tuple[float, float, float]) -> np.ndarray:
    """(4, 4) matrix of a camera or light that looks from a position to a target, Z up."""
    forward = np.subtract(target, position).astype(float)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1] if abs(forward[2]) < 0.999 else [0, 1, 0])
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, :4] = np.stack([right, np.cross(right, forward), -forward, position], 1)
    return matrix

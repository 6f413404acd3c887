# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle scenes as (n, 3, 3) float32: a closed room [-1, 1]^3 with things in it."""

import numpy as np

SPHERE_CENTER = (-0.45, -0.55, -0.3)
TABLE_TOP = -0.25

# Where a cubemap's center may lie in the scenes below, the awkward places first of all.
CENTERS = {
    "plain": (0.05, 0.1, 0.15),
    "symmetric": (0.0, 0.0, 0.0),
    "in the table top": (-0.5, TABLE_TOP, 0.5),
    "on a corner of the table": (-0.2, TABLE_TOP, 0.3),
    "in the table top's plane": (0.05, TABLE_TOP, 0.15),
    "on a wall": (1.0, 0.3, 0.2),
    "outside": (1.6, 0.2, 0.1),
    "inside the sphere": SPHERE_CENTER,
}

PLAIN = CENTERS["plain"]


def bits(hits: np.ndarray) -> np.ndarray:
    """(n, 4) words of HIT records."""
    return hits.view(np.uint32).reshape(-1, 4)


def grid_triangles(points: np.ndarray) -> np.ndarray:
    """Two triangles for each square of a (rows, columns, 3) grid of points."""
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]
    return np.concatenate([np.stack([a, b, c], 2), np.stack([a, c, d], 2)]).reshape(-1, 3, 3)


def box(low, high, divisions: int = 1) -> np.ndarray:
    """The six sides of a box, each divided into squares; all sides share their border vertices."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    steps = np.linspace(0.0, 1.0, divisions + 1)
    sides = []
    for axis in range(3):
        for end in (low, high):
            grid = np.empty((divisions + 1, divisions + 1, 3))
            u, v = (axis + 1) % 3, (axis + 2) % 3
            grid[..., axis] = end[axis]
            grid[..., u] = (low[u] + (high[u] - low[u]) * steps)[:, None]
            grid[..., v] = (low[v] + (high[v] - low[v]) * steps)[None, :]
            sides.append(grid_triangles(grid))
    return np.concatenate(sides)


def sphere(center, radius: float, rings: int, bumps: float = 0.0) -> np.ndarray:
    """A closed sphere of longitudes and latitudes; degenerate triangles at the poles are left out."""
    latitude = np.linspace(0.0, np.pi, rings + 1)[:, None]
    longitude = np.linspace(0.0, 2 * np.pi, 2 * rings + 1)[None, :]
    longitude[0, -1] = 0.0  # exactly the first column, so that the seam is closed
    x, z = np.sin(latitude) * np.cos(longitude), np.sin(latitude) * np.sin(longitude)
    y = np.cos(latitude) + 0 * longitude
    points = np.stack([x, y, z], -1)
    points[0], points[-1] = (0, 1, 0), (0, -1, 0)
    points *= (1 + bumps * np.sin(9 * x + 4 * y) * np.cos(11 * y - 5 * z))[..., None]
    triangles = grid_triangles(points * radius + np.asarray(center))
    area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1)
    return triangles[area > 1e-14]


def torus(center, radius: float, tube: float, rings: int) -> np.ndarray:
    around = np.linspace(0.0, 2 * np.pi, 2 * rings + 1)[None, :]
    across = np.linspace(0.0, 2 * np.pi, rings + 1)[:, None]
    around[0, -1] = across[-1, 0] = 0.0
    distance = radius + tube * np.cos(across)
    points = np.stack([distance * np.cos(around), tube * np.sin(across) + 0 * around, distance * np.sin(around)], -1)
    return grid_triangles(points + np.asarray(center))


def furnished_room(divisions: int = 1) -> np.ndarray:
    """Room, pillar and table: few large triangles."""
    pillar, table = box((0.1, -1, -0.6), (0.5, 0.2, -0.2)), box((-0.9, -0.3, 0.3), (-0.2, TABLE_TOP, 0.8))
    return np.concatenate([box((-1, -1, -1), (1, 1, 1), divisions), pillar, table]).astype(np.float32)


def room_with_meshes(triangle_count: int) -> np.ndarray:
    """The furnished room with a sphere, a torus and a bumpy sphere: about so many triangles."""
    rings = int(np.sqrt(triangle_count / 12))
    balls = sphere(SPHERE_CENTER, 0.4, rings), sphere((0.45, -0.5, 0.5), 0.38, rings, bumps=0.15)
    meshes = balls[0], torus((0.5, 0.5, 0.3), 0.35, 0.12, rings), balls[1]
    return np.concatenate([furnished_room(), *meshes]).astype(np.float32)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that the scenes are made of."""

import math
from collections.abc import Callable

import numpy as np

from .description import Diffuse, Material, Mesh, Point


def quads(name: str, corners: list[list[Point]], material: Material) -> Mesh:
    """Flat quadrilaterals, each of four corners counterclockwise seen from outside."""
    vertices = np.array(corners, np.float64).reshape(-1, 3)
    first = 4 * np.arange(len(corners), dtype=np.int32)[:, None]
    triangles = np.concatenate([first + [0, 1, 2], first + [0, 2, 3]]).astype(np.int32)
    return Mesh(name, vertices, triangles, material)


def floor(name: str, half: float, material: Material, height: float = 0.0) -> Mesh:
    """A horizontal square around the origin that looks up."""
    h, z = half, height
    return quads(name, [[(-h, -h, z), (h, -h, z), (h, h, z), (-h, h, z)]], material)


def checkered_floor(half: float, squares: int, dark: Diffuse, light: Diffuse) -> list[Mesh]:
    """A floor of squares in two colors."""
    edge = np.linspace(-half, half, squares + 1)
    corners: tuple[list, list] = ([], [])
    for row in range(squares):
        for column in range(squares):
            x, y, right, top = edge[column], edge[row], edge[column + 1], edge[row + 1]
            corners[(row + column) % 2].append([(x, y, 0.0), (right, y, 0.0), (right, top, 0.0), (x, top, 0.0)])
    return [quads("dark squares", corners[0], dark), quads("light squares", corners[1], light)]


def box(name: str, low: Point, high: Point, material: Material, turn: float = 0.0) -> Mesh:
    """A box between two corners, turned about its vertical axis by radians."""
    (a, b, c), (d, e, f) = low, high
    corners = [
        [(a, b, c), (a, e, c), (d, e, c), (d, b, c)],
        [(a, b, f), (d, b, f), (d, e, f), (a, e, f)],
        [(a, b, c), (d, b, c), (d, b, f), (a, b, f)],
        [(d, b, c), (d, e, c), (d, e, f), (d, b, f)],
        [(d, e, c), (a, e, c), (a, e, f), (d, e, f)],
        [(a, e, c), (a, b, c), (a, b, f), (a, e, f)],
    ]
    middle = np.array([0.5 * (a + d), 0.5 * (b + e)])
    rotation = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    turned = np.array(corners, np.float64)
    turned[..., :2] = (turned[..., :2] - middle) @ rotation + middle
    return quads(name, turned.tolist(), material)


def room(width: float, depth: float, height: float, walls: dict[str, Diffuse]) -> list[Mesh]:
    """The inner sides of a box around the origin, standing on z = 0; sides that are not named are open.

    Sides: floor, ceiling, left (-x), right (+x), front (-y), back (+y).
    """
    x, y, z = 0.5 * width, 0.5 * depth, height
    corners = {
        "floor": [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)],
        "ceiling": [(-x, -y, z), (-x, y, z), (x, y, z), (x, -y, z)],
        "left": [(-x, -y, 0), (-x, y, 0), (-x, y, z), (-x, -y, z)],
        "right": [(x, -y, 0), (x, -y, z), (x, y, z), (x, y, 0)],
        "front": [(-x, -y, 0), (-x, -y, z), (x, -y, z), (x, -y, 0)],
        "back": [(-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z)],
    }
    return [quads(side, [corners[side]], material) for side, material in walls.items()]


def grid(
    name: str, columns: int, rows: int, point: Callable[[np.ndarray, np.ndarray], tuple], material: Material
) -> Mesh:
    """A smooth surface over the unit square.

    point: (u, v), arrays of the parameters from 0 to 1, to positions and normals, (..., 3) each; the normals look to
    where u, v and they are right-handed.
    """
    u, v = np.meshgrid(np.linspace(0.0, 1.0, columns + 1), np.linspace(0.0, 1.0, rows + 1))
    positions, normals = point(u, v)
    index = np.arange((columns + 1) * (rows + 1), dtype=np.int32).reshape(rows + 1, columns + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    triangles = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    normals = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    vertices, normals = positions.reshape(-1, 3), normals.reshape(-1, 3)
    corners = vertices[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return Mesh(name, vertices, triangles[area > 1e-12], material, normals)


def sphere(name: str, center: Point, radius: float, material: Material, segments: int = 96) -> Mesh:
    """A smooth sphere of segments x segments / 2 quadrilaterals."""

    def point(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        longitude, latitude = 2.0 * math.pi * u, math.pi * (v - 0.5)
        normal = np.stack(
            [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=-1
        )
        return np.array(center) + radius * normal, normal

    return grid(name, segments, segments // 2, point, material)


def band(name: str, radius: float, bottom: float, top: float, outward: bool, material: Material) -> Mesh:
    """The side of a cylinder that stands around the origin, looking outward or inward."""
    side = 1.0 if outward else -1.0

    def point(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        angle = 2.0 * math.pi * side * u
        normal = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
        position = radius * normal
        position[..., 2] = bottom + (top - bottom) * v
        return position, side * normal

    return grid(name, 256, 1, point, material)


def washer(name: str, inner: float, outer: float, height: float, material: Material) -> Mesh:
    """A flat ring around the origin that looks up."""

    def point(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        angle, radius = -2.0 * math.pi * u, inner + (outer - inner) * v
        position = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full_like(u, height)], axis=-1)
        return position, np.broadcast_to((0.0, 0.0, 1.0), position.shape)

    return grid(name, 256, 1, point, material)


def waves(name: str, half: float, segments: int, material: Material) -> Mesh:
    """A square of water around the origin that looks up, moved by four trains of waves."""
    trains = [(2.1, 0.9, 0.020, 0.3), (-1.3, 2.6, 0.015, 1.7), (4.2, -3.1, 0.007, 4.0), (1.2, 5.3, 0.006, 2.2)]

    def point(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x, y = half * (2.0 * u - 1.0), half * (2.0 * v - 1.0)
        height, slope_x, slope_y = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
        for kx, ky, amplitude, phase in trains:
            angle = kx * x + ky * y + phase
            height += amplitude * np.sin(angle)
            slope_x += amplitude * kx * np.cos(angle)
            slope_y += amplitude * ky * np.cos(angle)
        return np.stack([x, y, height], axis=-1), np.stack([-slope_x, -slope_y, np.ones_like(x)], axis=-1)

    return grid(name, segments, segments, point, material)

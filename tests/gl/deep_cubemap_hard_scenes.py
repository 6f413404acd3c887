# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are hard for a cubemap, (n, 3, 3) float32, and the centres that are hard in each."""

import numpy as np
from deep_cubemap_scenes import furnished_room, grid_triangles, room_with_meshes, sphere, torus

SHELL_RADIUS = 0.8
SHELL_RINGS = 34


def thin_shell(gap: float) -> np.ndarray:
    """Two concentric spheres of the same facets: the inner one first, the outer one larger by a share ``gap``."""
    return np.concatenate(
        [sphere((0, 0, 0), SHELL_RADIUS, SHELL_RINGS), sphere((0, 0, 0), SHELL_RADIUS * (1 + gap), SHELL_RINGS)]
    ).astype(np.float32)


def far_away() -> np.ndarray:
    """A mesh of radius 1 a thousand radii from the origin, where another one lies that hides nothing of it."""
    return np.concatenate(
        [
            sphere((580.0, -570.0, 580.0), 1.0, 36, bumps=0.1),
            torus((0.1, 0.2, -0.1), 0.5, 0.1, 18),
        ]
    ).astype(np.float32)


def layers() -> np.ndarray:
    """250 sheets behind one another, askew, each of eight triangles: all in the same few cells."""
    rng = np.random.default_rng(4)
    distances = 1.0 + 2.0 * np.sort(rng.random(250)) ** 3
    x, y = np.meshgrid([-0.1, 0.0, 0.1], [-0.1, 0.0, 0.1])
    sheet = grid_triangles(np.stack([x, y, 0 * x], -1))
    sheets = [
        distance * (sheet @ (np.eye(3) + 0.01 * rng.normal(size=(3, 3)))) + distance * np.array([0.02, 0.03, 1.0])
        for distance in distances
    ]
    return np.concatenate(sheets).astype(np.float32)


def bundle() -> np.ndarray:
    """1500 needles from all over the room through one small place, and 1500 triangles that share a vertex."""
    rng = np.random.default_rng(5)
    ends = rng.uniform(-1, 1, (1500, 3))
    knot = np.array([0.3, 0.2, -0.4]) + 1e-3 * rng.normal(size=(1500, 3))
    needles = np.stack([ends, 2 * knot - ends, 2 * knot - ends + 1e-5 * rng.normal(size=(1500, 3))], 1)
    tip = np.full((1500, 1, 3), [-0.4, -0.3, 0.5])
    rim = rng.normal(size=(1500, 1, 3)) * 0.3
    fan = np.concatenate([tip, tip + rim, tip + rim + 1e-2 * rng.normal(size=(1500, 1, 3))], 1)
    return np.concatenate([needles, fan]).astype(np.float32)


def large_triangles() -> np.ndarray:
    """Six hundred that each cross much of the room, and so most of the cells."""
    return np.random.default_rng(6).uniform(-1, 1, (600, 3, 3)).astype(np.float32)


def all_twice() -> np.ndarray:
    """Every hit is a tie: a room of meshes, and the same again in another order, turned over or round."""
    triangles = room_with_meshes(3000)
    rng = np.random.default_rng(7)
    again = triangles[rng.permutation(len(triangles))]
    turned = rng.random(len(again)) < 0.5
    again[turned] = again[turned][:, ::-1]
    return np.concatenate([triangles, np.roll(again, 1, axis=1)])


def dust() -> np.ndarray:
    """Three thousand triangles in a ball of a five-thousandth of the room, and the room."""
    rng = np.random.default_rng(8)
    grains = rng.normal(size=(3000, 1, 3)) * 2e-4 + rng.normal(size=(3000, 3, 3)) * 1e-5
    return np.concatenate([furnished_room(2), grains + [0.62, 0.31, 0.44]]).astype(np.float32)


SCENES = {
    "shell of 1e-3": lambda: thin_shell(1e-3),
    "shell of 1e-4": lambda: thin_shell(1e-4),
    "shell of 1e-5": lambda: thin_shell(1e-5),
    "far away": far_away,
    "layers": layers,
    "bundle": bundle,
    "large triangles": large_triangles,
    "all twice": all_twice,
    "dust": dust,
    "dense meshes": lambda: room_with_meshes(60_000),
}


def hard_centres(triangles: np.ndarray, seed: int) -> dict[str, np.ndarray]:
    """On and at a mesh, where cells and triangles meet worst, and far from all of it."""
    rng = np.random.default_rng(seed)
    low, high = triangles.min((0, 1)).astype(float), triangles.max((0, 1)).astype(float)
    radius = 0.5 * float(np.linalg.norm(high - low))
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]).astype(float)
    number = rng.choice(np.flatnonzero(np.linalg.norm(normals, axis=1) > 0))
    corners, normal = triangles[number].astype(float), normals[number] / np.linalg.norm(normals[number])
    aside = rng.normal(size=3)
    return {
        "on a vertex": corners[1],
        "on an edge": 0.5 * (corners[0] + corners[1]),
        "1e-6 of the radius above a triangle": corners.mean(0) + 1e-6 * radius * normal,
        "1e-4 of the radius above a triangle": corners.mean(0) + 1e-4 * radius * normal,
        "1e-2 of the radius above a triangle": corners.mean(0) + 1e-2 * radius * normal,
        "at the origin": np.zeros(3),
        "ten radii off": 0.5 * (low + high) + 10.0 * radius * aside / np.linalg.norm(aside),
    }

# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays that are hard for a cubemap and for float32, made from a scene's own triangles and the center."""

import numpy as np

from rppm_addon.self_test.ray_queries import ray_records

KINDS = (
    "uniform", "from the center", "to the center", "past the center", "from near the center", "along axes",
    "in face borders", "in face diagonals", "at edges", "at vertices", "grazing", "inside thin shells",
    "from the surface", "from outside",
)  # fmt: skip


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)


class HardRays:
    """Makes RAY records for (n, 3, 3) float32 ``triangles`` and a center."""

    def __init__(self, triangles: np.ndarray, center, seed: int) -> None:
        self.triangles = triangles
        self.center = np.asarray(center, np.float32).astype(float)
        self.low, self.high = triangles.min((0, 1)).astype(float), triangles.max((0, 1)).astype(float)
        self.radius = float(np.linalg.norm(np.maximum(self.high - self.center, self.center - self.low)))
        self.rng = np.random.default_rng(seed)

    def rays(self, kind: str, count: int) -> np.ndarray:
        origins, directions = self._make(kind, count)
        rays = ray_records(origins, _unit(directions), 1e30)
        if kind in ("inside thin shells", "from the surface"):
            rays["source_triangle"][::2] = self._chosen[::2]
        return rays

    def _in_box(self, count: int) -> np.ndarray:
        return self.rng.uniform(self.low, self.high, (count, 3))

    def _near_center(self, count: int) -> np.ndarray:
        """At distances of all orders of magnitude from 1e-9 to 1e-2 of the radius."""
        return self.center + self.rng.normal(size=(count, 3)) * self.radius * 10.0 ** self.rng.uniform(
            -9, -2, (count, 1)
        )

    def _corners(self, count: int) -> np.ndarray:
        self._chosen = self.rng.integers(0, len(self.triangles), count)
        return self.triangles[self._chosen].astype(float)

    def _surface(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Points on triangles and normals, 0 for degenerate ones."""
        corners = self._corners(count)
        points = np.einsum("nk,nkx->nx", self.rng.dirichlet((1, 1, 1), count), corners)
        return points, _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))

    def _edges(self, count: int) -> np.ndarray:
        corners, first = self._corners(count), self.rng.integers(0, 3, count)
        index, along = np.arange(count), self.rng.random((count, 1))
        return corners[index, first] * along + corners[index, (first + 1) % 3] * (1 - along)

    def _make(self, kind: str, count: int) -> tuple[np.ndarray, np.ndarray]:
        rng, center, index = self.rng, self.center, np.arange(count)
        if kind == "uniform":
            return self._in_box(count), rng.normal(size=(count, 3))
        if kind == "from the center":
            targets = np.concatenate([self._edges(count // 2), self._surface(count - count // 2)[0]])
            return np.tile(center, (count, 1)), targets - center
        if kind == "to the center":
            origins = self._in_box(count).astype(np.float32).astype(float)
            origins[::4] = center + (origins[::4] - center) * 4
            return origins, center - origins
        if kind == "past the center":
            origins = self._in_box(count)
            return origins, self._near_center(count) - origins
        if kind == "from near the center":
            origins = self._near_center(count)
            return origins, rng.normal(size=(count, 3))
        if kind == "along axes":
            directions = np.zeros((count, 3))
            axis = rng.integers(0, 3, count)
            directions[index, axis] = rng.choice([-1.0, 1.0], count)
            origins = self._in_box(count)
            # in the planes and lines of vertices, or of the center
            vertices = self._corners(count)[index, rng.integers(0, 3, count)]
            vertices[::3] = center
            exact = rng.random((count, 3)) < 0.6
            return np.where(exact, vertices, origins), directions
        if kind == "in face borders":
            axis = rng.integers(0, 3, count)
            other = (axis + 1) % 3
            ratio = rng.choice([-1.0, 1.0], count) * rng.choice([1.0, 1.0, 0.0, 0.5, 0.25, 0.0078125], count)
            offset, directions = (self._in_box(count) - center) * 0.5, rng.normal(size=(count, 3))
            offset[index, other] = ratio * offset[index, axis]
            directions[index, other] = ratio * directions[index, axis]
            return center + offset, directions
        if kind == "in face diagonals":
            diagonals = rng.choice([-1.0, 1.0], (count, 3))
            diagonals[::3, 0] = 0.0
            along = rng.uniform(-1, 1, (count, 1)) * self.radius * (rng.random((count, 1)) < 0.8)
            return center + along * rng.choice([-1.0, 1.0], (count, 3)), diagonals
        if kind == "at edges":
            origins = self._in_box(count)
            return origins, self._edges(count) - origins
        if kind == "at vertices":
            origins = self._in_box(count).astype(np.float32).astype(float)
            return origins, self._corners(count)[index, rng.integers(0, 3, count)] - origins
        if kind == "grazing":
            points, normals = self._surface(count)
            tangents = np.cross(normals, rng.normal(size=(count, 3)))
            tilt = 10.0 ** rng.uniform(-9, -1, (count, 1)) * (rng.random((count, 1)) < 0.8)
            directions = _unit(tangents) + tilt * normals
            return points - directions * self.radius * 10.0 ** rng.uniform(-6, 0, (count, 1)), directions
        if kind == "inside thin shells":
            points, normals = self._surface(count)
            height = self.radius * 10.0 ** rng.uniform(-8, -3, (count, 1)) * rng.choice([-1.0, 1.0], (count, 1))
            directions = rng.normal(size=(count, 3))
            flat = rng.random(count) < 0.5
            directions[flat] -= normals[flat] * np.sum(normals * directions, 1)[flat, None] * rng.uniform(0.9, 1.0)
            return points + height * normals, directions
        if kind == "from the surface":
            points, _ = self._surface(count)
            return points, rng.normal(size=(count, 3))
        if kind == "from outside":
            origins = center + _unit(rng.normal(size=(count, 3))) * self.radius * rng.uniform(1.0, 4.0, (count, 1))
            return origins, self._surface(count)[0] - origins
        raise ValueError(kind)

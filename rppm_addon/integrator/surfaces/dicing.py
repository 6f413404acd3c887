# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes divided before they are displaced, in place of Cycles' adaptive subdivision: all triangles alike."""

import dataclasses
import functools
import math

import numpy as np

from ...scene.camera import Camera
from ...scene.meshes import SMOOTH_NORMALS, AttributeDomain, Instance, Mesh, MeshAttribute
from ...scene.motion import Deformation
from .unit_vectors import unit_vectors

MOST_TRIANGLES = 1 << 20
"""Largest number of triangles of all instances of a divided mesh together."""
_OFFSCREEN = 4.0
"""Factor by which edges outside of the view may be longer."""
_PERCENTILE = 90.0
"""Percentage of the edges that are no longer than the dicing rate says."""
_MAX_MEASURED = 64
"""Largest number of instances of a mesh by which its size in the picture is measured."""


def parts_of_edges(mesh: Mesh, instances: list[Instance], camera: Camera, rate: float) -> float:
    """Into how many parts edges are to be divided, 1 or more, whatever comes of it.

    rate: of edges that are measured in pixels, by how much longer they may be.
    """
    dicing = mesh.dicing
    assert dicing is not None
    ends = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float64)
    if not dicing.in_pixels:
        lengths = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=-1).ravel()
        return max(1.0, float(np.percentile(lengths, _PERCENTILE)) / dicing.edge_length)
    found = [1.0]
    for instance in instances[:_MAX_MEASURED]:
        placed = ends @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
        pixels, seen = _pixels_of_edges(placed, camera)
        some, scale = (pixels[seen], 1.0) if seen.any() else (pixels, _OFFSCREEN)
        found.append(float(np.percentile(some, _PERCENTILE)) / (scale * rate * dicing.edge_length))
    return max(found)


def _pixels_of_edges(corners: np.ndarray, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """(n,) pixels that the edges of triangles (m, 3, 3), world space, would span if they faced the camera, and whether
    their middles are in the picture."""
    others = np.roll(corners, 1, axis=1)
    lengths = np.linalg.norm(corners - others, axis=-1).ravel()
    inverse = np.linalg.inv(camera.matrix)
    at = (0.5 * (corners + others)).reshape(-1, 3) @ inverse[:3, :3].T + inverse[:3, 3]
    distances = np.ones(len(at)) if camera.orthographic else np.linalg.norm(at, axis=1)
    pixels = lengths / np.maximum(camera.pixel_size * distances, 1e-30)
    if camera.panorama is not None:
        return pixels, np.ones(len(at), bool)
    depths = 1.0 if camera.orthographic else np.maximum(-at[:, 2], 1e-30)
    x, y = at[:, 0] / depths, at[:, 1] / depths
    left, right, bottom, top = camera.window
    return pixels, (at[:, 2] < 0.0) & (x > left) & (x < right) & (y > bottom) & (y < top)


class DicedMesh:
    """A mesh each of whose edges is divided into ``parts``: vertices first, then those on edges, then within."""

    def __init__(self, mesh: Mesh, parts: int) -> None:
        self._source, self._parts = mesh, parts
        self._vertices = mesh.corner_vertices[mesh.triangle_corners].astype(np.int64)
        self._weights, self._local = _lattice(parts)
        self._ids, self._count = self._vertex_ids()

    @functools.cached_property
    def mesh(self) -> Mesh:
        """The divided one."""
        source = self._source
        triangles, points = self._ids.shape
        corners = (np.arange(triangles)[:, None, None] * points + self._local).reshape(-1, 3)
        return dataclasses.replace(
            source,
            positions=self.positions(source.positions, source.corner_normals),
            corner_vertices=self._ids.astype(np.int32).ravel(),
            corner_normals=self.normals(source.corner_normals),
            triangle_corners=corners.astype(np.int32),
            triangle_slots=np.repeat(source.triangle_slots, self._parts**2),
            corner_uv=None if source.corner_uv is None else self._of_corners(source.corner_uv),
            attributes={name: self._attribute(name, attribute) for name, attribute in source.attributes.items()},
            dicing=None,
        )

    def deformed(self, deformation: Deformation) -> Deformation:
        """The shapes of the divided mesh."""
        keys = list(zip(deformation.positions, deformation.corner_normals, strict=True))
        positions = np.stack([self.positions(*key) for key in keys])
        normals = np.stack([self.normals(normals) for _, normals in keys])
        return Deformation(deformation.mesh, deformation.times, positions, normals)

    def positions(self, positions: np.ndarray, corner_normals: np.ndarray) -> np.ndarray:
        """(vertices, 3) float32 of the mesh with these positions (vertices, 3) and normals (corners, 3)."""
        corners = positions[self._vertices].astype(np.float64)
        dicing = self._source.dicing
        if dicing is None or not dicing.is_curved:
            return self._of_vertices(np.einsum("pk,tkc->tpc", self._weights, corners))
        filled = self._source.face_normals_filled(corner_normals, positions)
        normals = _vertex_means(self._source, filled)[self._vertices]
        return self._of_vertices(_curved_points(corners, normals, self._weights))

    def normals(self, corner_normals: np.ndarray) -> np.ndarray:
        """(corners, 3) float32 of the mesh with these."""
        return unit_vectors(self._of_corners(corner_normals))

    def _attribute(self, name: str, attribute: MeshAttribute) -> MeshAttribute:
        values = attribute.values
        if attribute.domain is AttributeDomain.TRIANGLE:
            return MeshAttribute(attribute.domain, np.repeat(values, self._parts**2, axis=0))
        if attribute.domain is AttributeDomain.POINT:
            mixed = np.einsum("pk,tkc->tpc", self._weights, values[self._vertices])
            return MeshAttribute(attribute.domain, self._of_vertices(mixed))
        mixed = self._of_corners(values)
        if name == SMOOTH_NORMALS:
            mixed[:, :3] = unit_vectors(mixed[:, :3])
        return MeshAttribute(attribute.domain, mixed)

    def _of_corners(self, values: np.ndarray) -> np.ndarray:
        mixed = np.einsum("pk,tkc->tpc", self._weights, values[self._source.triangle_corners])
        return mixed.reshape(-1, values.shape[1]).astype(np.float32)

    def _of_vertices(self, values: np.ndarray) -> np.ndarray:
        """(vertices, channels) float32 of values (triangles, points, channels)."""
        result = np.zeros((self._count, values.shape[2]), np.float32)
        result[self._ids] = values
        return result

    def _vertex_ids(self) -> tuple[np.ndarray, int]:
        """(triangles, points) the vertex of each point of the lattices, and how many there are."""
        parts, count = self._parts, len(self._source.positions)
        places = np.rint(self._weights * parts).astype(np.int64)
        ids = np.zeros((len(self._vertices), len(places)), np.int64)
        for corner in range(3):
            ids[:, places[:, corner] == parts] = self._vertices[:, corner, None]
        pairs = np.stack([self._vertices, np.roll(self._vertices, -1, axis=1)], axis=-1)
        low, high = pairs.min(axis=-1), pairs.max(axis=-1)
        edges, which = np.unique(low * count + high, return_inverse=True)
        which = which.reshape(low.shape)
        for start in range(3):
            end, apart = (start + 1) % 3, (start + 2) % 3
            on = np.flatnonzero((places[:, apart] == 0) & (places[:, start] > 0) & (places[:, end] > 0))
            steps = np.where((pairs[:, start, 0] == low[:, start])[:, None], places[on, end], places[on, start])
            ids[:, on] = count + which[:, start, None] * (parts - 1) + steps - 1
        within = np.flatnonzero((places > 0).all(axis=1))
        first = count + len(edges) * (parts - 1)
        ids[:, within] = first + np.arange(ids.shape[0])[:, None] * len(within) + np.arange(len(within))
        return ids, first + ids.shape[0] * len(within)


def rounded_parts(wanted: float, triangles: int) -> int:
    """So many parts or a few more, as few as ``triangles`` leave room for: a camera that moves changes them seldom."""
    steps = (whole << shift >> 1 for shift in range(1, 30) for whole in (2, 3))  # 2, 3, 4, 6, 8, 12 ...
    rounded = next(step for step in (1, *steps) if step >= min(wanted, MOST_TRIANGLES))
    return max(1, min(rounded, math.isqrt(MOST_TRIANGLES // max(triangles, 1))))


def _lattice(parts: int) -> tuple[np.ndarray, np.ndarray]:
    """(points, 3) barycentrics within a triangle whose edges have so many parts, and (parts^2, 3) the points of the
    triangles in between, turned as the whole is."""
    i, j = np.nonzero(np.add.outer(np.arange(parts + 1), np.arange(parts + 1)) <= parts)
    weights = np.stack([parts - i - j, i, j], axis=-1) / parts
    number = np.zeros((parts + 1, parts + 1), np.int64)
    number[i, j] = np.arange(len(i))
    i, j = i[i + j < parts], j[i + j < parts]
    right, above = number[i + 1, j], number[i, j + 1]
    pairs = np.stack([number[i, j], right, above, right, number[i + 1, j + 1], above], axis=-1).reshape(-1, 2, 3)
    has_both = i + j < parts - 1
    return weights, pairs[np.stack([np.ones_like(has_both), has_both], axis=-1)]


def _curved_points(corners: np.ndarray, normals: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(triangles, points, 3) on triangles that bend by their normals (Vlachos et al., Curved PN Triangles, 2001).

    corners, normals: (triangles, 3, 3); weights: (points, 3) barycentrics.
    """
    shape = np.einsum("pk,tkc->tpc", weights**3, corners)
    middle = np.zeros_like(corners[:, 0])
    for near in range(3):
        for far in ((near + 1) % 3, (near + 2) % 3):
            way = corners[:, far] - corners[:, near]
            rise = (way * normals[:, near]).sum(axis=-1, keepdims=True) * normals[:, near]
            control = (2.0 * corners[:, near] + corners[:, far] - rise) / 3.0
            shape += (3.0 * weights[:, near] ** 2 * weights[:, far])[:, None] * control[:, None]
            middle += control / 6.0
    center = middle + 0.5 * (middle - corners.mean(axis=1))
    return shape + (6.0 * weights.prod(axis=1))[:, None] * center[:, None]


def _vertex_means(mesh: Mesh, corner_normals: np.ndarray) -> np.ndarray:
    """(vertices, 3) unit means of the normals of corners: faces that meet bend alike."""
    count = len(mesh.positions)
    sums = [np.bincount(mesh.corner_vertices, corner_normals[:, axis], count) for axis in range(3)]
    return unit_vectors(np.stack(sums, axis=-1))

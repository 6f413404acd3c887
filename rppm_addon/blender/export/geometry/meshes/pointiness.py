# SPDX-License-Identifier: GPL-3.0-or-later
"""How convex a mesh is at its vertices, which the Geometry node calls Pointiness."""

import numpy as np


def pointiness(places: np.ndarray, normals: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """(vertices, 1) float32, 0.5 where flat and more where convex, of vertices (n, 3) with unit normals and edges
    (m, 2), as Cycles has it (attr_create_pointiness): the angle between a vertex's normal and the mean of the
    directions of its edges over pi, blurred once along the edges. Vertices at one place count as one.
    """
    count = len(places)
    if count == 0:
        return np.zeros((0, 1), np.float32)
    first, one_of = _welded(places)
    edges = np.unique(np.sort(one_of[edges], axis=1), axis=0)
    start, end = edges.T
    normal = _normalized(_sums(one_of, normals, len(first)))
    along = _normalized(places[first[end]].astype(np.float64) - places[first[start]])
    toward = _sums(start, along, len(first)) - _sums(end, along, len(first))
    met = np.bincount(edges.ravel(), minlength=len(first))
    cosine = np.einsum("ij,ij->i", normal, toward) / np.maximum(met, 1)
    raw = np.where(met > 0, np.arccos(np.clip(cosine, -1.0, 1.0)) / np.pi, 0.0)
    around = np.bincount(start, raw[end], len(first)) + np.bincount(end, raw[start], len(first))
    return ((raw + around) / (met + 1))[one_of].astype(np.float32)[:, None]


def _welded(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One vertex of each place, and of each vertex the number of its place."""
    order = np.lexsort(places.T)
    ordered = places[order]
    begins = np.ones(len(places), bool)
    begins[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    one_of = np.empty(len(places), np.int64)
    one_of[order] = np.cumsum(begins) - 1
    return order[begins], one_of


def _sums(numbers: np.ndarray, vectors: np.ndarray, count: int) -> np.ndarray:
    """(count, 3) sums of the vectors (n, 3) of each number."""
    return np.stack([np.bincount(numbers, axis, count) for axis in vectors.T], axis=1)


def _normalized(vectors: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.where(lengths > 0.0, lengths, 1.0)

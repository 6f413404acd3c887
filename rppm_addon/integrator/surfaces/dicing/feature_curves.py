# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves along creases and borders of a mesh."""

import numpy as np

from ..unit_vectors import unit_vectors

_CREASE_COSINE = np.cos(np.radians(60.0))
"""Cosine between the normals of two faces up to which the edge between them is a crease."""
_CORNER_COSINE = np.cos(np.radians(35.0))
"""Cosine between two edges of a curve up to which the vertex between them is a corner of the curve."""


class FeatureCurves:
    """Edges that are creases or borders, and tangents of the curves that they approximate."""

    def __init__(self, triangles: np.ndarray, positions: np.ndarray, face_normals: np.ndarray) -> None:
        """triangles: (n, 3) vertices; positions: (vertices, 3); face_normals: (n, 3), unit."""
        starts, ends = triangles.astype(np.int64), np.roll(triangles, -1, axis=1).astype(np.int64)
        count = len(positions)
        keys = np.minimum(starts, ends) * count + np.maximum(starts, ends)
        unique, which, faces = np.unique(keys, return_inverse=True, return_counts=True)
        which = which.reshape(-1)
        sums = np.stack([np.bincount(which, np.repeat(face_normals[:, axis], 3)) for axis in range(3)], axis=-1)
        is_crease = (faces == 2) & (0.5 * (sums * sums).sum(axis=1) - 1.0 < _CREASE_COSINE)
        is_feature = is_crease | (faces == 1)
        self.edges = is_feature[which].reshape(-1, 3)
        """(n, 3) whether the edge from each corner to the next one is a crease or a border."""
        self.tangents = _tangents(np.stack(np.divmod(unique[is_feature], count), axis=-1), positions)
        """(vertices, 3) unit tangents of the curves through vertices, in either direction; 0 where there is none."""


def _tangents(edges: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(vertices, 3) unit tangents of curves of edges (n, 2) at vertices where two of them meet without a corner: those
    of parabolas through the vertex and its neighbors."""
    result = np.zeros((len(positions), 3))
    here, there = np.concatenate([edges, edges[:, ::-1]]).T
    order = np.argsort(here, kind="stable")
    here, there = here[order], there[order]
    first = np.flatnonzero(np.bincount(here, minlength=len(positions))[here] == 2)[::2]
    ways = positions[there].astype(np.float64) - positions[here]
    back, onward = ways[first], ways[first + 1]
    is_curve = (-unit_vectors(back) * unit_vectors(onward)).sum(axis=1) > _CORNER_COSINE
    back, onward = back[is_curve], onward[is_curve]
    slopes = [way / np.maximum((way * way).sum(axis=1, keepdims=True), 1e-30) for way in (back, onward)]
    result[here[first[is_curve]]] = unit_vectors(slopes[1] - slopes[0])
    return result

# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on triangles that bend by the normals of their vertices."""

import numpy as np

from ....scene.meshes import Mesh
from ..unit_vectors import unit_vectors
from .feature_curves import FeatureCurves

_CREASE_COSINE = np.cos(np.radians(35.0))
"""Cosine between the normals of a vertex and of a face around it from which on edges at the vertex are creases."""
_SMOOTH_COSINE = 0.99
"""Cosine between the normals of a corner and of its vertex from which on the corner is shaded smoothly."""
_MAX_FACES = 64
"""Faces around a vertex up to which each is compared with all others."""
_AT_ONCE = 1 << 16
"""Points that are computed together."""


class CurvedTriangles:
    """Cubic triangles through vertices (Vlachos et al., Curved PN Triangles, 2001).

    The curve of an edge follows from its ends alone, so neighbors meet: from their normals, along creases and borders
    from the tangents there. Where creases meet a vertex, all other edges leave it straight.
    """

    def __init__(self, triangles: np.ndarray, positions: np.ndarray, is_curved: bool) -> None:
        """triangles: (n, 3) vertices; positions: (vertices, 3), of flat triangles with any number of channels."""
        self._corners = positions[triangles].astype(np.float64)
        self._controls: np.ndarray | None = None
        if is_curved:
            normals, has_creases = vertex_normals(triangles, positions)
            normals[has_creases] = 0.0
            curves = FeatureCurves(triangles, positions, _face_normals(triangles, positions))
            self._controls = _controls(self._corners, normals[triangles], curves.edges, curves.tangents[triangles])

    def points(self, triangles: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """(n, channels) float64 points at barycentrics ``weights`` (n, 3) of triangles (n,)."""
        result = np.empty((len(triangles), self._corners.shape[2]))
        for start in range(0, len(triangles), _AT_ONCE):
            part = slice(start, start + _AT_ONCE)
            result[part] = self._some(triangles[part], weights[part].astype(np.float64))
        return result

    def _some(self, triangles: np.ndarray, weights: np.ndarray) -> np.ndarray:
        if self._controls is None:
            return np.einsum("nk,nkc->nc", weights, self._corners[triangles])
        a, b, c = weights.T
        powers = np.stack(
            [
                *(a**3, b**3, c**3),
                *(3.0 * a * a * b, 3.0 * a * b * b, 3.0 * b * b * c),
                *(3.0 * b * c * c, 3.0 * c * c * a, 3.0 * c * a * a, 6.0 * a * b * c),
            ],
            axis=-1,
        )
        return np.einsum("nk,nkc->nc", powers, self._controls[triangles])


def _controls(corners: np.ndarray, normals: np.ndarray, is_feature: np.ndarray, tangents: np.ndarray) -> np.ndarray:
    """(n, 10, 3) control points: corners, then two of each edge from the first corner round, then the middle one.

    corners, normals, tangents: (n, 3, 3); is_feature: (n, 3) as FeatureCurves has it.
    """
    edges = []
    for start in range(3):
        end = (start + 1) % 3
        for near, far in ((start, end), (end, start)):
            way = corners[:, far] - corners[:, near]
            rise = (way * normals[:, near]).sum(axis=-1, keepdims=True) * normals[:, near]
            along = (way * tangents[:, near]).sum(axis=-1, keepdims=True)
            length = np.linalg.norm(way, axis=-1, keepdims=True)
            tangent = np.where(along != 0.0, np.sign(along) * length * tangents[:, near], way)
            edges.append(corners[:, near] + np.where(is_feature[:, start, None], tangent, way - rise) / 3.0)
    mean = sum(edges) / 6.0
    middle = mean + 0.5 * (mean - corners.mean(axis=1))
    return np.stack([*corners.transpose(1, 0, 2), *edges, middle], axis=1)


def vertex_normals(triangles: np.ndarray, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(vertices, 3) float64 unit normals of the vertices of triangles (n, 3), means of those of the faces weighted by
    angle, and (vertices,) whether a vertex has creases: a face there turns too far from the mean.

    positions: (vertices, 3).
    """
    corners = positions[triangles].astype(np.float64)
    ways = unit_vectors(np.roll(corners, -1, axis=1) - corners)
    angles = np.arccos(np.clip(-(ways * np.roll(ways, 1, axis=1)).sum(axis=-1), -1.0, 1.0))
    faces = _face_normals(triangles, positions)
    vertices, count = triangles.reshape(-1), len(positions)
    sums = [np.bincount(vertices, (angles * faces[:, axis, None]).reshape(-1), count) for axis in range(3)]
    normals = unit_vectors(np.stack(sums, axis=-1))
    is_sharp = ((normals[triangles] * faces[:, None]).sum(axis=-1) < _CREASE_COSINE) & faces.any(axis=1)[:, None]
    has_creases = np.zeros(count, bool)
    has_creases[triangles[is_sharp]] = True
    return normals, has_creases


def creased_normals(mesh: Mesh, positions: np.ndarray, corner_normals: np.ndarray) -> np.ndarray:
    """(corners, 3) float32: corner normals (corners, 3), of which those that are smooth across creases become the means
    of the normals of the faces on their side. positions: (vertices, 3)."""
    triangles = mesh.corner_vertices[mesh.triangle_corners]
    normals, has_creases = vertex_normals(triangles, positions)
    is_smooth = (corner_normals * normals[mesh.corner_vertices]).sum(axis=1) > _SMOOTH_COSINE
    chosen = has_creases[triangles] & is_smooth[mesh.triangle_corners]
    places = np.flatnonzero(chosen)
    if len(places) == 0:
        return corner_normals
    places = places[np.argsort(triangles.reshape(-1)[places], kind="stable")]
    vertices, faces = triangles.reshape(-1)[places], _face_normals(triangles, positions)[places // 3]
    corners = mesh.triangle_corners.reshape(-1)[places]
    sums = np.zeros((len(corner_normals), 3))
    # Each with itself, with the next one of the same vertex, with the second next, ...
    most = int(np.unique(vertices, return_counts=True)[1].max())
    for step in range(min(most, _MAX_FACES)):
        first, second = np.arange(len(places) - step), np.arange(step, len(places))
        is_near = (vertices[first] == vertices[second]) & ((faces[first] * faces[second]).sum(axis=1) > _CREASE_COSINE)
        for here, there in ((first, second), (second, first))[: 1 + (step > 0)]:
            np.add.at(sums, corners[here[is_near]], faces[there[is_near]])
    return np.where(sums.any(axis=1)[:, None], unit_vectors(sums), corner_normals).astype(np.float32)


def _face_normals(triangles: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(n, 3) float64 unit normals of triangles (n, 3); 0 of those without area."""
    corners = positions[triangles].astype(np.float64)
    return unit_vectors(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))

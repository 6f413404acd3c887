# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading normals of meshes, as the Cycles of the running Blender has them.

Measured with Cycles of bpy 4.2, 4.5, 5.0, 5.1 and 5.2: flat faces have the normals of their triangles, which differ
where a face is not plane. A mesh with smooth and flat faces, but without sharp edges and custom normals, has the
normals of vertices on the smooth ones; from Blender 5.2 on those of corners. Up to Blender 5.0 Cycles keeps one normal
a vertex, once it has split these at sharp edges: where Blender's corners differ without one, such as at an edge of
three faces, the last corner counts.
"""

from collections.abc import Callable

import bpy
import numpy as np

from .....scene.storage.sharing import keep_equal, same_bits
from .element_arrays import attribute_elements, elements

_BLOCK = 256
"""Corners whose squares are added up in single precision."""
_PART = 1 << 16
"""Elements that are looked at while they lie in a cache."""


def read_corner_normals(
    mesh: bpy.types.Mesh, before: np.ndarray, copy: Callable[[np.ndarray], np.ndarray] = np.copy
) -> np.ndarray:
    """(corners, 3) float32 unit normals, 0 on faces that take those of their triangles; ``before`` itself if that says
    the same. Normals that Blender gives as 0 or NaN, as of faces without area, are repaired.

    copy: what copies Blender's array.
    """
    if is_flat(mesh):
        return keep_equal(before, np.zeros((len(mesh.loops), 3), np.float32))
    if bpy.app.version < (5, 2) and _mixes_smooth_and_flat(mesh):
        return keep_equal(before, _vertex_normals_of_smooth_faces(mesh))
    view = elements(mesh.corner_normals, "vector", len(mesh.loops), 3, np.float32)
    takes_last = bpy.app.version < (5, 1) and mesh.normals_domain == "CORNER"
    last = _corners_that_count(mesh, view) if takes_last else None
    if last is None and same_bits(before, view):
        return before
    normals = copy(view) if last is None else view[last]
    parts = (normals[start : start + _PART] for start in range(0, len(normals), _PART))
    if _has_free_normals(mesh) or not all(map(_no_zeros_among, parts)):
        _make_unit(normals)
    return normals if last is None else keep_equal(before, normals)


def is_flat(mesh: bpy.types.Mesh) -> bool:
    """True where each triangle of a mesh has its own normal."""
    return mesh.normals_domain == "FACE" and not mesh.has_custom_normals


def _mixes_smooth_and_flat(mesh: bpy.types.Mesh) -> bool:
    """True where flat faces are all that tells corners of a vertex apart."""
    if mesh.normals_domain != "CORNER" or mesh.has_custom_normals:
        return False
    sharp = attribute_elements(mesh, "sharp_edge", "value", len(mesh.edges), 1, bool)
    return sharp is None or not sharp.any()


def _vertex_normals_of_smooth_faces(mesh: bpy.types.Mesh) -> np.ndarray:
    vertices = read_corner_vertices(mesh)
    normals = elements(mesh.vertex_normals, "vector", len(mesh.vertices), 3, np.float32).take(vertices, axis=0)
    _make_unit(normals)
    flat = attribute_elements(mesh, "sharp_face", "value", len(mesh.polygons), 1, bool)
    if flat is not None:
        normals[np.repeat(flat, _face_lengths(mesh))] = 0.0
    return normals


def read_corner_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """(corners,) int32 vertices, which may lie in Blender's memory."""
    vertices = attribute_elements(mesh, ".corner_vert", "value", len(mesh.loops), 1, np.int32)
    if vertices is None:  # in Edit Mode
        vertices = elements(mesh.loops, "vertex_index", len(mesh.loops), 1, np.int32)
    return vertices


def _corners_that_count(mesh: bpy.types.Mesh, normals: np.ndarray) -> np.ndarray | None:
    """(corners,) the corner whose normal each has once vertices are split at sharp edges; None where it is its own."""
    edges = attribute_elements(mesh, ".corner_edge", "value", len(mesh.loops), 1, np.int32)
    if edges is None:  # in Edit Mode
        edges = elements(mesh.loops, "edge_index", len(mesh.loops), 1, np.int32)
    vertices, ends = read_corner_vertices(mesh), elements(mesh.edges, "vertices", len(mesh.edges), 2, np.int32)
    if not mesh.has_custom_normals and _is_manifold(edges, vertices, ends):
        return None
    lengths = _face_lengths(mesh)
    sharp = np.zeros(len(ends), bool)
    of_edges = attribute_elements(mesh, "sharp_edge", "value", len(ends), 1, bool)
    if of_edges is not None:
        sharp |= of_edges
    of_faces = attribute_elements(mesh, "sharp_face", "value", len(lengths), 1, bool)
    if of_faces is not None:
        sharp[edges[np.repeat(of_faces, lengths)]] = True
    return last_corners(normals, vertices, edges, ends, lengths, sharp)


def _is_manifold(edges: np.ndarray, vertices: np.ndarray, ends: np.ndarray) -> bool:
    """True where no edge has more than two faces, or two that go along it one way, which Blender takes for sharp."""
    count = np.bincount(edges, minlength=len(ends))
    if count.max(initial=0) > 2:
        return False
    starts = np.bincount(edges, vertices, len(ends))
    return bool((starts == ends.sum(axis=1, dtype=np.int64))[count == 2].all())


def last_corners(
    normals: np.ndarray,
    vertices: np.ndarray,
    edges: np.ndarray,
    ends: np.ndarray,
    lengths: np.ndarray,
    sharp: np.ndarray,
) -> np.ndarray | None:
    """(corners,) the last corner that shares a vertex with each, once vertices are split at sharp edges; None where all
    of these have the same normal.

    normals: (corners, 3); vertices, edges: (corners,) that they begin with; ends: (edges, 2) vertices; lengths:
    (faces,) their corners; sharp: (edges,). Vertices without a sharp edge stay whole (Blender's split_edges).
    """
    corners, count = np.arange(len(vertices)), int(ends.max(initial=0)) + 1
    first = np.zeros(count, np.int64)
    first[vertices[::-1]] = corners[::-1]
    differs = np.zeros(count, bool)
    differs[vertices[(normals != normals[first[vertices]]).any(axis=1)]] = True
    chosen = differs[vertices]
    if not chosen.any():
        return None
    splits = np.zeros(count, bool)
    splits[ends[sharp]] = True
    label = np.where(splits[vertices], corners, first[vertices])
    face_ends = np.cumsum(lengths)
    following = corners + 1
    following[face_ends - 1] = face_ends - lengths
    # A corner lies at the edge that it begins, and the next one at the other end of that edge.
    members = np.concatenate([corners, following])
    of_edges = np.concatenate([edges, edges])
    kept = chosen[members] & ~sharp[of_edges]
    members, of_edges = members[kept], of_edges[kept]
    keys = 2 * of_edges.astype(np.int64) + (vertices[members] != ends[of_edges, 0])
    while True:
        lowest = np.full(2 * len(ends), len(corners))
        np.minimum.at(lowest, keys, label[members])
        joined = label.copy()
        np.minimum.at(joined, members, lowest[keys])
        joined = joined[joined]
        if np.array_equal(joined, label):
            break
        label = joined
    last = np.zeros(len(corners), np.int64)
    np.maximum.at(last, label, corners)
    return np.where(chosen, last[label], corners)


def _face_lengths(mesh: bpy.types.Mesh) -> np.ndarray:
    lengths = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", lengths)
    return lengths


def _has_free_normals(mesh: bpy.types.Mesh) -> bool:
    """True where normals are what users or nodes have stored, of any length."""
    attribute = mesh.attributes.get("custom_normal")
    return attribute is not None and attribute.data_type == "FLOAT_VECTOR"


def _make_unit(normals: np.ndarray) -> None:
    """Repair, in place, normals that are no unit vectors."""
    squares = np.einsum("ij,ij->i", normals, normals)
    bad = ~(np.abs(squares - 1.0) < 1e-3)
    if bad.any():
        wrong = np.nan_to_num(normals[bad], nan=0.0, posinf=0.0, neginf=0.0)
        lengths = np.linalg.norm(wrong, axis=1, keepdims=True)
        normals[bad] = np.where(lengths > 1e-6, wrong / np.maximum(lengths, 1e-30), np.float32([0.0, 0.0, 1.0]))


def _no_zeros_among(normals: np.ndarray) -> bool:
    """True where normals that are unit vectors, 0 or NaN are unit vectors all: by sums of squares, block by block."""
    whole = len(normals) // _BLOCK * _BLOCK
    for block in (normals[:whole].reshape(-1, 3 * _BLOCK), normals[whole:].reshape(1, -1)):
        squares = np.einsum("ij,ij->i", block, block)
        if not (np.abs(squares - block.shape[1] / 3) < 0.25).all():
            return False
    return True

# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated Blender meshes to indexed arrays."""

import bpy
import numpy as np

from ...scene import Mesh
from .report import Report
from .triangles import triangle_corners

FARTHEST = 1e18
"""Coordinates beyond overflow in single precision as soon as they are squared."""


def export_mesh(mesh: bpy.types.Mesh, name: str, report: Report) -> Mesh | None:
    """The arrays of an evaluated mesh, in its object space; None when it has no triangle.

    Triangles with a vertex that is not finite, or beyond FARTHEST, are left out, with a warning that names ``name``.
    """
    if len(mesh.polygons) == 0:
        return None
    mesh.calc_loop_triangles()
    triangles = triangle_corners(mesh)
    if len(triangles) == 0:
        return None
    polygons = _read(mesh.loop_triangle_polygons, "value", len(triangles), 1, np.int32)[:, 0]
    slots = _attribute(mesh, "material_index", "value", len(mesh.polygons), 1, np.int32)
    triangle_slots = np.zeros(len(triangles), np.int32) if slots is None else np.maximum(slots[:, 0], 0)[polygons]

    positions, corner_vertices, corner_normals = read_shape(mesh)
    finite = (np.abs(positions) < FARTHEST).all(axis=1)  # false for NaN as well
    if not finite.all():
        good = finite[corner_vertices[triangles]].all(axis=1)
        report.warn(
            f'Object "{name}": {np.count_nonzero(~finite)} vertices are not finite or too far away, so '
            f"{np.count_nonzero(~good)} triangles were left out; correct the mesh or its modifiers"
        )
        triangles, triangle_slots = triangles[good], triangle_slots[good]
        positions[~finite] = 0.0
        if len(triangles) == 0:
            return None
    return Mesh(
        name=name,
        positions=positions,
        corner_vertices=corner_vertices,
        corner_normals=corner_normals,
        triangle_corners=triangles,
        triangle_slots=triangle_slots,
        corner_uv=_render_uv(mesh),
        texture_location=tuple(mesh.texspace_location),
        texture_size=tuple(mesh.texspace_size),
    )


def read_shape(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions (vertices, 3), the vertex of each corner (corners,) and unit normals of corners (corners, 3)."""
    positions = _attribute(mesh, "position", "vector", len(mesh.vertices), 3, np.float32)
    corner_vertices = _attribute(mesh, ".corner_vert", "value", len(mesh.loops), 1, np.int32)[:, 0]
    corner_normals = _read(mesh.corner_normals, "vector", len(mesh.loops), 3, np.float32)
    _make_unit(corner_normals)
    return positions, corner_vertices, corner_normals


def render_uv_name(mesh: bpy.types.Mesh) -> str | None:
    """Name of the UV map that is rendered when a texture names none."""
    return next((layer.name for layer in mesh.uv_layers if layer.active_render), None)


def _render_uv(mesh: bpy.types.Mesh) -> np.ndarray | None:
    name = render_uv_name(mesh)
    if name is None:
        return None
    uv = _read(mesh.uv_layers[name].uv, "vector", len(mesh.loops), 2, np.float32)
    return np.nan_to_num(uv, copy=False, nan=0.0, posinf=0.0, neginf=0.0)


def _attribute(mesh: bpy.types.Mesh, name: str, field: str, count: int, width: int, kind: type) -> np.ndarray | None:
    attribute = mesh.attributes.get(name)
    return None if attribute is None else _read(attribute.data, field, count, width, kind)


def _read(collection: bpy.types.bpy_prop_collection, field: str, count: int, width: int, kind: type) -> np.ndarray:
    values = np.empty(count * width, kind)
    collection.foreach_get(field, values)
    return values.reshape(count, width)


def _make_unit(normals: np.ndarray) -> None:
    """Repair, in place, normals of faces without area: Blender may give 0 or NaN."""
    squares = np.einsum("ij,ij->i", normals, normals)
    bad = ~(np.abs(squares - 1.0) < 1e-3)
    if bad.any():
        wrong = np.nan_to_num(normals[bad], nan=0.0, posinf=0.0, neginf=0.0)
        lengths = np.linalg.norm(wrong, axis=1, keepdims=True)
        normals[bad] = np.where(lengths > 1e-6, wrong / np.maximum(lengths, 1e-30), np.float32([0.0, 0.0, 1.0]))

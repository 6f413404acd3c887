# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated Blender meshes to indexed arrays."""

import functools
from collections.abc import Callable, Hashable
from typing import Any

import bpy
import numpy as np

from .....scene import Mesh
from .....scene.storage.sharing import keep_equal, same_bits
from ...common.report import Report
from ...common.slices import Slices
from .corner_normals import is_flat, read_corner_normals, read_corner_vertices
from .element_arrays import attribute_elements, elements

FARTHEST = 1e18
"""Coordinates beyond overflow in single precision as soon as they are squared."""
_FEW = 1 << 14
"""Corners up to which a mesh is read at once."""
_MANY = 1 << 19
"""Corners whose normals Blender computes in a slice of its own."""
_COPIED_BYTES = 1 << 23
"""Bytes of an array that are copied between two checks of the clock."""
_Copy = Callable[[np.ndarray], np.ndarray]
_PART = 1 << 16
"""Elements that are looked at while they lie in a cache."""

NO_MESH = Mesh(
    "", np.zeros((0, 3), np.float32), np.zeros(0, np.int32), np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32),
    np.zeros(0, np.int32),
)  # fmt: skip
"""In place of a mesh that is not there."""


def export_mesh(
    mesh: bpy.types.Mesh,
    name: str,
    report: Report,
    before: Mesh | None = None,
    slices: Slices | None = None,
    record: dict[Hashable, Any] | None = None,
) -> Mesh | None:
    """The arrays of an evaluated mesh, in its object space; None when it has no triangle.

    before: what it may resemble, as it was a frame ago; arrays that are the same are its very arrays.
    record: what was read of it in slices before. Raises Unfinished.
    Triangles with a vertex that is not finite, or beyond FARTHEST, are left out, with a warning that names ``name``.
    """
    if len(mesh.polygons) == 0:
        return None
    if mesh.is_editmode:  # of the object itself Blender makes another mesh (rendered_meshes.py)
        report.warn(
            f'Object "{name}": what its geometry nodes multiply is in Edit Mode, where Blender tells of no UV maps and '
            "attributes; leave Edit Mode to have them"
        )
    mesh.calc_loop_triangles()
    if len(mesh.loop_triangles) == 0:
        return None
    before = before or NO_MESH
    if slices is None or record is None or len(mesh.loops) <= _FEW:
        arrays = {field: read(mesh, getattr(before, field), np.copy) for field, read in _READERS.items()}
    else:
        arrays = _read_in_steps(mesh, before, slices, record)
    if not _all_near(arrays["positions"]):
        _skip_distant_vertices(arrays, name, report)
        if len(arrays["triangle_corners"]) == 0:
            return None
    return Mesh(
        name=name,
        **arrays,
        texture_location=tuple(mesh.texspace_location),
        texture_size=tuple(mesh.texspace_size),
    )


def _read_in_steps(
    mesh: bpy.types.Mesh, before: Mesh, slices: Slices, record: dict[Hashable, Any]
) -> dict[str, np.ndarray | None]:
    step = slices.step_alone if len(mesh.loops) > _MANY else slices.step
    if not is_flat(mesh):
        step(record, "normals", lambda: mesh.corner_normals[0].vector[0])  # Blender computes all of them
    arrays = {}
    for field, read in _READERS.items():
        copy = functools.partial(_copied, slices, record, field)
        arrays[field] = slices.step(record, field, functools.partial(read, mesh, getattr(before, field), copy))
    return arrays


def read_shape(mesh: bpy.types.Mesh, before: Mesh = NO_MESH) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions (vertices, 3), the vertex of each corner (corners,) and normals of corners (corners, 3).

    before: as for export_mesh.
    """
    return (
        _positions(mesh, before.positions, np.copy),
        _corner_vertices(mesh, before.corner_vertices, np.copy),
        read_corner_normals(mesh, before.corner_normals),
    )


def read_velocities(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """(vertices, 3) float32 meters a second of the point attribute "velocity", 0 where it is not finite; None without
    one."""
    attribute = mesh.attributes.get("velocity")
    if attribute is None or (attribute.domain, attribute.data_type) != ("POINT", "FLOAT_VECTOR"):
        return None
    velocities = elements(attribute.data, "vector", len(mesh.vertices), 3, np.float32)
    return np.where(np.abs(velocities) < FARTHEST, velocities, np.float32(0.0))


def _copied(slices: Slices, record: dict[Hashable, Any], field: str, view: np.ndarray) -> np.ndarray:
    """A copy of Blender's array, made in parts."""
    rows = max(_COPIED_BYTES // max(view[:1].nbytes, 1), 1)
    if len(view) <= rows:
        return view.copy()
    result = record.setdefault((field, "copy"), np.empty_like(view))
    for start in range(record.get((field, "place"), 0), len(view), rows):
        result[start : start + rows] = view[start : start + rows]
        record[field, "place"] = start + rows
        slices.rest()
    return result


def _kept(before: np.ndarray, view: np.ndarray, copy: _Copy) -> np.ndarray:
    """The array before if it says the same as Blender's, or else a copy of that."""
    return before if same_bits(before, view) else copy(view)


def _triangle_corners(mesh: bpy.types.Mesh, before: np.ndarray, copy: _Copy) -> np.ndarray:
    return _kept(before, elements(mesh.loop_triangles, "loops", len(mesh.loop_triangles), 3, np.int32), copy)


def _positions(mesh: bpy.types.Mesh, before: np.ndarray, copy: _Copy) -> np.ndarray:
    positions = attribute_elements(mesh, "position", "vector", len(mesh.vertices), 3, np.float32)
    if positions is None:  # in Edit Mode
        positions = elements(mesh.vertices, "co", len(mesh.vertices), 3, np.float32)
    return _kept(before, positions, copy)


def _corner_vertices(mesh: bpy.types.Mesh, before: np.ndarray, copy: _Copy) -> np.ndarray:
    return _kept(before, read_corner_vertices(mesh), copy)


def _triangle_slots(mesh: bpy.types.Mesh, before: np.ndarray, _: _Copy) -> np.ndarray:
    count = len(mesh.loop_triangles)
    if mesh.is_editmode:
        slots = elements(mesh.polygons, "material_index", len(mesh.polygons), 1, np.int32)
    else:
        slots = attribute_elements(mesh, "material_index", "value", len(mesh.polygons), 1, np.int32)
    if slots is None:
        return keep_equal(before, np.zeros(count, np.int32))
    if slots.min() < 0:
        slots = np.maximum(slots, 0)
    polygons = elements(mesh.loop_triangle_polygons, "value", count, 1, np.int32)
    if len(before) == count:
        parts = (slice(start, start + _PART) for start in range(0, count, _PART))
        if all(same_bits(before[part], slots.take(polygons[part])) for part in parts):
            return before
    return slots.take(polygons)


def _skip_distant_vertices(arrays: dict[str, np.ndarray], name: str, report: Report) -> None:
    """Drop the triangles of vertices that are not finite or farther than FARTHEST."""
    positions, triangles = arrays["positions"], arrays["triangle_corners"]
    finite = (np.abs(positions) < FARTHEST).all(axis=1)  # false for NaN as well
    good = finite[arrays["corner_vertices"][triangles]].all(axis=1)
    report.warn(
        f'Object "{name}": {np.count_nonzero(~finite)} vertices are not finite or too far away, so '
        f"{np.count_nonzero(~good)} triangles were left out; correct the mesh or its modifiers"
    )
    arrays["triangle_corners"], arrays["triangle_slots"] = triangles[good], arrays["triangle_slots"][good]
    arrays["positions"] = np.where(finite[:, None], positions, np.float32(0.0))


def _all_near(positions: np.ndarray) -> bool:
    """Whether all coordinates are less than FARTHEST from 0; false with NaN among them."""
    return bool(positions.min() > -FARTHEST and positions.max() < FARTHEST) if positions.size else True


def render_uv_name(mesh: bpy.types.Mesh) -> str | None:
    """Name of the UV map that is rendered when a texture names none."""
    return next((layer.name for layer in mesh.uv_layers if layer.active_render), None)


def _render_uv(mesh: bpy.types.Mesh, before: np.ndarray | None, copy: _Copy) -> np.ndarray | None:
    name = render_uv_name(mesh)
    if name is None or mesh.is_editmode:  # which has those of the mesh under edit
        return None
    return read_uv(mesh, name, before, copy)


_READERS: dict[str, Callable[[bpy.types.Mesh, Any, _Copy], np.ndarray | None]] = {
    "triangle_corners": _triangle_corners,
    "triangle_slots": _triangle_slots,
    "positions": _positions,
    "corner_vertices": _corner_vertices,
    "corner_normals": read_corner_normals,
    "corner_uv": _render_uv,
}
"""Functions that read the arrays of a mesh, by the names of the arrays. Each takes the mesh, an array that the result
may resemble, and a function that copies Blender's array."""


def read_uv(mesh: bpy.types.Mesh, name: str, before: np.ndarray | None = None, copy: _Copy = np.copy) -> np.ndarray:
    """(corners, 2) float32 of a UV map, 0 where it is not finite; ``before`` itself if that says the same."""
    uv = elements(mesh.uv_layers[name].uv, "vector", len(mesh.loops), 2, np.float32)
    if before is not None and same_bits(before, uv):
        return before
    uv = copy(uv)
    if np.isfinite(uv.min(initial=0.0)) and np.isfinite(uv.max(initial=0.0)):
        return uv
    return keep_equal(before, np.nan_to_num(uv, copy=False, nan=0.0, posinf=0.0, neginf=0.0))

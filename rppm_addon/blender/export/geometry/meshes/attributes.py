# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh attributes that shading nodes read: UV maps, colors, generated coordinates and others."""

from collections.abc import Hashable
from typing import Any

import bpy
import numpy as np

from .....scene import AttributeDomain, Mesh, MeshAttribute
from .....scene.meshes import SMOOTH_NORMALS
from ...common.slices import Slices
from .meshes import read_uv
from .pointiness import pointiness
from .tangents import corner_tangents, sphere_uv

GENERATED = ".generated"
"""Name under which Blender's generated coordinates are exported."""
ISLAND = ".random_per_island"
"""Name under which a random number for each connected part is exported."""
POINTINESS = ".pointiness"
"""Name under which the vertices' pointiness is exported."""
TANGENT = ".tangent:"
"""Before the name of a UV map, the name under which its tangents are exported; alone, those of the map in use."""
ACTIVE_COLOR = ".active_color"
"""Stands for the color attribute that is rendered when none is named."""
INSTANCER_GENERATED, INSTANCER_UV = "INSTANCER:.generated", "INSTANCER:.uv"
"""Names under which what multiplies an object gives each instance generated coordinates and UV of its own."""
NO_ATTRIBUTE = ".none"
"""Stands for the UV map in use, which every triangle has at hand."""

_FIELDS = {
    "FLOAT": ("value", 1), "INT": ("value", 1), "BOOLEAN": ("value", 1), "INT8": ("value", 1),
    "FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4),
    "INT32_2D": ("value", 2), "QUATERNION": ("value", 4),
}  # fmt: skip


def title_of(attribute: str) -> str:
    """Return the words by which users know an attribute that a graph reads."""
    if attribute == ACTIVE_COLOR:
        return "the color attribute in use"
    if attribute.startswith(TANGENT):
        return f'the UV map "{attribute.removeprefix(TANGENT)}"'
    domain, _, name = attribute.partition(":")
    if name and domain in {"OBJECT", "INSTANCER"}:
        return f'the property "{name}"'
    return f'the attribute or UV map "{attribute}"'


def attribute_of(owner: bpy.types.bpy_struct | None, name: str) -> tuple[float, ...] | None:
    """A custom property or a property of a datablock as up to four numbers; None when it has none of that name."""
    if owner is None or not name:
        return None
    try:
        value = owner.get(name)
        if value is None:
            value = owner.path_resolve(name)
    except (TypeError, ValueError, KeyError, AttributeError):
        return None
    try:
        numbers = tuple(float(v) for v in value) if hasattr(value, "__len__") else (float(value),)
    except (TypeError, ValueError):
        return None
    return numbers[:4] or None


def attribute_values(attribute: bpy.types.Attribute) -> np.ndarray | None:
    """(elements, components) float32, 0 where they are not finite; None of a type that holds no numbers."""
    if attribute.data_type not in _FIELDS:
        return None
    field, width = _FIELDS[attribute.data_type]
    count = len(attribute.data)
    if attribute.data_type in {"INT", "INT8", "INT32_2D"}:
        kind = np.int32
    elif attribute.data_type == "BOOLEAN":
        kind = bool
    else:
        kind = np.float32
    values = np.empty(count * width, kind)
    attribute.data.foreach_get(field, values)
    values = values.reshape(count, width).astype(np.float32, copy=False)
    if not (np.isfinite(values.min(initial=0.0)) and np.isfinite(values.max(initial=0.0))):
        values = np.nan_to_num(values, copy=False, posinf=0.0, neginf=0.0)
    return values


def export_attribute(
    exported: Mesh, mesh: bpy.types.Mesh, name: str, slices: Slices, record: dict[Hashable, Any]
) -> MeshAttribute | None:
    """An attribute of an evaluated mesh that was exported; None when the mesh has no such thing.

    record: what was done of it in slices before. Raises Unfinished.
    """
    if name in {ISLAND, POINTINESS} or name.startswith(TANGENT):
        return _computed(exported, mesh, name, slices, record)
    # Its name alone may be that of another entry of the record.
    return slices.step(record, ("attribute", name), lambda: _read(exported, mesh, name))


def _computed(
    exported: Mesh, mesh: bpy.types.Mesh, name: str, slices: Slices, record: dict[Hashable, Any]
) -> MeshAttribute | None:
    """Return an attribute that takes long to compute once its input is read."""
    if name == ISLAND:
        count, edges = len(mesh.vertices), slices.step(record, (name, "read"), lambda: _edges(mesh))
        numbers = slices.computed(record, name, lambda: _random_per_island(count, edges))
        return MeshAttribute(AttributeDomain.POINT, numbers)
    if name == POINTINESS:
        read = slices.step(record, (name, "read"), lambda: (*_vertices(mesh), _edges(mesh)))
        return MeshAttribute(AttributeDomain.POINT, slices.computed(record, name, lambda: pointiness(*read)))
    uv = slices.step(record, (name, "read"), lambda: _uv_of_tangents(exported, mesh, name.removeprefix(TANGENT)))
    if uv is None:
        return None
    goes_round = name == TANGENT and exported.corner_uv is None
    tangents = slices.computed(record, name, lambda: corner_tangents(exported, uv, goes_round))
    return MeshAttribute(AttributeDomain.CORNER, tangents)


def _read(exported: Mesh, mesh: bpy.types.Mesh, name: str) -> MeshAttribute | None:
    if name == GENERATED:
        return MeshAttribute(AttributeDomain.POINT, _generated(mesh))
    if name == SMOOTH_NORMALS:
        return _smooth_normals(exported, mesh)
    if mesh.is_editmode:  # which has those of the mesh under edit
        return None
    attribute = _rendered_color(mesh) if name == ACTIVE_COLOR else mesh.attributes.get(name)
    values = None if attribute is None else attribute_values(attribute)
    if values is None:
        return None
    if attribute.domain == "POINT":
        return MeshAttribute(AttributeDomain.POINT, values)
    if attribute.domain == "CORNER":
        return MeshAttribute(AttributeDomain.CORNER, values)
    if attribute.domain == "EDGE":
        return MeshAttribute(AttributeDomain.POINT, _mean_of_edges(mesh, values))
    if attribute.domain == "FACE":
        corner_faces = np.repeat(np.arange(len(mesh.polygons)), _lengths(mesh))
        return MeshAttribute(AttributeDomain.TRIANGLE, values[corner_faces[exported.triangle_corners[:, 0]]])
    return None


def _rendered_color(mesh: bpy.types.Mesh) -> bpy.types.Attribute | None:
    colors = mesh.color_attributes
    index = colors.render_color_index
    return colors[index] if 0 <= index < len(colors) else None


def _lengths(mesh: bpy.types.Mesh) -> np.ndarray:
    lengths = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", lengths)
    return lengths


def _generated(mesh: bpy.types.Mesh) -> np.ndarray:
    """(vertices, 3) places before deformation within the texture space, 0 to 1 in each direction."""
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("undeformed_co", places)
    location, size = np.array(mesh.texspace_location), np.array(mesh.texspace_size)
    half = np.where(size != 0.0, 0.5 / np.where(size != 0.0, size, 1.0), 0.0)
    return ((places.reshape(-1, 3) - location) * half + 0.5).astype(np.float32)


def _smooth_normals(exported: Mesh, mesh: bpy.types.Mesh) -> MeshAttribute | None:
    """None where Blender has a normal for each vertex and no other."""
    if mesh.normals_domain == "POINT":
        return None
    values = np.zeros((len(mesh.loops), 4), np.float32)
    if mesh.normals_domain == "FACE":
        _, normals = _vertices(mesh)
        values[:, :3] = normals[exported.corner_vertices]
        return MeshAttribute(AttributeDomain.CORNER, values)
    flat = ~exported.corner_normals.any(axis=1, keepdims=True)  # whose vertices move with those of the faces beside
    values[:, :3] = np.where(flat, _vertices(mesh)[1][exported.corner_vertices], exported.corner_normals)
    sharp = np.zeros(len(mesh.polygons), bool)
    if "sharp_face" in mesh.attributes:
        mesh.attributes["sharp_face"].data.foreach_get("value", sharp)
    values[:, 3] = np.repeat(~sharp, _lengths(mesh))
    return MeshAttribute(AttributeDomain.CORNER, values)


def _mean_of_edges(mesh: bpy.types.Mesh, values: np.ndarray) -> np.ndarray:
    """(vertices, components) means over the edges that meet at each vertex, as Cycles has them."""
    edges = _edges(mesh)
    sums = np.zeros((len(mesh.vertices), values.shape[1]), np.float32)
    for end in range(2):
        np.add.at(sums, edges[:, end], values)
    counts = np.bincount(edges.ravel(), minlength=len(mesh.vertices))
    return sums / np.maximum(counts, 1).astype(np.float32)[:, None]


def _uv_of_tangents(exported: Mesh, mesh: bpy.types.Mesh, name: str) -> np.ndarray | None:
    """A UV map, by default that in use; of a mesh without one, longitude and latitude."""
    if name:
        return read_uv(mesh, name) if name in mesh.uv_layers else None
    if exported.corner_uv is not None:
        return exported.corner_uv
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("undeformed_co", places)
    return sphere_uv(places.reshape(-1, 3))[exported.corner_vertices]


def _vertices(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """(vertices, 3) places and normals, each."""
    places, normals = (np.empty(3 * len(mesh.vertices), np.float32) for _ in range(2))
    mesh.vertices.foreach_get("co", places)
    mesh.vertex_normals.foreach_get("vector", normals)
    return places.reshape(-1, 3), normals.reshape(-1, 3)


def _edges(mesh: bpy.types.Mesh) -> np.ndarray:
    """(edges, 2) vertices."""
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    return edges.reshape(-1, 2)


def _random_per_island(count: int, edges: np.ndarray) -> np.ndarray:
    """(vertices, 1) a number from 0 to 1 for each connected part. The parts are Cycles', the numbers are not."""
    label = np.arange(count)
    while len(edges):
        lowest = np.minimum(label[edges[:, 0]], label[edges[:, 1]])
        before = label.copy()
        np.minimum.at(label, edges[:, 0], lowest)
        np.minimum.at(label, edges[:, 1], lowest)
        label = label[label]
        if np.array_equal(before, label):
            break
    mixed = (label.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(40)
    return (mixed.astype(np.float32) / np.float32(1 << 24))[:, None]

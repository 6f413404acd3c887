# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh attributes that shading nodes read: UV maps, colours, generated coordinates and others."""

import bpy
import numpy as np

from ...scene import AttributeDomain, MeshAttribute

GENERATED = ".generated"
"""Name under which Blender's generated coordinates are exported."""
ISLAND = ".random_per_island"
"""Name under which a random number for each connected part is exported."""

_FIELDS = {
    "FLOAT": ("value", 1), "INT": ("value", 1), "BOOLEAN": ("value", 1), "INT8": ("value", 1),
    "FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4),
    "INT32_2D": ("value", 2),
}  # fmt: skip


def export_attribute(mesh: bpy.types.Mesh, name: str, triangle_polygons: np.ndarray) -> MeshAttribute | None:
    """An attribute of an evaluated mesh; an empty name is the active colour. None when the mesh has no such thing.

    triangle_polygons: (triangles,) int32, the face of each triangle.
    """
    if name == GENERATED:
        return MeshAttribute(AttributeDomain.POINT, _generated(mesh))
    if name == ISLAND:
        return MeshAttribute(AttributeDomain.POINT, _random_per_island(mesh))
    attribute = mesh.attributes.get(name) if name else mesh.color_attributes.active_color
    if name == "" and attribute is None and mesh.color_attributes:
        attribute = mesh.color_attributes[0]
    if attribute is None or attribute.data_type not in _FIELDS:
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
    values = np.nan_to_num(values.reshape(count, width).astype(np.float32), posinf=0.0, neginf=0.0)
    if attribute.domain == "POINT":
        return MeshAttribute(AttributeDomain.POINT, values)
    if attribute.domain == "CORNER":
        return MeshAttribute(AttributeDomain.CORNER, values)
    if attribute.domain == "FACE":
        return MeshAttribute(AttributeDomain.TRIANGLE, values[triangle_polygons])
    return None


def _generated(mesh: bpy.types.Mesh) -> np.ndarray:
    """(vertices, 3) places before deformation within the texture space, 0 to 1 in each direction."""
    places = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("undeformed_co", places)
    location, size = np.array(mesh.texspace_location), np.array(mesh.texspace_size)
    half = np.where(size != 0.0, 0.5 / np.where(size != 0.0, size, 1.0), 0.0)
    return ((places.reshape(-1, 3) - location) * half + 0.5).astype(np.float32)


def _random_per_island(mesh: bpy.types.Mesh) -> np.ndarray:
    """(vertices, 1) a number from 0 to 1 for each connected part. The parts are Cycles', the numbers are not."""
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    edges = edges.reshape(-1, 2)
    label = np.arange(len(mesh.vertices))
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

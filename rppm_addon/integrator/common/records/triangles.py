# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of the scene in world space, and their attributes."""

from ....gl.buffers.records import Record
from ....gl.buffers.storage_blocks import StorageBlock

TRIANGLE_ATTRIBUTES = Record(
    "TriangleAttributes",
    normal0="uint",
    normal1="uint",
    normal2="uint",
    material="uint",
    uv0="vec2",
    uv1="vec2",
    uv2="vec2",
    instance="uint",
    mesh_triangle="uint",
)
"""Shading normals (octahedral, two 16-bit parts), UV, material and instance of a world triangle, and its number in the
mesh."""
StorageBlock("Attributes", "TriangleAttributes attributes[];")
TRIANGLE_VERTICES = Record("TriangleVertices", vertex0="vec4", vertex1="vec4", vertex2="vec4")
StorageBlock("Triangles", "vec4 triangle_vertices[];")
"""Three a triangle; for the fourth components see shaders/surfaces/geometry/gather.comp."""

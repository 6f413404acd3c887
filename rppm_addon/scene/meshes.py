# SPDX-License-Identifier: GPL-3.0-or-later
"""Indexed geometry and its placements."""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Mesh:
    """One evaluated mesh in its object space, shared by all its instances.

    Corners are Blender's loops: a corner joins a vertex to a face and carries normal and UV.
    """

    name: str
    positions: np.ndarray
    """(vertices, 3) float32, metres."""
    corner_vertices: np.ndarray
    """(corners,) int32, the vertex of each corner."""
    corner_normals: np.ndarray
    """(corners, 3) float32, unit shading normals (flat faces repeat the face normal)."""
    triangle_corners: np.ndarray
    """(triangles, 3) int32, the three corners of each triangle."""
    triangle_slots: np.ndarray
    """(triangles,) int32, material slot of each triangle."""
    corner_uv: np.ndarray | None = None
    """(corners, 2) float32 of the UV map in use, or None."""

    @property
    def triangle_count(self) -> int:
        return len(self.triangle_corners)


@dataclass
class Instance:
    """A mesh placed in the world."""

    mesh: int
    """Index into Scene.meshes."""
    matrix: np.ndarray
    """(4, 4) float64, object to world."""
    materials: list[int] = field(default_factory=list)
    """Index into Scene.materials of each material slot; slots beyond the end take the last."""
    object_name: str = ""
    object_index: int = 0

# SPDX-License-Identifier: GPL-3.0-or-later
"""Bottom levels: parameters of the deep cubemaps of meshes that instances share, in object space."""

import math
from dataclasses import dataclass

import numpy as np

from ...scene.meshes import Mesh
from ..acceleration.acceleration_structure import MARGIN
from .parameters import CORE_MARGINS, cubemap_parameters

MAX_LISTED = 8
"""Triangles of the largest mesh that is a list without cells."""
_FEW_TRIANGLES = 2000
"""Triangles of meshes whose base level is coarse, as 1638 cells would be more than they are worth."""
_SHARED_EXPONENTS = 4
"""Log2 of the ratio of the largest margin of instances that share a cubemap to the smallest."""
_MAX_RATIO = 2.0**40
"""Largest margin, in least margins: no ray finds an instance that rounding blurs so far."""
_CELL_MARGINS = 16.0
"""Least size of cells, and of the core, in margins: rays of far instances are that inexact in object space."""
_MAX_EXPONENT = 14
_NUDGE = np.array([0.0307, -0.0251, 0.0193])
"""Fractions of the mesh's radius by which the center is off the middle of its box, unlikely to be on a surface or a
plane of symmetry."""


@dataclass(frozen=True)
class MeshBounds:
    """The box around the finite vertices of a mesh, and the center of its deep cubemap; (3,) float64, meters."""

    low: np.ndarray
    high: np.ndarray
    center: np.ndarray

    @classmethod
    def of_mesh(cls, mesh: Mesh) -> "MeshBounds":
        """Return the bounds of a mesh."""
        positions = mesh.positions[np.isfinite(mesh.positions).all(axis=1)].astype(np.float64)
        if not len(positions):
            positions = np.zeros((1, 3))
        low, high = positions.min(axis=0), positions.max(axis=0)
        center = 0.5 * (low + high) + _NUDGE * 0.5 * np.linalg.norm(high - low)
        return cls(low, high, center.astype(np.float32).astype(np.float64))

    @property
    def radius(self) -> float:
        """The greatest distance of the box from the center, meters."""
        return max(float(np.linalg.norm(np.maximum(self.center - self.low, self.high - self.center))), 1e-20)

    @property
    def least_margin(self) -> float:
        """Margin that covers the rounding of the mesh's own positions, meters."""
        return MARGIN * (self.radius + float(np.linalg.norm(self.center)))

    def margin_exponents(self, margins: np.ndarray) -> np.ndarray:
        """(n,) int64: log2 of the margin, in least margins, of the cubemap for each instance that needs such a margin,
        (n,) meters in object space.

        Rays are the less exact in object space the farther away and the smaller an instance is. Cells are widened by
        the margin, so instances share those of the largest margin as long as theirs is not much smaller.
        """
        ratios = np.clip(np.nan_to_num(margins, posinf=1e30) / self.least_margin, 1.0, _MAX_RATIO)
        exponents = np.ceil(np.log2(ratios) - 1e-9).astype(np.int64)
        shared, left = np.zeros_like(exponents), np.ones(len(exponents), bool)
        while left.any():
            largest = exponents[left].max()
            members = left & (exponents > largest - _SHARED_EXPONENTS)
            shared[members] = largest
            left &= ~members
        return shared


def mesh_parameters(mesh: Mesh, bounds: MeshBounds, margin_exponent: int, first_triangle: int) -> np.void:
    """Return the STATE that the build of a mesh's cubemap begins with; that of a list, without roots, for the smallest
    meshes. margin_exponent: as of margin_exponents; first_triangle: of the mesh in the block Triangles."""
    margin = bounds.least_margin * 2.0**margin_exponent
    exponent = int(np.clip(math.floor(math.log2(bounds.radius / (_CELL_MARGINS * margin))), 2, _MAX_EXPONENT))
    state = cubemap_parameters(bounds.center, bounds.radius + 4.0 * margin, exponent, mesh.triangle_count)
    state["margin"] = margin
    state["core_radius"] = max(CORE_MARGINS * bounds.least_margin, _CELL_MARGINS * margin)
    state["first_triangle"] = first_triangle
    if mesh.triangle_count < _FEW_TRIANGLES:
        state["base_level"] = 1
    if mesh.triangle_count <= MAX_LISTED:
        _make_list(state, bounds)
    return state


def _make_list(state: np.void, bounds: MeshBounds) -> None:
    """Have all triangles of a mesh in the core, in their order."""
    state["core_radius"] = 1e6 * state["scene_radius"]
    state["core_count"] = state["triangle_count"]
    state["root_count"] = 0
    state["low_complement"] = ~sortable_bits(bounds.low.astype(np.float32) - np.float32(bounds.center))
    state["high"] = sortable_bits(bounds.high.astype(np.float32) - np.float32(bounds.center))


def sortable_bits(values: np.ndarray) -> np.ndarray:
    """uint32 that sort as float32 do (shaders/deep_cubemap/sortable_bits.glsl)."""
    bits = np.ascontiguousarray(values, np.float32).view(np.uint32)
    return bits ^ ((bits.view(np.int32) >> 31).view(np.uint32) | np.uint32(0x80000000))

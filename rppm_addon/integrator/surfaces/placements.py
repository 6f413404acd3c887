# SPDX-License-Identifier: GPL-3.0-or-later
"""Placements: the instances of a scene that have triangles, and where these lie in the world."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np

from ...scene.meshes import Instance, Mesh
from ...scene.storage.sharing import same_members
from ..common.affine import affine_inverses, determinants

_AT_ONCE = 1 << 15
"""Rows that are computed at a time: what lies between fits into a processor's cache."""
FARTHEST = 1e15
"""Meters from the origin beyond which no triangle is rendered (shaders/surfaces/geometry/mesh_arrays.glsl)."""
_FAR_VERTICES = 128.0
"""Meters from the origin of their object beyond which vertices are counted from a place among them (_pivots)."""


@dataclass(slots=True)
class Placement:
    """An instance and its first world triangle, which it has where it is expanded to world triangles."""

    instance: Instance
    first_triangle: int


class Placements(Sequence[Placement]):
    """Instances that have triangles, each with its first world triangle."""

    def __init__(self, instances: list[Instance], first_triangles: np.ndarray) -> None:
        """first_triangles: (n,) of each instance."""
        self.instances = instances
        self._first_triangles = first_triangles

    def __len__(self) -> int:
        return len(self.instances)

    def __iter__(self) -> Iterator[Placement]:
        return map(Placement, self.instances, self._first_triangles.tolist())

    @overload
    def __getitem__(self, index: int) -> Placement: ...

    @overload
    def __getitem__(self, index: slice) -> "Placements": ...

    def __getitem__(self, index: int | slice) -> "Placement | Placements":
        if isinstance(index, slice):
            return Placements(self.instances[index], self._first_triangles[index])
        return Placement(self.instances[index], int(self._first_triangles[index]))


@dataclass(frozen=True)
class PlacedMeshes:
    """Instances that have triangles, and their meshes."""

    instances: list[Instance]
    chosen: np.ndarray
    """(n,) their numbers among the instances of the scene, ascending."""
    meshes: list[Mesh]
    """All that the scene's instances have."""
    bounds: list[tuple[np.ndarray, np.ndarray] | None]
    """Bounds of the meshes, the same objects as long as their positions are."""
    which: np.ndarray
    """(n,) the mesh of each instance, by its place in ``meshes``."""
    has_pivots: bool
    """The scene is far from the world's origin."""
    insets: np.ndarray
    """(k,) the rows of those that are drawn together (volume_insets.py), which their matrices do not say."""

    def changed_since(self, before: "PlacedMeshes | None", read: np.ndarray) -> np.ndarray | None:
        """(k,) the rows that may not be as they were made of those before, ascending; None for all. ``read``: the
        instances of the scene that have changed, ascending."""
        if before is None or not self._keeps_rows(before):
            return None
        places = np.searchsorted(self.chosen, read)
        places = places[places < len(self.chosen)]
        places = places[np.isin(self.chosen[places], read)]
        return np.unique(np.concatenate([places, self.insets, before.insets]))

    def _keeps_rows(self, before: "PlacedMeshes") -> bool:
        return (
            self.has_pivots == before.has_pivots
            and same_members(self.bounds, before.bounds)
            and np.array_equal(self.chosen, before.chosen)
            and np.array_equal(self.which, before.which)
        )


class PlacedArrays:
    """Arrays with a row for each placement that follow from its matrix and from the box of its mesh. Rows of what has
    not changed stay."""

    def __init__(self) -> None:
        self.matrices = np.zeros((0, 4, 4))
        """(n, 4, 4) float64, object to world."""
        self.determinants = np.zeros(0)
        """(n,) of the matrices: negative where one mirrors."""
        self.boxes = np.zeros((0, 2, 3))
        """(n, 2, 3) float64, low and high corners in the world, meters, maybe not finite."""
        self.is_near = np.zeros(0, bool)
        """(n,) True where the box is finite and not too far away for triangles to be rendered."""
        self.pivots = np.zeros((0, 3), np.float32)
        """(n, 3) the points in object space from which vertices are counted (_pivots)."""
        self.rows = np.zeros((0, 3, 4), np.float32)
        """(n, 3, 4) upper rows of the matrices by which vertices, less the pivot, are placed."""
        self.version = 0
        """Number of calls of take."""
        self.versions = np.zeros(0, np.int64)
        """(n,) the call since which each row is as it is."""

    def take(
        self, matrices: np.ndarray, boxes: np.ndarray, which: np.ndarray, has_pivots: bool, changed: np.ndarray | None
    ) -> None:
        """Take the matrices (n, 4, 4) of the placements, the boxes (meshes, 2, 3) of meshes, and which of these each
        has, (n,). ``has_pivots``: the scene is far from the world's origin. ``changed``: the rows that differ from
        those of the last time; None for all."""
        self.matrices = matrices
        if changed is None:
            count = len(matrices)
            self.rows = np.zeros((count, 3, 4), np.float32)
            self.determinants, self.is_near = np.zeros(count), np.zeros(count, bool)
            self.boxes, self.pivots = np.zeros((count, 2, 3)), np.zeros((count, 3), np.float32)
            self.versions = np.zeros(count, np.int64)
        self.version += 1
        rows = np.arange(len(matrices)) if changed is None else changed
        for start in range(0, len(rows), _AT_ONCE):
            part = rows[start : start + _AT_ONCE]
            self._compute(boxes[which[part]], has_pivots, part)

    def _compute(self, boxes: np.ndarray, has_pivots: bool, chosen: np.ndarray) -> None:
        """Fill in rows, by the boxes (rows, 2, 3) of their meshes."""
        matrices = self.matrices[chosen]
        self.versions[chosen] = self.version
        with np.errstate(invalid="ignore", over="ignore"):
            self.determinants[chosen] = determinants(matrices)
        self.boxes[chosen, 0], self.boxes[chosen, 1], self.is_near[chosen] = placed_boxes(matrices, boxes)
        placed = matrices[:, :3]
        if has_pivots:
            pivots = _pivots(matrices, boxes)
            self.pivots[chosen] = pivots
            placed = placed.copy()
            placed[:, :, 3] += np.einsum("nij,nj->ni", matrices[:, :3, :3], pivots)
        self.rows[chosen] = placed


def placed_boxes(matrices: np.ndarray, boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes around placed boxes.

    matrices: (n, 4, 4); boxes: (n, 2, 3), low and high. Returns low and high, each (n, 3), and whether these are finite
    and not too far away for triangles to be rendered, (n,).
    """
    middle, reach = matrices[:, :3, 3], np.zeros((len(matrices), 3))
    centers, halves = 0.5 * (boxes[:, 0] + boxes[:, 1]), 0.5 * (boxes[:, 1] - boxes[:, 0])
    with np.errstate(invalid="ignore", over="ignore"):
        for axis in range(3):  # written out: thousands of products of small matrices take NumPy long
            column = matrices[:, :3, axis]
            middle = middle + column * centers[:, axis, None]
            reach += np.abs(column) * halves[:, axis, None]
        low, high = middle - reach, middle + reach
    return low, high, (np.maximum(-low, high) < FARTHEST).all(axis=1)  # false for NaN as well


def _pivots(matrices: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """(n, 3) float32 points in object space from which the vertices of placed meshes are counted as they are gathered.

    Maps and scans often have their place in their vertices instead of in their matrices (n, 4, 4): what these add then
    is large, and of the opposite sign. So where the boxes of meshes (n, 2, 3) reach far, vertices are counted from that
    place in the box which lies nearest to the origin; elsewhere from 0.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        inverses = affine_inverses(matrices)
    nearest = np.clip(inverses[:, :, 3], boxes[:, 0], boxes[:, 1])
    reach = np.einsum("nij,nj->ni", np.abs(matrices[:, :3, :3]), np.abs(boxes).max(axis=1)).max(axis=1)
    return np.where(reach[:, None] > _FAR_VERTICES, nearest, 0.0).astype(np.float32)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes: grids of voxels with the values that the nodes of a volume read."""

from dataclasses import dataclass, field

import numpy as np

from .common.declared import declared


@dataclass
class VolumeGrid:
    """Values at the centers of voxels, 0 beyond them."""

    values: np.ndarray = field(metadata=declared("x", "y", "z", "channels", types="float32", finite=False))
    """(x, y, z, 1 to 4) float32; colors are linear Rec.709."""
    matrix: np.ndarray = field(metadata=declared(4, 4))
    """(4, 4) float64 from the indices of voxels to object space: voxel (i, j, k) has its center at (i, j, k)."""

    def at(self, places: np.ndarray) -> np.ndarray:
        """(n, channels) float32 values at places (n, 3) in object space, by trilinear interpolation."""
        to_indices = np.linalg.pinv(np.asarray(self.matrix, np.float64))
        counts = np.array(self.values.shape[:3])
        indices = np.clip(places @ to_indices[:3, :3].T + to_indices[:3, 3], -1.0, counts)  # beyond are zeros
        first = np.floor(indices).astype(int)
        part = (indices - first).astype(np.float32)
        found = np.zeros((len(places), self.values.shape[3]), np.float32)
        for corner in np.ndindex(2, 2, 2):
            weights = np.where(corner, part, 1.0 - part).prod(axis=1)
            voxels = first + corner
            within = ((voxels >= 0) & (voxels < counts)).all(axis=1)
            found[within] += weights[within, None] * self.values[tuple(voxels[within].T)]
        return found


@dataclass
class VolumeMotion:
    """Motion of the values of a volume's grids while the shutter is open."""

    displacements: VolumeGrid
    """(x, y, z, 3): the way that values go in the shutter's time, meters in the space of the object."""
    rest_time: float
    """When the values are where the grids have them, in the shutter's time from 0 to 1; it may lie before or after."""

    def sources(self, places: np.ndarray, time: float) -> np.ndarray:
        """(n, 3) where the values come from that are at places (n, 3) at a time, 0 to 1, in the space of the object.

        The velocity of the values at a place is what is at their source, which is found in two steps from the place,
        as in Cycles (semi-Lagrangian advection; Kim and Ko 2007, Eulerian Motion Blur).
        """
        found = places
        for _ in range(2):
            found = places - (time - self.rest_time) * self.displacements.at(found)
        return found

    @property
    def reach(self) -> tuple[np.ndarray, np.ndarray]:
        """The furthest that values go down and up along each axis while the shutter is open, (3,) meters each."""
        values = self.displacements.values.reshape(-1, 3)
        ends = np.array([0.0 - self.rest_time, 1.0 - self.rest_time])[:, None, None]
        ways = ends * np.array([values.min(axis=0), values.max(axis=0)], np.float64)
        return np.minimum(ways.min(axis=(0, 1)), 0.0), np.maximum(ways.max(axis=(0, 1)), 0.0)


@dataclass
class Volume:
    """Grids that fill a mesh, which is the box around them."""

    grids: dict[str, VolumeGrid] = field(default_factory=dict)
    """By the names of the attributes that they are."""
    scales_density: bool = False
    """Whether coefficients are by length in the space of the object; else by length in the world."""
    motion: VolumeMotion | None = None
    """None where velocities move nothing."""

    @property
    def spacing(self) -> np.ndarray | None:
        """(3,) distances between the voxels of the finest grid along the axes of the object, meters; None without
        any."""
        found = [np.abs(grid.matrix[:3, :3]).max(axis=1) for grid in self.grids.values() if grid.values.size > 1]
        usable = [spacing for spacing in found if np.isfinite(spacing).all() and (spacing > 0.0).all()]
        return min(usable, key=np.prod) if usable else None

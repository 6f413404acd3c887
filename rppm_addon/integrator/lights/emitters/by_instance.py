# SPDX-License-Identifier: GPL-3.0-or-later
"""Emission that differs between the instances of a mesh: how much each emits, in proportion, found by samples.

Only how often emitters are chosen follows from it. Where one was chosen, its material says what it emits.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ....scene.meshes import Instance
from ....scene.storage.sharing import changed_members

AskEach = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Returns the mean magnitude of the radiance (n, 3) of triangles, each with the placement of its instance (n,), its
number (n,), and its corners (n, 3, 3) in the world."""

MOST_ASKED = 1 << 17
"""Triangles of a mesh's instances that are asked together, unless there are more instances."""
_MOST_WHOLE = 8
"""Instances that are asked for the emission of all triangles."""
LEAST = 0.05
"""Fraction of the mean that each triangle and each instance counts for at least: samples may miss what shines."""


@dataclass
class InstanceEmission:
    """Emission of a mesh's triangles on some of its instances, and how much each of the instances emits."""

    corners: np.ndarray
    """(k, 3, 3) of the triangles whose emission differs, in object space."""
    triangles: np.ndarray
    """(k,) int64, their numbers."""
    areas: np.ndarray
    """(k,) in object space."""
    radiance: np.ndarray
    """(k, 3) mean over instances."""
    instances: list[Instance]
    """Instances with the mesh, when the strengths were found."""
    strengths: np.ndarray
    """(n,) what each emits by these triangles, as a multiple of what ``radiance`` says."""

    @classmethod
    def ask(
        cls,
        corners: np.ndarray,
        triangles: np.ndarray,
        areas: np.ndarray,
        instances: list[Instance],
        placements: np.ndarray,
        ask: AskEach,
    ) -> "InstanceEmission":
        """Ask the materials. placements: (n,) those of the instances."""
        whole = min(_MOST_WHOLE, max(1, MOST_ASKED // max(len(triangles), 1)), len(instances))
        total = np.zeros((len(triangles), 3))
        for number in np.linspace(0, len(instances) - 1, whole).astype(np.int64).tolist():
            placed = _placed(corners, instances[number].matrix[None])[0]
            total += ask(np.full(len(triangles), placements[number]), triangles, placed)
        mean = np.average(total, axis=0, weights=areas) if len(triangles) else np.zeros(3)
        radiance = np.maximum(total, LEAST * mean) / whole if mean.any() else np.ones_like(total)
        found = cls(corners, triangles, areas, radiance, list(instances), np.zeros(0))
        found.strengths = found._ask_strengths(instances, placements, ask)
        if mean.any() and not found.strengths.any():
            found.strengths[:] = 1.0
        return found

    def follow(self, instances: list[Instance], placements: np.ndarray, ask: AskEach) -> None:
        """Ask again for instances that are not the very ones of the last time."""
        if len(instances) != len(self.instances):
            rows = np.arange(len(instances))
            self.strengths = np.zeros(len(instances))
        else:
            rows = changed_members(self.instances, instances)
        if len(rows):
            self.strengths[rows] = self._ask_strengths([instances[row] for row in rows.tolist()], placements[rows], ask)
        self.instances = list(instances)

    @property
    def weights(self) -> np.ndarray:
        """(n,) the strengths, none of them small beside the mean."""
        return np.maximum(self.strengths, LEAST * self.strengths.mean()) if len(self.strengths) else self.strengths

    def _ask_strengths(self, instances: list[Instance], placements: np.ndarray, ask: AskEach) -> np.ndarray:
        """(n,) strengths by triangles that stand for parts of the mesh's power."""
        power = self.radiance.mean(axis=1) * self.areas
        share = power / max(power.sum(), 1e-300)
        some = max(1, MOST_ASKED // max(len(instances), 1))
        if some < len(share):
            parts = np.searchsorted(np.cumsum(share), (np.arange(some) + 0.5) / some)
            chosen, share = np.minimum(parts, len(share) - 1), np.full(some, 1.0 / some)
        else:
            chosen = np.arange(len(share))
        strengths = np.zeros(len(instances))
        step = max(1, MOST_ASKED // max(len(chosen), 1))
        for start in range(0, len(instances), step):
            matrices = np.array([instance.matrix for instance in instances[start : start + step]], np.float64)
            corners = _placed(self.corners[chosen], matrices).reshape(-1, 3, 3)
            count = len(matrices)
            numbers = np.repeat(placements[start : start + step], len(chosen))
            radiance = ask(numbers, np.tile(self.triangles[chosen], count), corners).mean(axis=1)
            ratios = radiance.reshape(count, -1) / np.maximum(self.radiance[chosen].mean(axis=1), 1e-300)
            strengths[start : start + step] = ratios @ share
        return strengths


def _placed(corners: np.ndarray, matrices: np.ndarray) -> np.ndarray:
    """(n, k, 3, 3) corners (k, 3, 3) placed by matrices (n, 4, 4)."""
    return np.einsum("nij,kcj->nkci", matrices[:, :3, :3], corners) + matrices[:, None, None, :3, 3]

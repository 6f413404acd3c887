# SPDX-License-Identifier: GPL-3.0-or-later
"""Items that the lists of a deep cubemap name: clusters of triangles, or boxes of instances."""

from dataclasses import dataclass

SCENE_CLUSTER_SIZES = {1 << 24: 8, 1 << 20: 4}
"""Largest clusters of scenes with at least so many triangles (docs/benchmarks/instances.md)."""
_LIST_LENGTHS = {1: 1.0, 2: 0.7, 4: 0.5, 8: 0.3}
"""Lengths of lists relative to those without clusters, by the size of the largest cluster."""


@dataclass(frozen=True)
class Clusters:
    """Clusters of 1, 2, 4 or 8 triangles that follow each other and lie together. They change no hit."""

    max_size: int = 1
    """Triangles of the largest cluster; 1 where each triangle is listed by itself."""
    are_boxes: bool = False
    """Whether boxes of instances, one by one, are listed in place of triangles."""

    @classmethod
    def of_scene(cls, triangle_count: int) -> "Clusters":
        """Return the clusters for a scene of so many triangles."""
        sizes = SCENE_CLUSTER_SIZES.items()
        return cls(next((size for triangles, size in sizes if triangle_count >= triangles), 1))

    @property
    def defines(self) -> dict[str, object]:
        """Defines of programs that read which triangles an entry names."""
        if self.are_boxes:
            return {"INSTANCE_BOXES": 1}
        return {"TRIANGLE_CLUSTERS": 1} if self.max_size > 1 else {}

    @property
    def list_length(self) -> float:
        """Length of lists relative to those without clusters."""
        return _LIST_LENGTHS[self.max_size]

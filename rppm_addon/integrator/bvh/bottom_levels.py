# SPDX-License-Identifier: GPL-3.0-or-later
"""Bottom levels: hierarchies of the meshes that instances share, each built once."""

import numpy as np

from ...scene.meshes import Mesh
from ..acceleration.acceleration_structure import MARGIN
from .clustering import NODE
from .leaves import triangle_nodes
from .top_level import placed_nodes

_Key = tuple[int, int, int]


class BottomLevels:
    """Nodes of the meshes' hierarchies, one behind the other. A mesh's hierarchy is built when its arrays are new."""

    def __init__(self) -> None:
        self._known: dict[_Key, tuple[tuple[np.ndarray, ...], np.ndarray]] = {}
        """By the ids of a mesh's arrays, these, which keeps the ids theirs, and its nodes."""
        self._order: list[_Key] = []
        self.roots = np.zeros(0, np.int64)
        """(meshes,) number of the root of each mesh."""
        self.node_count = 0

    def build(self, meshes: list[Mesh]) -> bool:
        """Take the meshes; returns whether any place of any node has changed."""
        known, self._known = self._known, {}
        order = []
        for mesh in meshes:
            arrays = mesh.positions, mesh.corner_vertices, mesh.triangle_corners
            key = id(arrays[0]), id(arrays[1]), id(arrays[2])
            if key not in self._known:
                self._known[key] = known.get(key) or (arrays, _mesh_nodes(mesh))
            order.append(key)
        is_new = order != self._order or any(self._known[key] is not known.get(key) for key in order)
        self._order = order
        counts = [len(self._known[key][1]) for key in order]
        self.roots = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)[:-1]
        self.node_count = sum(counts)
        return is_new

    def nodes(self) -> np.ndarray:
        """NODE records of all meshes, whose children are numbered from the first on."""
        nodes = NODE.zeros(self.node_count)
        for key, root in zip(self._order, self.roots.tolist(), strict=True):
            part = placed_nodes(self._known[key][1], root)
            nodes[root : root + len(part)] = part
        return nodes


def _mesh_nodes(mesh: Mesh) -> np.ndarray:
    vertices = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float32)
    finite = np.abs(mesh.positions[np.isfinite(mesh.positions).all(axis=1)])
    return triangle_nodes(vertices, max(float(finite.max(initial=0.0)), 1e-20) * MARGIN)

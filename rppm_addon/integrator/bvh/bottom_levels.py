# SPDX-License-Identifier: GPL-3.0-or-later
"""Bottom levels: hierarchies of the meshes that instances share, each built once."""

import numpy as np

from ...scene.meshes import Mesh
from ..acceleration.acceleration_structure import MARGIN
from .clustering import NODE
from .forest import MOST_BOXES
from .leaves import nodes_of_small_meshes, triangle_nodes
from .top_level import placed_nodes

TRIANGLES_AT_ONCE = 1 << 17
"""Triangles of small meshes whose hierarchies are built together."""

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
        known, order = self._known, [_key_of(mesh) for mesh in meshes]
        new = {key: mesh for key, mesh in zip(order, meshes, strict=True) if key not in known}
        made = dict(zip(new, _nodes_of(list(new.values())), strict=True))
        self._known = {key: known.get(key) or (_arrays(new[key]), made[key]) for key in order}
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


def _arrays(mesh: Mesh) -> tuple[np.ndarray, ...]:
    return mesh.positions, mesh.corner_vertices, mesh.triangle_corners


def _key_of(mesh: Mesh) -> _Key:
    positions, vertices, corners = _arrays(mesh)
    return id(positions), id(vertices), id(corners)


def _nodes_of(meshes: list[Mesh]) -> list[np.ndarray]:
    """NODE records of the hierarchy of each mesh, the root first. Small meshes are built together."""
    result: list[np.ndarray] = [NODE.zeros(0)] * len(meshes)
    counts = np.array([mesh.triangle_count for mesh in meshes], np.int64)
    small = np.flatnonzero(counts <= MOST_BOXES)
    parts = np.split(small, np.flatnonzero(np.diff(np.cumsum(counts[small]) // TRIANGLES_AT_ONCE)) + 1)
    for part in (part.tolist() for part in parts if len(part)):
        vertices, margins = [_vertices(meshes[n]) for n in part], [_margin(meshes[n]) for n in part]
        for number, nodes in zip(part, nodes_of_small_meshes(vertices, margins), strict=True):
            result[number] = nodes
    for number in np.flatnonzero(counts > MOST_BOXES).tolist():
        result[number] = triangle_nodes(_vertices(meshes[number]), _margin(meshes[number]))
    return result


def _vertices(mesh: Mesh) -> np.ndarray:
    """(n, 3, 3) float32 of the triangles, meters."""
    return mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float32)


def _margin(mesh: Mesh) -> float:
    """Margin of the boxes of its hierarchy, meters."""
    finite = np.abs(mesh.positions[np.isfinite(mesh.positions).all(axis=1)])
    return max(float(finite.max(initial=0.0)), 1e-20) * MARGIN

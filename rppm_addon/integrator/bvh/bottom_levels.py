# SPDX-License-Identifier: GPL-3.0-or-later
"""Bottom levels: hierarchies of the meshes that instances share, each built once."""

import numpy as np

from ...scene.meshes import Mesh
from ..acceleration.acceleration_structure import MARGIN
from ..acceleration.instances import INSTANCE_LEAF, InstancedMeshes
from .clustering import NODE
from .leaves import EMPTY_LEAF, LEAF, box_nodes, triangle_nodes

_Key = tuple[int, int, int]
_WORLD = np.uint32(0xFFFFFFF8)
"""A leaf of no number that an instance has: it stands for the root of the world triangles."""


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
            part = moved_nodes(self._known[key][1], root)
            nodes[root : root + len(part)] = part
        return nodes


def top_level_nodes(world: np.ndarray, first_world: int, margin: float, instanced: InstancedMeshes) -> np.ndarray:
    """NODE records of the top level, which follow those of the world triangles: over the instances, and over the
    hierarchy of the world triangles (NODE records), whose root is node ``first_world``."""
    low, high = (instanced.boxes[:, side].astype(np.float32) for side in (0, 1))
    with np.errstate(invalid="ignore"):
        exists = (np.maximum(-low, high) < 1e15).all(axis=1)  # false for NaN as well
    low, high, numbers = low[exists], high[exists], np.flatnonzero(exists).astype(np.uint32)
    leaves = np.uint32(LEAF) | numbers << np.uint32(2) | np.uint32(INSTANCE_LEAF)
    if world["child0"][0] != EMPTY_LEAF:
        low, high = (
            np.vstack([low, _root_box(world, np.minimum, "low")]),
            np.vstack([high, _root_box(world, np.maximum, "high")]),
        )
        leaves = np.append(leaves, _WORLD)
    nodes = moved_nodes(box_nodes((low.T, high.T, leaves), margin), first_world + len(world))
    for child in ("child0", "child1"):
        nodes[child][nodes[child] == _WORLD] = first_world
    return nodes


def _root_box(nodes: np.ndarray, reduce: np.ufunc, side: str) -> np.ndarray:
    """Low or high corner, (3,), of the box around a hierarchy."""
    root = nodes[0]
    if root["child1"] == EMPTY_LEAF:
        return np.asarray(root[f"{side}0"])
    return np.asarray(reduce(root[f"{side}0"], root[f"{side}1"]))


def _mesh_nodes(mesh: Mesh) -> np.ndarray:
    vertices = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float32)
    finite = np.abs(mesh.positions[np.isfinite(mesh.positions).all(axis=1)])
    return triangle_nodes(vertices, max(float(finite.max(initial=0.0)), 1e-20) * MARGIN)


def moved_nodes(nodes: np.ndarray, first: int) -> np.ndarray:
    """Nodes whose children are numbered from a node on."""
    moved = nodes.copy()
    for child in ("child0", "child1"):
        is_inner = moved[child] & np.uint32(LEAF) == 0
        moved[child][is_inner] += np.uint32(first)
    return moved

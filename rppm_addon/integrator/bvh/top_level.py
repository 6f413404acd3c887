# SPDX-License-Identifier: GPL-3.0-or-later
"""Top level: the hierarchy of instances, in which few that move leave all others where they are."""

import numpy as np

from ..acceleration.instances import INSTANCE_LEAF, InstancedMeshes
from .clustering import MAX_DEPTH, NODE
from .leaves import EMPTY_LEAF, LEAF, box_nodes

_WORLD = np.uint32(0xFFFFFFF8)
_REST = np.uint32(0xFFFFFFF0)
"""Leaves of numbers that no instance has: they stand for the roots of the world triangles, and of what rests."""
_SMALLEST = 4096
"""Instances up to which all are sorted anew, which takes no longer than to find out who has moved."""
_MOVING = 16
"""Number of instances of which one may move before all are sorted anew."""


class TopLevel:
    """A hierarchy of instances and, as one of them, of the world triangles.

    Instances that change later have a small hierarchy of their own, one leaf of which is the whole hierarchy of those
    that rest; there, their leaves are empty. So what an edit costs follows from what it moves.
    """

    def __init__(self) -> None:
        self.rest = NODE.zeros(0)
        """Hierarchy of what rests; its children are numbered from 0 on, the world's root is _WORLD."""
        self.emptied = np.zeros(0, np.int64)
        """Nodes of ``rest`` that the last call of take has changed."""
        self.moving = NODE.zeros(0)
        """Hierarchy of what moves, the root first; none where everything rests."""
        self._depth = 0
        """Nodes between the root of what rests and a leaf, at most."""
        self._places = np.zeros(0, np.int64)
        """(instances,) twice the node of ``rest`` that has each as a leaf, plus the side; -1 where it is none."""
        self._has_moved = np.zeros(0, bool)
        self._margin = 0.0

    @property
    def capacity(self) -> int:
        """Nodes that there may be before all are sorted anew."""
        return len(self.rest) + len(self._has_moved) // _MOVING + 1

    def take(self, world: np.ndarray, margin: float, instanced: InstancedMeshes, changed: np.ndarray | None) -> bool:
        """Take instances; returns True where all are sorted anew.

        world: NODE records of the hierarchy of world triangles. margin: how far boxes are widened, meters. changed:
        the rows of instances that differ from those of the last time; None where all may, or the world.
        """
        if changed is not None and margin <= 2.0 * self._margin and self._move(instanced, margin, changed):
            return False
        low, high, numbers = _boxes(instanced, np.arange(len(instanced.which)))
        leaves = _leaves(numbers)
        if world["child0"][0] != EMPTY_LEAF:
            low, high, leaves = _joined(low, high, leaves, world, _WORLD)
        self.rest, self.moving = box_nodes((low.T, high.T, leaves), margin), NODE.zeros(0)
        self.emptied = np.zeros(0, np.int64)
        self._margin, self._depth = margin, _depth(self.rest)
        self._has_moved = np.zeros(len(instanced.which), bool)
        self._places = np.full(len(instanced.which), -1)
        for side in (0, 1):
            children = self.rest[f"child{side}"]
            nodes = np.flatnonzero((children & np.uint32(LEAF) != 0) & (children & np.uint32(3) == INSTANCE_LEAF))
            self._places[(children[nodes] & ~np.uint32(LEAF)) >> np.uint32(2)] = 2 * nodes + side
        return True

    def _move(self, instanced: InstancedMeshes, margin: float, changed: np.ndarray) -> bool:
        """Have what has changed among what moves; returns False where that would be too much or too deep."""
        has_moved = self._has_moved.copy()
        has_moved[changed] = True
        rows = np.flatnonzero(has_moved)
        if len(has_moved) < _SMALLEST or len(rows) * _MOVING > len(has_moved):
            return False
        low, high, numbers = _boxes(instanced, rows)
        low, high, leaves = _joined(low, high, _leaves(numbers), self.rest, _REST)
        moving = box_nodes((low.T, high.T, leaves), margin)
        if self._depth + _depth(moving) > MAX_DEPTH:
            return False
        places = self._places[changed]
        places = places[places >= 0]
        for side in (0, 1):
            self.rest[f"child{side}"][places[places % 2 == side] // 2] = EMPTY_LEAF
        self._places[changed] = -1
        self._has_moved, self.moving, self.emptied = has_moved, moving, np.unique(places // 2)
        return True

    def placed_rest(self, first: int, first_world: int, chosen: np.ndarray | slice = slice(None)) -> np.ndarray:
        """NODE records of what rests, from node ``first`` on; ``first_world``: the root of the world triangles."""
        return placed_nodes(self.rest[chosen], first, {_WORLD: first_world})

    def placed_moving(self, first: int, first_rest: int) -> np.ndarray:
        """NODE records of what moves, from node ``first`` on; ``first_rest``: the root of what rests."""
        return placed_nodes(self.moving, first, {_REST: first_rest})


def placed_nodes(nodes: np.ndarray, first: int, roots: dict[np.uint32, int] | None = None) -> np.ndarray:
    """Nodes whose children are numbered from a node on, with the nodes that leaves of some numbers stand for."""
    placed = nodes.copy()
    for child in ("child0", "child1"):
        is_inner = placed[child] & np.uint32(LEAF) == 0
        placed[child][is_inner] += np.uint32(first)
        for leaf, root in (roots or {}).items():
            placed[child][placed[child] == leaf] = root
    return placed


def _boxes(instanced: InstancedMeshes, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners of the boxes of those instances that can be met, (n, 3) float32 each, and their numbers."""
    low, high = (instanced.boxes[rows, side].astype(np.float32) for side in (0, 1))
    with np.errstate(invalid="ignore"):
        exists = (np.maximum(-low, high) < 1e15).all(axis=1)  # false for NaN as well
    return low[exists], high[exists], rows[exists]


def _leaves(numbers: np.ndarray) -> np.ndarray:
    return np.uint32(LEAF) | numbers.astype(np.uint32) << np.uint32(2) | np.uint32(INSTANCE_LEAF)


def _joined(
    low: np.ndarray, high: np.ndarray, leaves: np.ndarray, nodes: np.ndarray, leaf: np.uint32
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes and leaves with that of the whole of a hierarchy."""
    root = nodes[0]
    sides = ("0",) if root["child1"] == EMPTY_LEAF else ("0", "1")
    lowest = np.min([root[f"low{side}"] for side in sides], axis=0)
    highest = np.max([root[f"high{side}"] for side in sides], axis=0)
    return np.vstack([low, lowest]), np.vstack([high, highest]), np.append(leaves, leaf)


def _depth(nodes: np.ndarray) -> int:
    """Nodes between the root of a hierarchy and any leaf, at most."""
    depth, level = 0, np.zeros(1, np.int64)
    while len(level):
        depth += 1
        children = np.concatenate([nodes["child0"][level], nodes["child1"][level]])
        level = children[children & np.uint32(LEAF) == 0].astype(np.int64)
    return depth

# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves of bounding volume hierarchies: triangles, in pairs where they lie together."""

import numpy as np

from .clustering import NODE, build_nodes
from .forest import build_forest

LEAF = 0x80000000
"""Bit of a child that is a leaf: a number from bit 2 on, and below that the number of triangles from there on."""
EMPTY_LEAF = np.uint32(LEAF)

Boxes = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Low and high corners, (3, n) float32 in meters each, and what stands for each box in its node, (n,) uint32."""


def triangle_nodes(vertices: np.ndarray, margin: float) -> np.ndarray:
    """NODE records of a hierarchy of triangles, the root first; vertices: (n, 3, 3) float32, meters.

    margin: how far boxes are widened, meters. Triangles with infinite or NaN coordinates are left out.
    """
    return box_nodes(_leaves(vertices), margin)


def nodes_of_small_meshes(meshes: list[np.ndarray], margins: list[float]) -> list[np.ndarray]:
    """Hierarchies as triangle_nodes makes them, of the vertices of each mesh and its margin, built together.

    Meshes have no more than MOST_BOXES triangles. The larger of them may have another tree than triangle_nodes gives
    them, as more neighbors are compared.
    """
    # Two triangles that share a leaf are of the same mesh.
    padded = [np.concatenate([v, np.full((len(v) % 2, 3, 3), np.nan, np.float32)]) for v in meshes]
    ends = np.cumsum([len(vertices) for vertices in padded])
    low, high, leaves = _leaves(np.concatenate(padded))
    owners = np.searchsorted(ends, (leaves & ~np.uint32(LEAF)) >> np.uint32(2), side="right")
    leaves -= np.concatenate([[0], ends])[owners].astype(np.uint32) << np.uint32(2)
    widths = np.array(margins, np.float32)[owners]
    low, high = low - widths, high + widths
    counts = np.bincount(owners, minlength=len(meshes))
    are_trees = counts > 1
    chosen = np.flatnonzero(are_trees[owners])
    trees = iter(build_forest(low[:, chosen], high[:, chosen], leaves[chosen], counts[are_trees]))
    firsts = np.cumsum(counts) - counts
    return [
        next(trees) if is_tree else _root(low[:, first:end], high[:, first:end], leaves[first:end])
        for first, end, is_tree in zip(firsts, firsts + counts, are_trees, strict=True)
    ]


def box_nodes(boxes: Boxes, margin: float) -> np.ndarray:
    """NODE records of a hierarchy of boxes, the root first. margin: as that of triangle_nodes."""
    low, high, leaves = boxes
    low, high = low - np.float32(margin), high + np.float32(margin)
    if len(leaves) > 1:
        return build_nodes(low, high, leaves)
    return _root(low, high, leaves)


def _root(low: np.ndarray, high: np.ndarray, leaves: np.ndarray) -> np.ndarray:
    """The only node of a hierarchy of one box or none."""
    root = NODE.zeros(1)
    root["child0"] = root["child1"] = EMPTY_LEAF
    if len(leaves):
        root["low0"], root["high0"], root["child0"] = low[:, 0], high[:, 0], leaves
    return root


def _leaves(vertices: np.ndarray) -> Boxes:
    """Boxes of leaves, their corners (3, n) float32 in meters, and the leaves, (n,) uint32.

    Two triangles that follow each other share a leaf where their common box has no more area than their own boxes
    together, as the two of a quadrilateral do.
    """
    count = len(vertices)
    low = np.minimum(np.minimum(vertices[:, 0], vertices[:, 1]), vertices[:, 2]).T.copy()
    high = np.maximum(np.maximum(vertices[:, 0], vertices[:, 1]), vertices[:, 2]).T.copy()
    is_finite = np.isfinite(low).all(axis=0) & np.isfinite(high).all(axis=0)
    even, odd = slice(0, count - count % 2, 2), slice(1, None, 2)
    common_low, common_high = np.minimum(low[:, even], low[:, odd]), np.maximum(high[:, even], high[:, odd])
    with np.errstate(over="ignore", invalid="ignore"):
        areas = _half_areas(low, high)
        are_paired = is_finite[even] & is_finite[odd]
        are_paired &= _half_areas(common_low, common_high) <= areas[even] + areas[odd]
    low[:, even], high[:, even] = (
        np.where(are_paired, common_low, low[:, even]),
        np.where(are_paired, common_high, high[:, even]),
    )
    sizes = np.ones(count, np.uint32)
    sizes[even][are_paired] = 2
    is_leaf = is_finite
    is_leaf[odd] &= ~are_paired
    first = np.flatnonzero(is_leaf)
    leaves = np.uint32(LEAF) | first.astype(np.uint32) << np.uint32(2) | sizes[first]
    return np.take(low, first, axis=1), np.take(high, first, axis=1), leaves


def _half_areas(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Half of the area of boxes, (n,) square meters."""
    x, y, z = high - low
    return x * (y + z) + y * z

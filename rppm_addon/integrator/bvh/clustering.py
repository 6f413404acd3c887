# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds a binary bounding volume hierarchy from the bottom up by parallel locally-ordered clustering.

The boxes are sorted along a Morton curve. In every pass each cluster finds, among its neighbors along the curve, the
one with which it shares the box of the least area; two clusters that find each other become one. (Meister and
Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction", IEEE TVCG 2018.) The trees
are about as good as those of a binned surface area heuristic.
"""

import concurrent.futures
import functools

import numpy as np

from ...gl.buffers.records import Record
from ...processors import usable_cores

NODE = Record("BvhNode", low0="vec3", child0="uint", high0="vec3", low1="vec3", child1="uint", high1="vec3")
"""An inner node: the boxes of its two children, meters, and what the children are: the number of an inner node, or
LEAF and what a leaf holds."""

MAX_DEPTH = 64
"""Inner nodes between the root and any leaf, at most: a ray's stack has so many places."""

_REACH = 8
"""Neighbors to either side that a cluster is compared with."""
FEW, REACH_OF_FEW = 2048, 32
"""So few clusters are compared with more of their neighbors, as they are the top of the tree, which every ray meets."""
BLOCK = 1 << 14
"""Clusters that are compared at a time, whose boxes fit into a processor's cache."""
_MORTON_BITS = 20
"""Per axis."""


def build_nodes(low: np.ndarray, high: np.ndarray, children: np.ndarray) -> np.ndarray:
    """Nodes of the hierarchy of boxes, NODE records, the root first.

    low, high: (3, n) float32, the boxes' corners, meters; children: (n,) uint32, what stands for each box in its
    node. There are n - 1 nodes, and n must be 2 or more. No leaf lies deeper than MAX_DEPTH nodes.
    """
    order = np.argsort(_morton_codes(low, high))
    low, high, children = np.take(low, order, axis=1), np.take(high, order, axis=1), children[order]
    nodes = NODE.zeros(len(order) - 1)
    end = len(nodes)
    """Nodes are numbered from the last to the first, the root, so that each stands before its children."""
    passes = 0
    workers = concurrent.futures.ThreadPoolExecutor(usable_cores(), "RPPM hierarchy")
    with workers:
        while len(children) > 1:
            count = len(children)
            # A pass deepens the tree by one at most.
            is_deep = passes + (count - 1).bit_length() >= MAX_DEPTH
            first, second = _next_in_line(count) if is_deep else _mutually_nearest(low, high, workers)
            passes += 1
            made = slice(end - len(first), end)
            join(nodes[made], np.arange(made.start, made.stop), low, high, children, first, second)
            end = made.start
            is_left = np.ones(count, bool)
            is_left[second] = False
            left = np.flatnonzero(is_left)
            low, high, children = np.take(low, left, axis=1), np.take(high, left, axis=1), children[left]
    return nodes


def join(
    nodes: np.ndarray,
    numbers: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    children: np.ndarray,
    first: np.ndarray,
    second: np.ndarray,
) -> None:
    """Join pairs of clusters, ``first`` and ``second`` (n,) by number: fill in the node of each pair, for which its
    first cluster stands from then on.

    nodes: (n,) NODE records, and ``numbers`` (n,) theirs. low, high, children: of all clusters, as build_nodes has
    them.
    """
    for side, clusters in enumerate((first, second)):
        nodes[f"low{side}"], nodes[f"high{side}"] = low[:, clusters].T, high[:, clusters].T
        nodes[f"child{side}"] = children[clusters]
    children[first] = numbers
    low[:, first] = np.minimum(low[:, first], low[:, second])
    high[:, first] = np.maximum(high[:, first], high[:, second])


def _morton_codes(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """(n,) uint64: the places of the boxes' centers along a Morton curve through a cube around all of them."""
    centers = low + high  # twice the centers
    least = centers.min(axis=1, keepdims=True)
    side = float((centers.max(axis=1, keepdims=True) - least).max())
    return interleaved(((centers - least) * np.float32(cells_of_side(side))).astype(np.uint64))


def cells_of_side(side: float) -> float:
    """Cells of a Morton curve in a meter, of a cube with a side of so many meters."""
    return (2**_MORTON_BITS - 1) / max(side, 1e-30)


def interleaved(cells: np.ndarray) -> np.ndarray:
    """(n,) uint64: the places along a Morton curve of cells (3, n) uint64, by their numbers along each axis."""
    codes = np.zeros(cells.shape[1], np.uint64)
    for axis, cell in enumerate(cells):
        for shift, mask in (
            (32, 0x1F00000000FFFF),
            (16, 0x1F0000FF0000FF),
            (8, 0x100F00F00F00F00F),
            (4, 0x10C30C30C30C30C3),
            (2, 0x1249249249249249),
        ):
            cell = (cell | cell << np.uint64(shift)) & np.uint64(mask)
        codes |= cell << np.uint64(2 - axis)
    return codes


def _next_in_line(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of clusters that follow each other along the curve: the numbers of the first and of the second ones."""
    first = np.arange(0, count - 1, 2)
    return first, first + 1


def _mutually_nearest(
    low: np.ndarray, high: np.ndarray, workers: concurrent.futures.Executor
) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of clusters each of which shares the box of the least area with the other: the numbers of the first and
    of the second ones. There is one at least."""
    count = low.shape[1]
    if count <= FEW:
        partners = _partners_of_few(low, high, min(REACH_OF_FEW, count - 1))
    else:
        partners = np.empty(count, np.int32)
        of_block = functools.partial(find_partners, low, high, min(_REACH, count - 1), partners)
        list(workers.map(of_block, range(0, count, BLOCK)))
    numbers = np.arange(count, dtype=np.int32)
    first = np.flatnonzero((partners[partners] == numbers) & (numbers < partners))
    # Areas beyond the range of floats are equal to none.
    return (first, partners[first]) if len(first) else _next_in_line(count)


def _partners_of_few(low: np.ndarray, high: np.ndarray, reach: int) -> np.ndarray:
    """(n,) what find_partners finds, for all distances at once: few clusters take no longer than a call of NumPy."""
    count = low.shape[1]
    numbers, distances = np.arange(count), np.arange(1, reach + 1)[:, None]
    behind = numbers + distances
    exists, behind = behind < count, np.minimum(behind, count - 1)
    with np.errstate(over="ignore", invalid="ignore"):
        x, y, z = (
            np.maximum(ends[behind], ends) - np.minimum(starts[behind], starts)
            for starts, ends in zip(low, high, strict=True)
        )
        areas = (y + z) * x + y * z
    areas[~exists | np.isnan(areas)] = np.inf
    # Of each distance the cluster behind and that before, in the order in which find_partners looks at them.
    candidates = np.full((reach, 2, count), np.inf, np.float32)
    candidates[:, 0] = areas
    for distance in range(1, reach + 1):
        candidates[distance - 1, 1, distance:] = areas[distance - 1, : count - distance]
    comes_first = (numbers // distances) & 1 == 0
    candidates = np.where(comes_first[:, None], candidates, candidates[:, ::-1])
    best = candidates.reshape(2 * reach, count).argmin(axis=0)
    distance, is_second = best // 2 + 1, best % 2 == 1
    is_behind = comes_first[distance - 1, numbers] != is_second
    partners = np.where(is_behind, numbers + distance, numbers - distance)
    has_any = candidates.reshape(2 * reach, count)[best, numbers] < np.inf
    return np.where(has_any, partners, numbers).astype(np.int32)


def find_partners(
    low: np.ndarray,
    high: np.ndarray,
    reach: int,
    partners: np.ndarray,
    begin: int,
    trees: np.ndarray | None = None,
    starts: np.ndarray | None = None,
) -> None:
    """Fill in the partners of a block of clusters: of each the neighbor, among ``reach`` to either side, with which it
    shares the box of the least area. Of equal areas all clusters prefer the same pair, lest none find each other.

    trees: (n,) int32, the tree of each cluster, of which only those of the same are neighbors, and ``starts``, (n,)
    int32, the first cluster of that tree; None where all are of one.
    """
    end = min(begin + BLOCK, len(partners))
    first, last = max(begin - reach, 0), min(end + reach, len(partners))
    low, high = low[:, first:last], high[:, first:last]
    count = last - first
    numbers = np.arange(first, last, dtype=np.int32)
    places = numbers if starts is None else numbers - starts[first:last]
    least, nearest = np.full(count, np.inf, np.float32), numbers.copy()
    sizes, lows = np.empty((3, count), np.float32), np.empty((3, count), np.float32)
    areas, is_nearer = np.empty(count, np.float32), np.empty(count, bool)

    def take(which: slice, partner: slice, area: np.ndarray, nearer: np.ndarray) -> None:
        np.copyto(least[which], area, where=nearer)
        np.copyto(nearest[which], numbers[partner], where=nearer)

    with np.errstate(over="ignore"):  # areas beyond the range of floats are the least of none
        for distance in range(1, min(reach, count - 1) + 1):
            pairs = count - distance
            before, behind = slice(pairs), slice(distance, None)
            size, area, nearer = sizes[:, before], areas[before], is_nearer[before]
            np.maximum(high[:, behind], high[:, before], out=size)
            size -= np.minimum(low[:, behind], low[:, before], out=lows[:, before])
            np.add(size[1], size[2], out=area)
            area *= size[0]
            size[1] *= size[2]
            area += size[1]
            if trees is not None:
                are_apart = trees[first : last - distance] != trees[first + distance : last]
                np.copyto(area, np.float32(np.inf), where=are_apart)
            # In a row of equal boxes every other pair comes first, so that all find a partner at once.
            comes_first = (places[before] // distance) & 1 == 0
            np.less(area, least[before], out=nearer)
            nearer &= comes_first
            take(before, behind, area, nearer)
            np.less(area, least[behind], out=nearer)
            take(behind, before, area, nearer)
            np.less(area, least[before], out=nearer)
            nearer &= ~comes_first
            take(before, behind, area, nearer)
    partners[begin:end] = nearest[begin - first : end - first]

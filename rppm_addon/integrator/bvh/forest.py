# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the hierarchies of many small meshes together, by the same clustering as one alone.

A mesh of a thousand triangles takes some thirty passes, in each of which a call of NumPy takes longer than its work.
"""

import concurrent.futures
import functools

import numpy as np

from ...processors import usable_cores
from .clustering import BLOCK, MAX_DEPTH, NODE, REACH_OF_FEW, cells_of_side, find_partners, interleaved, join

MOST_BOXES = 8192
"""Number of boxes of a tree from which on building it alone takes no longer."""


def build_forest(low: np.ndarray, high: np.ndarray, children: np.ndarray, counts: np.ndarray) -> list[np.ndarray]:
    """Nodes of each tree, NODE records, the root first, numbered within their tree.

    low, high: (3, n) float32, the boxes' corners, meters, those of a tree behind those of the tree before; children:
    (n,) uint32, what stands for each box in its node; counts: (trees,) int64, 2 to MOST_BOXES boxes of each tree.
    """
    if not len(counts):
        return []
    trees = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
    order = np.lexsort((_morton_codes(low, high, trees, counts), trees))
    low, high, children = np.take(low, order, axis=1), np.take(high, order, axis=1), children[order]
    lengths = counts - 1
    first_nodes = np.cumsum(lengths) - lengths
    nodes = NODE.zeros(int(lengths.sum()))
    ends, counts, passes = lengths.copy(), counts.copy(), 0
    """Nodes of each tree are numbered from the last to the first, the root."""
    with concurrent.futures.ThreadPoolExecutor(usable_cores(), "RPPM hierarchies") as workers:
        while len(children):
            # A pass deepens a tree by one at most.
            are_deep = passes + np.frexp(counts - 1)[1] >= MAX_DEPTH
            first, second = _pairs(low, high, trees, counts, are_deep, workers)
            passes += 1
            owners = trees[first]
            made = np.bincount(owners, minlength=len(counts))
            ends -= made
            numbers = ends[owners] + np.arange(len(first)) - (np.cumsum(made) - made)[owners]
            records = NODE.zeros(len(first))
            join(records, numbers, low, high, children, first, second)
            nodes[first_nodes[owners] + numbers] = records
            counts -= made
            stays = counts[trees] > 1
            stays[second] = False
            left = np.flatnonzero(stays)
            low, high = np.take(low, left, axis=1), np.take(high, left, axis=1)
            children, trees = children[left], trees[left]
    return np.split(nodes, first_nodes[1:])


def _morton_codes(low: np.ndarray, high: np.ndarray, trees: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """(n,) uint64: the places of the boxes' centers along a Morton curve through a cube around all of their tree."""
    centers, starts = low + high, np.cumsum(counts) - counts
    least = np.minimum.reduceat(centers, starts, axis=1)
    sides = (np.maximum.reduceat(centers, starts, axis=1) - least).max(axis=0)
    scales = np.array([cells_of_side(side) for side in sides.tolist()], np.float32)
    return interleaved(((centers - least[:, trees]) * scales[trees]).astype(np.uint64))


def _pairs(
    low: np.ndarray,
    high: np.ndarray,
    trees: np.ndarray,
    counts: np.ndarray,
    are_deep: np.ndarray,
    workers: concurrent.futures.Executor,
) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of clusters of a tree each of which shares the box of the least area with the other, or in ``are_deep``
    (trees,) those that follow each other: the numbers of the first and of the second ones. There is one at least in
    each tree that has clusters left."""
    numbers = np.arange(len(trees), dtype=np.int32)
    is_start = np.concatenate([[True], trees[1:] != trees[:-1]])
    starts = np.maximum.accumulate(np.where(is_start, numbers, 0))
    partners = np.empty(len(trees), np.int32)
    reach = min(REACH_OF_FEW, int(counts.max()) - 1)
    of_block = functools.partial(find_partners, low, high, reach, partners, trees=trees, starts=starts)
    list(workers.map(of_block, range(0, len(trees), BLOCK)))
    is_first = (partners[partners] == numbers) & (numbers < partners)
    # Areas beyond the range of floats are equal to none.
    in_line = (are_deep | (np.bincount(trees[is_first], minlength=len(counts)) == 0))[trees]
    places = numbers - starts
    is_first = np.where(in_line, (places & 1 == 0) & (places + 1 < counts[trees]), is_first)
    first = np.flatnonzero(is_first)
    return first, np.where(in_line[first], first + 1, partners[first])

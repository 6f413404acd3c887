# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies of many small meshes that are built together."""

import numpy as np
import pytest
from support.acceleration.hierarchies import HARD, assert_boxes_enclose, depth_of, leaves_of

from rppm_addon.integrator.bvh import bottom_levels
from rppm_addon.integrator.bvh.bottom_levels import BottomLevels
from rppm_addon.integrator.bvh.clustering import MAX_DEPTH, build_nodes
from rppm_addon.integrator.bvh.forest import build_forest
from rppm_addon.integrator.bvh.leaves import EMPTY_LEAF, LEAF, nodes_of_small_meshes, triangle_nodes
from rppm_addon.scene import Mesh

SIZES = np.array([2, 3, 17, 1000, 2, 2048])
"""Numbers of boxes up to which a tree alone has as many neighbors compared."""


def boxes_of(place: str, sizes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Low corners (3, boxes) float32, and the leaves (boxes,) uint32, numbered within each tree."""
    rng = np.random.default_rng(5)
    low = np.concatenate([HARD[place](rng, size) for size in sizes], axis=1).astype(np.float32)
    return low, np.uint32(LEAF) | np.concatenate([np.arange(size, dtype=np.uint32) for size in sizes])


def test_trees_are_those_that_are_built_alone():
    low, numbered = boxes_of("anywhere", SIZES)
    high = low + np.float32(0.01)
    ends = np.cumsum(SIZES)
    for tree, end, size in zip(build_forest(low, high, numbered, SIZES), ends, SIZES, strict=True):
        own = slice(end - size, end)
        alone = build_nodes(low[:, own], high[:, own], numbered[own].copy())
        np.testing.assert_array_equal(tree, alone)


@pytest.mark.parametrize("place", HARD)
def test_trees_hold_each_box_once_and_are_not_deep(place):
    sizes = np.array([2, 3, 3001, 130, 9])
    low, numbered = boxes_of(place, sizes)
    trees = build_forest(low, low + np.float32(0.01), numbered, sizes)
    for tree, size in zip(trees, sizes, strict=True):
        np.testing.assert_array_equal(leaves_of(tree), np.uint32(LEAF) | np.arange(size, dtype=np.uint32))
        assert_boxes_enclose(tree)
        assert depth_of(tree) <= MAX_DEPTH


def triangles(count: int) -> np.ndarray:
    """(count, 3, 3) float32: quadrilaterals of two triangles each here and there, and a single one."""
    rng = np.random.default_rng(count)
    square = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]])
    places = rng.normal(size=(count // 2 + 1, 1, 3)) * 20.0
    return np.concatenate([square + place for place in places])[:count].astype(np.float32)


def test_small_meshes_have_the_leaves_and_boxes_that_they_have_alone():
    """Odd numbers of triangles, one, none, and some that are not finite."""
    meshes = [triangles(count) for count in (5, 1, 0, 300, 2, 1, 7)]
    meshes[3][[4, 9]] = np.nan
    meshes[5][:] = np.inf
    margins = [0.1 * number for number in range(len(meshes))]
    for vertices, margin, nodes in zip(meshes, margins, nodes_of_small_meshes(meshes, margins), strict=True):
        np.testing.assert_array_equal(nodes, triangle_nodes(vertices, margin))
    assert leaves_of(nodes_of_small_meshes(meshes[2:3], [0.0])[0]).tolist() == [EMPTY_LEAF] * 2


def mesh(name: str, vertices: np.ndarray) -> Mesh:
    corners = np.arange(3 * len(vertices), dtype=np.int32)
    positions = vertices.reshape(-1, 3)
    slots = np.zeros(len(vertices), np.int32)
    return Mesh(name, positions, corners, np.zeros_like(positions), corners.reshape(-1, 3), slots)


def test_meshes_of_all_sizes_keep_their_places(monkeypatch):
    """In parts, the large ones alone."""
    monkeypatch.setattr(bottom_levels, "TRIANGLES_AT_ONCE", 10)
    monkeypatch.setattr(bottom_levels, "MOST_BOXES", 20)
    counts = 4, 30, 6, 8, 25, 3, 2
    levels = BottomLevels()
    assert levels.build([mesh(str(count), triangles(count)) for count in counts])
    ends = [*levels.roots[1:].tolist(), levels.node_count]
    for root, end, count in zip(levels.roots.tolist(), ends, counts, strict=True):
        nodes = levels.nodes()[root:end]
        inner = np.concatenate([nodes["child0"], nodes["child1"]])
        assert (inner[inner < LEAF] >= root).all() and (inner[inner < LEAF] < end).all()
        found = leaves_of(nodes)
        assert (found & 3).sum() == count

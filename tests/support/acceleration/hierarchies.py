# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes that are hard to put into a hierarchy, and what its nodes hold."""

import numpy as np

from rppm_addon.integrator.bvh.leaves import LEAF

HARD = {
    "all in one place": lambda rng, count: np.zeros((3, count)),
    "in a row": lambda rng, count: np.arange(count) * np.array([[1.0], [0.0], [0.0]]),
    "ever smaller": lambda rng, count: 2.0 ** -(np.arange(count) % 120) * np.ones((3, 1)),
    "anywhere": lambda rng, count: rng.normal(size=(3, count)),
    "far beyond squares of floats": lambda rng, count: rng.normal(size=(3, count)) * 1e30,
}
"""Low corners (3, count) by a random generator and how many there are."""


def depth_of(nodes: np.ndarray) -> int:
    """Nodes between the root and the deepest leaf; each node has a lower number than its children."""
    depths = np.ones(len(nodes), int)
    for number, node in enumerate(nodes):
        for child in (node["child0"], node["child1"]):
            if child < LEAF:
                assert child > number
                depths[child] = depths[number] + 1
    return int(depths.max())


def leaves_of(nodes: np.ndarray) -> np.ndarray:
    children = np.concatenate([nodes["child0"], nodes["child1"]])
    return np.sort(children[children >= LEAF])


def assert_boxes_enclose(nodes: np.ndarray) -> None:
    for side in "01":
        for box in nodes[nodes[f"child{side}"] < LEAF]:
            inner = nodes[box[f"child{side}"]]
            np.testing.assert_array_equal(box[f"low{side}"], np.minimum(inner["low0"], inner["low1"]))
            np.testing.assert_array_equal(box[f"high{side}"], np.maximum(inner["high0"], inner["high1"]))

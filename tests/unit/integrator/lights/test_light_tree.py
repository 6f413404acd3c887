# SPDX-License-Identifier: GPL-3.0-or-later
"""The light tree's nodes hold what is below them."""

import numpy as np
import pytest

from rppm_addon.integrator.lights.light_records import EMISSIVE_TRIANGLE, LIGHT_NODE
from rppm_addon.integrator.lights.light_tree import tree_of, triangle_leaves


def random_leaves(count: int, two_sided: bool) -> np.ndarray:
    generator = np.random.default_rng(count)
    corners = generator.uniform(-1, 1, (count, 1, 3)) + 0.1 * generator.normal(size=(count, 3, 3))
    emissive = EMISSIVE_TRIANGLE.zeros(count)
    emissive["radiance"], emissive["area"] = generator.random((count, 3)), generator.random(count)
    leaves = triangle_leaves(emissive, corners)
    leaves["two_sided"] = two_sided
    # Neighbors that face nearly alike, so that not all cones are whole spheres.
    leaves["axis"] = [0, 0, 1] + 0.4 * generator.normal(size=(count, 3))
    leaves["axis"] /= np.linalg.norm(leaves["axis"], axis=1, keepdims=True)
    if two_sided:
        leaves["axis"][::3] *= -1
    leaves["cosine_normals"] = generator.uniform(0.7, 1, count)
    leaves["cosine_emission"] = generator.uniform(0, 1, count)
    return leaves


@pytest.mark.parametrize("count", [1, 2, 3, 7, 100])
@pytest.mark.parametrize("two_sided", [False, True])
def test_nodes_hold_their_leaves(count, two_sided):
    leaves = random_leaves(count, two_sided)
    nodes = tree_of(leaves)
    places = len(nodes) // 2
    held = {place: [place] for place in range(places, 2 * places) if nodes["intensity"][place] > 0}
    assert sorted(nodes["member"][list(held)]) == list(range(count))
    for parent in range(places - 1, 0, -1):
        held[parent] = held.get(2 * parent, []) + held.get(2 * parent + 1, [])
        below, node = nodes[held[parent]], nodes[parent]
        if not len(below):
            assert node["intensity"] == 0
            continue
        assert node["intensity"] == pytest.approx(below["intensity"].sum(), rel=1e-5)
        assert (node["low"] <= below["low"].min(axis=0)).all() and (node["high"] >= below["high"].max(axis=0)).all()
        assert node["cosine_emission"] == below["cosine_emission"].min()
        cosine = below["axis"].astype(float) @ node["axis"]
        if two_sided:
            cosine = np.abs(cosine)
        reach = np.arccos(np.clip(cosine, -1, 1)) + np.arccos(below["cosine_normals"].astype(float))
        assert (reach <= np.arccos(np.clip(float(node["cosine_normals"]), -1, 1)) + 1e-3).all()
    tight = nodes["cosine_normals"][1 : max(places, 2)] > -1
    assert tight.any()


@pytest.mark.parametrize("count", [1, 5, 8, 100])
def test_leaves_are_in_order_and_nothing_else_is_there(count):
    """From left to right as from one end to the other, on two levels at most."""
    leaves = random_leaves(count, True)
    leaves["low"] = leaves["high"] = np.linspace(0, 1, count)[:, None]
    nodes = tree_of(leaves[np.random.default_rng(1).permutation(count)])
    assert len(nodes) == 2 * count and (nodes["intensity"][1:] > 0).all()
    levels = [place.bit_length() for place in range(count, 2 * count)]
    depth = max(levels)
    assert min(levels) >= depth - 1
    from_left = sorted(range(count, 2 * count), key=lambda place: place << (depth - place.bit_length()))
    assert (np.diff(nodes["low"][from_left], axis=0) >= 0).all()


def test_no_leaves_are_no_tree():
    assert len(tree_of(LIGHT_NODE.zeros(0))) == 0

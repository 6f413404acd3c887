# SPDX-License-Identifier: GPL-3.0-or-later
"""Pointiness of vertices."""

import itertools

import numpy as np
import pytest

from rppm_addon.blender.export.geometry.meshes.pointiness import pointiness


@pytest.mark.parametrize("split", [False, True], ids=["joined", "split"])
def test_a_cube(split):
    """The mean of three edges and the normal make the same angle at all corners, whether or not faces share them."""
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3)), np.float32)
    pairs = itertools.combinations(range(8), 2)
    edges = np.array([pair for pair in pairs if np.abs(corners[pair[0]] - corners[pair[1]]).sum() == 2.0])
    places, normals = corners, corners / np.sqrt(np.float32(3.0))
    if split:  # each edge with ends of its own
        places, edges = corners[edges.ravel()], np.arange(24).reshape(12, 2)
        normals = places / np.sqrt(np.float32(3.0))
    found = pointiness(places, normals, edges)
    np.testing.assert_allclose(found, np.arccos(-1.0 / np.sqrt(3.0)) / np.pi, rtol=1e-6)


def test_flat_ground_is_half_and_a_dent_less():
    y, x = np.mgrid[-2.0:3.0, -2.0:3.0]
    places = np.stack([x, y, 0.0 * x], axis=-1).reshape(-1, 3).astype(np.float32)
    numbers = np.arange(25).reshape(5, 5)
    edges = np.concatenate([np.stack([a.ravel(), b.ravel()], axis=1) for a, b in (
        (numbers[:, 1:], numbers[:, :-1]), (numbers[1:], numbers[:-1]))])  # fmt: skip
    up = np.tile(np.float32([0.0, 0.0, 1.0]), (25, 1))
    np.testing.assert_allclose(pointiness(places, up, edges), 0.5, atol=1e-6)
    places[12, 2] = -1.0
    dented = pointiness(places, up, edges)[:, 0]
    at_center, beside = np.arccos(np.sqrt(0.5)) / np.pi, np.arccos(-np.sqrt(0.5) / 4) / np.pi
    assert dented[12] == pytest.approx((at_center + 4 * beside) / 5, rel=1e-6)


def test_a_vertex_without_edges_has_none():
    assert pointiness(np.zeros((1, 3), np.float32), np.zeros((1, 3), np.float32), np.zeros((0, 2), int))[0, 0] == 0.0
    assert pointiness(*(np.zeros((0, 3), np.float32),) * 2, np.zeros((0, 2), int)).shape == (0, 1)

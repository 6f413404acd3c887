# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes and matrices of many instances at once, beside each by itself."""

import itertools

import numpy as np

from rppm_addon.integrator.common.affine import affine_inverses
from rppm_addon.integrator.surfaces.placements import placed_boxes


def affine(count: int) -> np.ndarray:
    matrices = np.tile(np.eye(4), (count, 1, 1))
    matrices[:, :3] = np.random.default_rng(5).normal(size=(count, 3, 4))
    return matrices


def test_boxes_enclose_the_placed_corners():
    matrices = affine(50)
    boxes = np.sort(np.random.default_rng(6).normal(size=(50, 2, 3)), axis=1)
    lows, highs, good = placed_boxes(matrices, boxes)
    assert good.all()
    for matrix, box, low, high in zip(matrices, boxes, lows, highs, strict=True):
        corners = np.array([matrix[:3, :3] @ corner + matrix[:3, 3] for corner in itertools.product(*box.T)])
        np.testing.assert_allclose([low, high], [corners.min(axis=0), corners.max(axis=0)], atol=1e-12)


def test_boxes_that_cannot_be_rendered_are_found():
    matrices = affine(4)
    matrices[0, 1, 2], matrices[1, 0, 3], matrices[2, 2, 1] = np.nan, np.inf, 1e30
    _, _, good = placed_boxes(matrices, np.tile([[-1.0] * 3, [1.0] * 3], (4, 1, 1)))
    assert good.tolist() == [False, False, False, True]


def test_inverses_are_numpys_and_zero_without_extent():
    matrices = affine(50)
    matrices[7, :3, 1] = 0.0
    inverses = affine_inverses(matrices)
    assert not inverses[7].any()
    whole = np.delete(np.arange(50), 7)
    np.testing.assert_allclose(inverses[whole], np.linalg.inv(matrices[whole])[:, :3], rtol=1e-9, atol=1e-9)

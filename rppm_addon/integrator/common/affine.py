# SPDX-License-Identifier: GPL-3.0-or-later
"""Affine matrices of many instances at once. All is written out: thousands of small matrices take NumPy long."""

import numpy as np


def determinants(matrices: np.ndarray) -> np.ndarray:
    """(n,) determinants of affine matrices (n, 4, 4): negative where one mirrors, so that triangles that it places are
    turned round (shaders/surfaces/geometry/gather_triangle.glsl)."""
    x, y, z = (matrices[:, :3, column] for column in range(3))
    return np.asarray((x * np.cross(y, z)).sum(axis=1))


def affine_inverses(matrices: np.ndarray) -> np.ndarray:
    """(n, 3, 4) upper rows, of affine (n, 4, 4); all 0 where there is no inverse, as for an instance without extent."""
    x, y, z, origin = (matrices[:, :3, column] for column in range(4))
    linear = np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=1)
    determinant = (x * linear[:, 0]).sum(axis=1)
    linear *= np.divide(1.0, determinant, out=np.zeros_like(determinant), where=determinant != 0.0)[:, None, None]
    return np.concatenate([linear, -np.einsum("nij,nj->ni", linear, origin)[:, :, None]], axis=2)

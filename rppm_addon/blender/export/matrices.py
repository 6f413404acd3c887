# SPDX-License-Identifier: GPL-3.0-or-later
"""Matrices of objects, made usable."""

import numpy as np

FLATTEST = 1e-6
"""Least ratio of the smallest scale of a placement to its largest."""
_LEAST_ANGLE = 1e-6
"""Radians between axes that give a direction each."""
_SKEW = 1e-3
"""Cosine between axes from which on pictures show that they are not at right angles: a pixel of a thousand."""


def usable_matrices(matrices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Make placements invertible where that leaves a picture that makes sense.

    matrices: (n, 4, 4) float64, object to world. Returns the matrices, where a placement flattened
    along one axis has a scale of FLATTEST there, and (n,) bool, false where a matrix is not finite
    or leaves less than a surface (two axes without scale).
    """
    finite = np.isfinite(matrices).all(axis=(1, 2))
    result = np.where(finite[:, None, None], matrices, np.eye(4))
    result[:, 3] = (0.0, 0.0, 0.0, 1.0)
    linear = result[:, :3, :3]
    size = np.abs(linear).max(axis=(1, 2))
    usable = finite & (size > 0.0)
    normalized = linear / np.where(size > 0.0, size, 1.0)[:, None, None]
    # A cheap test first: nearly all placements are far from singular.
    doubtful = np.flatnonzero(usable & (np.abs(np.linalg.det(normalized)) < 1e-4))
    for index in doubtful:
        left, scales, right = np.linalg.svd(normalized[index])
        least = scales[0] * FLATTEST
        if scales[1] < least:
            usable[index] = False
        elif scales[2] < least:
            scales[2] = least
            result[index, :3, :3] = (left * scales) @ right * size[index]
    return result, usable


def rigid(matrix: np.ndarray) -> tuple[np.ndarray, bool]:
    """The matrix (4, 4) without scale, shear and mirroring, keeping -Z and then Y.

    Returns the rigid motion, and whether the matrix was mirrored. Raises ValueError when the matrix is not finite or
    leaves no direction of an axis, as with a scale of 0.
    """
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    if not np.isfinite(matrix).all() or lengths.min() == 0.0:
        raise ValueError("the matrix has an axis without direction")
    axes = matrix[:3, :3] / lengths
    backward = axes[:, 2]
    up = axes[:, 1] - backward * (axes[:, 1] @ backward)
    if np.linalg.norm(up) < _LEAST_ANGLE:
        raise ValueError("the matrix has two axes along one direction")
    up /= np.linalg.norm(up)
    result = np.eye(4)
    result[:3, 0], result[:3, 1], result[:3, 2] = np.cross(up, backward), up, backward
    result[:3, 3] = matrix[:3, 3]
    return result, bool(np.linalg.det(axes) < 0.0)


def is_sheared(matrix: np.ndarray) -> bool:
    """Whether the axes of a regular matrix (4, 4) are so far from right angles that pictures show it."""
    axes = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
    return bool(np.abs(axes.T @ axes - np.eye(3)).max() > _SKEW)

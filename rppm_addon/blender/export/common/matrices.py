# SPDX-License-Identifier: GPL-3.0-or-later
"""Matrices of objects, made usable."""

import numpy as np

from ....scene.camera import SHEARED

FLATTEST = 1e-6
"""Least ratio of the smallest scale of a placement to its largest."""
_DOUBTFUL = 1e-4
"""Volume of axes, the largest component of which is 1, from which on they are far from singular."""


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
    doubtful = np.flatnonzero(usable & (np.abs(np.linalg.det(normalized)) < _DOUBTFUL))
    for index in doubtful:
        left, scales, right = np.linalg.svd(normalized[index])
        least = scales[0] * FLATTEST
        if scales[1] < least:
            usable[index] = False
        elif scales[2] < least:
            scales[2] = least
            result[index, :3, :3] = (left * scales) @ right * size[index]
    return result, usable


def are_plain(matrices: np.ndarray) -> np.ndarray:
    """(n,) bool, True where a placement of many, (n, 4, 4) float32, is far from singular.

    Such placements usable_matrices leaves as they are; this takes a fraction of its time.
    """
    with np.errstate(all="ignore"):  # what is no number fails all comparisons
        a, b, c = (matrices[:, row, :3].T for row in range(3))
        volume = a[0] * (b[1] * c[2] - b[2] * c[1])
        volume += a[1] * (b[2] * c[0] - b[0] * c[2])
        volume += a[2] * (b[0] * c[1] - b[1] * c[0])
        size = np.abs(matrices[:, :3, :3]).max(axis=(1, 2))
        good = np.abs(volume) > 2.0 * _DOUBTFUL * size * size * size
        good &= np.isfinite(matrices[:, :3, 3].sum(axis=1))
    return good & (matrices[:, 3] == (0.0, 0.0, 0.0, 1.0)).all(axis=1)


def unscaled(matrix: np.ndarray) -> np.ndarray:
    """The matrix (4, 4) of a camera with axes of length 1, as Cycles has it; mirrored and sheared as it was.

    What is hardly sheared gets right angles, keeping -Z and then Y. Raises ValueError when the matrix is not finite,
    has an axis of length 0, or axes in one plane, however long they are.
    """
    linear = matrix[:3, :3]
    lengths = np.linalg.norm(linear, axis=0)
    if not np.isfinite(matrix).all() or lengths.min() == 0.0 or abs(np.linalg.det(linear / lengths)) <= 1e-12:
        raise ValueError("the matrix is singular")
    axes = linear / lengths
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = axes, matrix[:3, 3]
    if np.abs(axes.T @ axes - np.eye(3)).max() > SHEARED:
        return result
    backward = axes[:, 2]
    up = axes[:, 1] - backward * (axes[:, 1] @ backward)
    up /= np.linalg.norm(up)
    result[:3, 0], result[:3, 1] = np.cross(up, backward) * np.sign(np.linalg.det(axes)), up
    return result

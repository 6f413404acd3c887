# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors of length 1."""

import numpy as np


def unit_vectors(vectors: np.ndarray) -> np.ndarray:
    """The directions of vectors (..., n), of their type; 0 where there is none."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 1e-30)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Packed normals, unpacked with NumPy."""

import numpy as np


def unpack(bits: np.ndarray) -> np.ndarray:
    """Octahedral unit vectors of packed normals, (..., 3)."""
    x = np.clip((bits & 0xFFFF).astype(np.uint16).view(np.int16) / 32767, -1, 1)
    y = np.clip((bits >> 16).astype(np.uint16).view(np.int16) / 32767, -1, 1)
    z = 1 - abs(x) - abs(y)
    fx, fy = (
        np.where(z < 0, (1 - abs(y)) * np.where(x >= 0, 1, -1), x),
        np.where(z < 0, (1 - abs(x)) * np.where(y >= 0, 1, -1), y),
    )
    v = np.stack([fx, fy, z], -1)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)

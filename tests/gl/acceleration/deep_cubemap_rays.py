# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays that are hard for a cubemap: (origins, directions), (n, 3) float32 each, directions of length 1."""

import numpy as np

KINDS = (
    "uniform", "toward the center", "past the center", "from the center", "from near the center", "along axes",
    "in cell borders", "at edges and vertices",
)  # fmt: skip


def _near(center: np.ndarray, rng: np.random.Generator, count: int) -> np.ndarray:
    """Points at distances of all orders of magnitude from 1e-8 to 1e-2."""
    return center + rng.normal(size=(count, 3)) * 10.0 ** rng.uniform(-8, -2, (count, 1))


def make_rays(kind: str, count: int, center, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    center = np.asarray(center, float)
    index = np.arange(count)
    origins = rng.uniform(-0.98, 0.98, (count, 3))
    directions = rng.normal(size=(count, 3))
    if kind == "toward the center":
        directions = center - origins
    elif kind == "past the center":
        directions = _near(center, rng, count) - origins
    elif kind == "from the center":
        origins = np.tile(center, (count, 1))
    elif kind == "from near the center":
        origins = _near(center, rng, count)
    elif kind == "along axes":
        directions = np.zeros((count, 3))
        directions[index, rng.integers(0, 3, count)] = rng.choice([-1.0, 1.0], count)
    elif kind == "in cell borders":
        # in planes through the center that separate faces (ratio 1) or cells
        axis = rng.integers(0, 3, count)
        other = (axis + 1) % 3
        ratio = rng.choice([-1.0, 1.0], count) * rng.choice([1.0, 0.0, 0.5, -0.25], count)
        offset = rng.uniform(-0.5, 0.5, (count, 3))
        offset[index, other] = ratio * offset[index, axis]
        origins = center + offset
        directions[index, other] = ratio * directions[index, axis]
    elif kind == "at edges and vertices":
        # the coordinates of the room's, the pillar's and the table's corners
        targets = rng.choice([-1.0, 1.0, -0.9, 0.1, 0.5, -0.6, -0.2, 0.2, 0.3, -0.25, 0.8, -0.3, 0.0, -0.5], (count, 3))
        axis = rng.integers(0, 3, count)
        on_edge = rng.random(count) < 0.5
        targets[index[on_edge], axis[on_edge]] = rng.uniform(-1, 1, on_edge.sum())
        directions = targets - origins
    elif kind != "uniform":
        raise ValueError(kind)
    directions /= np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-30)
    return origins.astype(np.float32), directions.astype(np.float32)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Bvh: a bounding volume hierarchy, built by the processor, traced through by the device.

A software driver traces rays through it in two thirds to a fifth of the time that a deep cubemap takes
(docs/benchmarks/moves.md): a step tests two boxes, which takes few operations.
"""

from collections.abc import Iterable

import moderngl
import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.storage_blocks import StorageBlock
from ..acceleration.acceleration_structure import MARGIN, AccelerationStructure
from .clustering import MAX_DEPTH, NODE, build_nodes

LEAF = 0x80000000
Constants("BvhNodes", LEAF=LEAF, MAX_DEPTH=MAX_DEPTH)
StorageBlock("BvhNodes", "BvhNode bvh_nodes[];")

_EMPTY_LEAF = np.uint32(LEAF)
_TRIANGLE_BYTES = 48


class Bvh(AccelerationStructure):
    """A binary hierarchy of boxes on the device. Its leaves hold one triangle, or two that follow each other."""

    shader = "bvh/traverse.glsl"
    remedy = "simplify the geometry"
    _nodes = StorageBuffer("BVH nodes", NODE, texel_bytes=16, block="BvhNodes")

    def build(
        self,
        triangles: moderngl.Buffer,
        triangle_count: int,
        center: Iterable[float],
        scene_radius: float,
        resolution: int = 0,
        has_one_sided: bool = False,
    ) -> None:
        """AccelerationStructure.build."""
        self._has_one_sided = has_one_sided
        read = triangles.read(_TRIANGLE_BYTES * triangle_count) if triangle_count else b""
        vertices = np.frombuffer(read, np.float32).reshape(-1, 3, 4)[..., :3]
        nodes = bvh_nodes(vertices, max(float(scene_radius), 1e-20) * MARGIN)
        self._nodes.require_items(len(nodes))
        self._nodes.write(nodes)
        self._traversal_buffers = {"Triangles": triangles, **self.blocks}


def bvh_nodes(vertices: np.ndarray, margin: float) -> np.ndarray:
    """NODE records of a hierarchy of triangles, the root first; vertices: (n, 3, 3) float32, meters.

    margin: how far boxes are widened, meters. Triangles with infinite or NaN coordinates are left out.
    """
    low, high, leaves = _leaves(vertices)
    low -= np.float32(margin)
    high += np.float32(margin)
    if len(leaves) > 1:
        return build_nodes(low, high, leaves)
    root = NODE.zeros(1)
    root["child0"] = root["child1"] = _EMPTY_LEAF
    if len(leaves):
        root["low0"], root["high0"], root["child0"] = low[:, 0], high[:, 0], leaves
    return root


def _leaves(vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes of leaves, their corners (3, n) float32 in meters, and the leaves, (n,) uint32.

    Two triangles that follow each other share a leaf where their common box has no more area than their own boxes
    together, as the two of a quadrilateral do.
    """
    count = len(vertices)
    low = np.minimum(np.minimum(vertices[:, 0], vertices[:, 1]), vertices[:, 2]).T.copy()
    high = np.maximum(np.maximum(vertices[:, 0], vertices[:, 1]), vertices[:, 2]).T.copy()
    is_finite = np.isfinite(low).all(axis=0) & np.isfinite(high).all(axis=0)
    even, odd = slice(0, count - count % 2, 2), slice(1, None, 2)
    common_low, common_high = np.minimum(low[:, even], low[:, odd]), np.maximum(high[:, even], high[:, odd])
    with np.errstate(over="ignore", invalid="ignore"):
        areas = _half_areas(low, high)
        are_paired = is_finite[even] & is_finite[odd]
        are_paired &= _half_areas(common_low, common_high) <= areas[even] + areas[odd]
    low[:, even], high[:, even] = (
        np.where(are_paired, common_low, low[:, even]),
        np.where(are_paired, common_high, high[:, even]),
    )
    sizes = np.ones(count, np.uint32)
    sizes[even][are_paired] = 2
    is_leaf = is_finite
    is_leaf[odd] &= ~are_paired
    first = np.flatnonzero(is_leaf)
    leaves = np.uint32(LEAF) | first.astype(np.uint32) << np.uint32(2) | sizes[first]
    return np.take(low, first, axis=1), np.take(high, first, axis=1), leaves


def _half_areas(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Half of the area of boxes, (n,) square meters."""
    x, y, z = high - low
    return x * (y + z) + y * z

# SPDX-License-Identifier: GPL-3.0-or-later
"""A tree of the lights, down which shadow rays choose theirs by what it may give at a point
(shaders/lights/light_tree.glsl).

After Conty Estevez and Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting (HPG 2018). The tree is a
complete binary one over the lights in Morton order: children of node i are 2 i and 2 i + 1, and its n leaves are the
nodes from n on. So any number of lights that move is built anew in a few array operations.
"""

import math
from collections.abc import Sequence

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from .light_records import LIGHT_NODE, LightShape

_MORTON_BITS = 10
_SLACK = 1e-5
"""Boxes are wider by so much of their largest coordinate: rays along a flat light must find it."""


class LightTree(BufferSet):
    """Nodes of two trees, of light objects and of emissive triangles, of the suns, and of the trees of meshes whose
    instances are leaves of the second tree (emitters/instances.py), in one buffer.

    Each tree's root is node 1 behind its first; ``parameters`` are the values of LIGHT_TREE_PARAMETERS.
    """

    remedy = "let fewer triangles emit light: lower the children of particles or the subdivision of what does"
    nodes = StorageBuffer("light tree", LIGHT_NODE, texel_bytes=16, block="LightNodes")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self.parameters: dict[str, int] = {}

    def build(
        self,
        lights: np.ndarray,
        triangles: np.ndarray,
        order: np.ndarray,
        light_sets: np.ndarray,
        mesh_trees: Sequence[np.ndarray] = (),
    ) -> int:
        """Take the lights (LIGHT records), the leaves of the emissive triangles and instances (with their light sets)
        and their order (morton_order), by the numbers of links the bits of the light sets, (n, 2), and the trees of
        the instances' meshes. Returns the node with which the first of these begins."""
        near, suns = light_leaves(lights), sun_leaves(lights)
        for leaves in (near, suns):
            leaves["light_sets"] = light_sets[lights["link"][leaves["member"]]]
        parts = [tree_of(near), tree_of(triangles, order), suns, *mesh_trees]
        firsts = np.cumsum([0] + [len(part) for part in parts])
        self.parameters = {
            "light_tree_leaves": len(parts[0]) // 2,
            "triangle_tree": int(firsts[1]),
            "triangle_tree_leaves": len(parts[1]) // 2,
            "first_sun": int(firsts[2]),
            "sun_count": len(suns),
        }
        if not firsts[-1]:
            self.nodes.upload(LIGHT_NODE.zeros(1))
        self.nodes.require_items(int(firsts[-1]))
        for first, part in zip(firsts.tolist(), parts):  # of millions of triangles, no copy of all together
            self.nodes.write(part, LIGHT_NODE.size * first)
        return int(firsts[3])

    def refuse(self, lights: int, triangles: int) -> None:
        """Raise DeviceError where the device has no room for so many emissive triangles beside so many lights."""
        self.nodes.refuse_items(2 * (lights + triangles) + lights)


LIGHT_TREE_PARAMETERS = {
    "light_tree_leaves": "uint",
    "triangle_tree": "uint",
    "triangle_tree_leaves": "uint",
    "first_sun": "uint",
    "sun_count": "uint",
}


def light_leaves(lights: np.ndarray) -> np.ndarray:
    """Leaves of the light objects that are somewhere: what they give at most in W/sr, by where and which way."""
    elsewhere = LightShape.SUN, LightShape.MESH, LightShape.WORLD, LightShape.MEDIUM
    members = np.nonzero(~np.isin(lights["kind"], elsewhere))[0]
    lights = lights[members]
    leaves = LIGHT_NODE.zeros(len(lights))
    leaves["member"] = members
    leaves["axis"] = lights["normal"]
    point, spot = lights["kind"] == LightShape.POINT, lights["kind"] == LightShape.SPOT
    area = ~(point | spot)
    reach = np.where(area[:, None], np.abs(lights["axis_u"]) + np.abs(lights["axis_v"]), lights["radius"][:, None])
    leaves["low"], leaves["high"] = widened(lights["position"] - reach, lights["position"] + reach)
    spread = area & (lights["spread_tangent"] > 0)
    straight_on = np.where(spread, lights["spread_tangent"] * lights["spread_scale"], 1.0)
    leaves["intensity"] = np.abs(lights["strength"]).mean(axis=1) * np.where(area, lights["area"] * straight_on, 1.0)
    # Of a spot, spread_scale is one minus the cosine of the round cone that holds its beam.
    leaves["cosine_normals"] = np.select([point, spot], [-1.0, 1.0 - lights["spread_scale"]], 1.0)
    leaves["cosine_emission"] = np.select([spot, spread], [1.0, lights["cosine_cone"]], 0.0)
    return leaves


def sun_leaves(lights: np.ndarray) -> np.ndarray:
    """The suns: irradiance W/m^2 as intensity, and the cosine of the disk's radius as that of the normals."""
    members = np.nonzero(lights["kind"] == LightShape.SUN)[0]
    leaves = LIGHT_NODE.zeros(len(members))
    leaves["member"] = members
    leaves["axis"] = lights["normal"][members]
    leaves["intensity"] = np.abs(lights["strength"][members]).mean(axis=1)
    leaves["cosine_normals"] = lights["cosine_cone"][members]
    return leaves


def triangle_leaves(emissive: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Leaves of emissive triangles (EMISSIVE_TRIANGLE records) with corners (n, 3, 3) in meters, which shine on both
    sides."""
    leaves = LIGHT_NODE.zeros(len(emissive))
    leaves["member"] = np.arange(len(emissive))
    leaves["low"], leaves["high"] = widened(corners.min(axis=1), corners.max(axis=1))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    leaves["axis"] = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    leaves["intensity"] = np.abs(emissive["radiance"]).mean(axis=1) * emissive["area"]
    leaves["cosine_normals"] = 1.0
    leaves["two_sided"] = 1
    return leaves


def leaf_numbers(order: np.ndarray) -> np.ndarray:
    """(n,) uint32: the nodes of a tree (tree_of) that the leaves become; order: theirs along the curve."""
    count = len(order)
    numbers = np.zeros(count, np.uint32)
    if count:
        level = 1 << ((2 * count - 1).bit_length() - 1)
        numbers[order] = np.concatenate([np.arange(level, 2 * count), np.arange(count, level)])
    return numbers


def tree_of(leaves: np.ndarray, order: np.ndarray | None = None) -> np.ndarray:
    """(2 n,) LIGHT_NODE records of a complete tree over n leaves; node 0 is none. order: morton_order of the
    leaves, where it is known."""
    count = len(leaves)
    nodes = LIGHT_NODE.zeros(2 * count)
    if not count:
        return nodes
    level = 1 << ((2 * count - 1).bit_length() - 1)  # the first node of the lowest
    ordered = leaves[morton_order(leaves) if order is None else order]
    nodes[level:], nodes[count:level] = np.split(ordered, [2 * count - level])  # from left to right
    while level > 1:
        level //= 2
        end = min(2 * level, count)
        children = nodes[2 * level : 2 * end]
        nodes[level:end] = _merged(children[0::2], children[1::2])
    return nodes


def widened(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Low and high corners (n, 3) of boxes that are wider by what rounding may move."""
    slack = _SLACK * np.maximum(np.abs(low), np.abs(high)).max(axis=1, keepdims=True, initial=0.0) + 1e-9
    return low - slack, high + slack


def morton_order(leaves: np.ndarray) -> np.ndarray:
    """(n,) the numbers of leaves (LIGHT_NODE records) in their order along a Morton curve."""
    if not len(leaves):
        return np.zeros(0, np.int64)
    centers = 0.5 * (leaves["low"].astype(np.float64) + leaves["high"])
    low = centers.min(axis=0)
    extent = max((centers.max(axis=0) - low).max(), 1e-30)
    cells = ((centers - low) / extent * ((1 << _MORTON_BITS) - 1)).astype(np.int64)
    codes = np.zeros(len(leaves), np.int64)
    for bit in range(_MORTON_BITS):
        for axis in range(3):
            codes |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(codes, kind="stable")


def _merged(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Parents of pairs of nodes: their box, their sum, and the cone that holds both cones of normals."""
    parents = first.copy()
    both = (first["intensity"] > 0) & (second["intensity"] > 0)
    only_second = (first["intensity"] <= 0) & (second["intensity"] > 0)
    parents[only_second] = second[only_second]
    a, b = first[both], second[both]
    merged = a.copy()
    merged["intensity"] = a["intensity"] + b["intensity"]
    merged["low"] = np.minimum(a["low"], b["low"])
    merged["high"] = np.maximum(a["high"], b["high"])
    merged["cosine_emission"] = np.minimum(a["cosine_emission"], b["cosine_emission"])
    merged["two_sided"] = a["two_sided"] | b["two_sided"]
    merged["light_sets"] = a["light_sets"] | b["light_sets"]
    merged["axis"], merged["cosine_normals"] = _cone_union(a, b)
    parents[both] = merged
    return parents


def _cone_union(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Axes (n, 3) and cosines (n,) of the smallest cones about the cones of both; what shines on both sides may be
    taken by its other side."""
    axis_a, axis_b = a["axis"].astype(np.float64), b["axis"].astype(np.float64)
    flipped = ((a["two_sided"] & b["two_sided"]) != 0) & ((axis_a * axis_b).sum(axis=1) < 0)
    axis_b = np.where(flipped[:, None], -axis_b, axis_b)
    angle_a, angle_b = (np.arccos(np.clip(nodes["cosine_normals"].astype(np.float64), -1, 1)) for nodes in (a, b))
    wider_b = angle_b > angle_a
    axis_a, axis_b = np.where(wider_b[:, None], axis_b, axis_a), np.where(wider_b[:, None], axis_a, axis_b)
    angle_a, angle_b = np.maximum(angle_a, angle_b), np.minimum(angle_a, angle_b)
    between = np.arccos(np.clip((axis_a * axis_b).sum(axis=1), -1, 1))
    angle = 0.5 * (angle_a + between + angle_b)
    inside = np.minimum(between + angle_b, math.pi) <= angle_a
    across = axis_b - (axis_a * axis_b).sum(axis=1, keepdims=True) * axis_a
    length = np.linalg.norm(across, axis=1, keepdims=True)
    turn = (angle - angle_a)[:, None]
    turned = np.cos(turn) * axis_a + np.sin(turn) * across / np.maximum(length, 1e-30)
    everywhere = ~inside & ((angle >= math.pi) | (length[:, 0] < 1e-6) & (between > 1e-3))
    axis = np.where((inside | everywhere)[:, None], axis_a, turned)
    angle = np.where(everywhere, math.pi, np.where(inside, angle_a, angle))
    return axis / np.linalg.norm(axis, axis=1, keepdims=True), np.cos(angle)

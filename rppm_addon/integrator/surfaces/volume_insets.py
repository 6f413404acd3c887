# SPDX-License-Identifier: GPL-3.0-or-later
"""Insets of the surfaces of volumes, which keep faces of objects that touch apart.

A ray that leaves a surface begins a little off its plane, beyond another surface in the same plane. So where two
volumes touch, or one stands on a floor, a path would cross one surface of two, and be in media that have ended, or in
none. Surfaces that only bound a volume show nothing themselves. They are drawn together by a few times as much as rays
begin off a plane, and lie behind one another then.
"""

from collections.abc import Sequence

import numpy as np

from ...scene.materials import Material

_INSET = 2.0**-17
"""Distance by which a face moves, over its object's extent and the distance from the origin: 16 to 28 times what rays
begin off it (ray_offset in shaders/common/geometry.glsl)."""
_STEPS = 4
"""Insets that differ. Volumes that are in the same place take those of their numbers."""
_MOST = 1e-2
"""Fraction of an extent that an inset takes at most on both sides together."""


def volumes_alone(lists: Sequence[Sequence[int]], materials: Sequence[Material]) -> list[int]:
    """Numbers of the lists of materials of slots whose surfaces all show nothing, and bound a volume."""
    boundaries = {number for number, material in enumerate(materials) if _is_boundary(material)}
    known = range(len(materials))
    return [number for number, slots in enumerate(lists) if _bounds_alone(slots, boundaries, known)]


def _bounds_alone(slots: Sequence[int], boundaries: set[int], known: range) -> bool:
    numbers = [number for number in slots if number in known]
    return bool(numbers) and boundaries.issuperset(numbers)


def _is_boundary(material: Material) -> bool:
    graph = material.graph
    if material.interior is None or graph.surface is None or not 0 <= graph.surface.node < len(graph.nodes):
        return False
    return graph.nodes[graph.surface.node].kind in ("volume_boundary", "bsdf_transparent")


def inset_matrix(matrix: np.ndarray, box: np.ndarray, number: int) -> np.ndarray:
    """The (4, 4) matrix of an instance whose mesh lies in a box, (2, 3) low and high, drawn together about the middle
    of the box along each of its axes; number: of the instance."""
    low, high = box
    widths = np.linalg.norm(matrix[:3, :3], axis=0) * (high - low)
    corners = np.array([[box[bit >> axis & 1][axis] for axis in range(3)] for bit in range(8)])
    reach = float(np.abs(corners @ matrix[:3, :3].T + matrix[:3, 3]).max())
    inset = _INSET * (1.0 + 0.75 * (number % _STEPS) / _STEPS)
    with np.errstate(divide="ignore", invalid="ignore"):
        narrower = np.where(widths > 0.0, 2.0 * inset * (widths.max() + reach) / widths, 0.0)
    scale = np.diag([*(1.0 - np.clip(np.nan_to_num(narrower), 0.0, _MOST)), 1.0])
    middle = 0.5 * (low + high)
    scale[:3, 3] = middle - scale[:3, :3] @ middle
    return matrix @ scale

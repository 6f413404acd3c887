# SPDX-License-Identifier: GPL-3.0-or-later
"""A bounding volume hierarchy by the surface area heuristic, walked on the device by the same intersection
routine as the deep cubemap: what its speed is measured against."""

import moderngl
import numba
import numpy as np

from rppm_addon.gl.buffers.records import Record

Record("BoundingVolumesRange", first_ray="uint", end_ray="uint")

_BINS = 16
_LEAF = 4


@numba.njit(cache=True)
def _area(low, high):
    x, y, z = high[0] - low[0], high[1] - low[1], high[2] - low[2]
    return x * y + y * z + z * x


@numba.njit(cache=True)
def _split(lows, highs, centers, order, begin, end):
    """Axis, place and scale of the cheapest of 16 planes an axis (Wald 2007); axis -1 where there is none."""
    best, best_axis, best_plane = np.inf, -1, 0
    least, greatest = np.full(3, np.inf), np.full(3, -np.inf)
    for i in range(begin, end):
        for k in range(3):
            least[k], greatest[k] = min(least[k], centers[order[i], k]), max(greatest[k], centers[order[i], k])
    for axis in range(3):
        width = greatest[axis] - least[axis]
        if width <= 0.0:
            continue
        counts = np.zeros(_BINS, np.int64)
        low, high = np.full((_BINS, 3), np.inf), np.full((_BINS, 3), -np.inf)
        for i in range(begin, end):
            triangle = order[i]
            place = min(_BINS - 1, int((centers[triangle, axis] - least[axis]) / width * _BINS))
            counts[place] += 1
            for k in range(3):
                low[place, k] = min(low[place, k], lows[triangle, k])
                high[place, k] = max(high[place, k], highs[triangle, k])
        above = np.zeros(_BINS)
        a, b, number = np.full(3, np.inf), np.full(3, -np.inf), 0
        for place in range(_BINS - 1, 0, -1):
            a, b, number = np.minimum(a, low[place]), np.maximum(b, high[place]), number + counts[place]
            above[place] = _area(a, b) * number if number else 0.0
        a, b, number = np.full(3, np.inf), np.full(3, -np.inf), 0
        for place in range(_BINS - 1):
            a, b, number = np.minimum(a, low[place]), np.maximum(b, high[place]), number + counts[place]
            if number == 0 or number == end - begin:
                continue
            cost = _area(a, b) * number + above[place + 1]
            if cost < best:
                best, best_axis, best_plane = cost, axis, place
    return best_axis, best_plane, least, greatest


@numba.njit(cache=True)
def _build(lows, highs, centers):
    order = np.arange(len(lows)).astype(np.uint32)
    boxes = np.zeros((2 * len(lows) + 1, 6), np.float32)
    links = np.zeros((2 * len(lows) + 1, 2), np.uint32)
    stack = [(0, 0, len(lows))]
    used = 1
    while len(stack) > 0:
        node, begin, end = stack.pop()
        boxes[node, :3], boxes[node, 3:] = np.inf, -np.inf
        for i in range(begin, end):
            for k in range(3):
                boxes[node, k] = min(boxes[node, k], lows[order[i], k])
                boxes[node, 3 + k] = max(boxes[node, 3 + k], highs[order[i], k])
        links[node, 0], links[node, 1] = begin, end - begin
        if end - begin <= _LEAF:
            continue
        axis, plane, least, greatest = _split(lows, highs, centers, order, begin, end)
        middle = (begin + end) // 2
        if axis >= 0:
            width = greatest[axis] - least[axis]
            i, j = begin, end - 1
            while i <= j:
                triangle = order[i]
                if min(_BINS - 1, int((centers[triangle, axis] - least[axis]) / width * _BINS)) <= plane:
                    i += 1
                else:
                    order[i], order[j] = order[j], triangle
                    j -= 1
            middle = i
        links[node, 0], links[node, 1] = used, 0
        stack.append((used, begin, middle))
        stack.append((used + 1, middle, end))
        used += 2
    return boxes[:used], links[:used], order


def build_nodes(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes (nodes, 6), links (nodes, 2) and the order of (n, 3, 3) float32 triangles; one thread."""
    low, high = triangles.min(1), triangles.max(1)
    return _build(low, high, (low + high) * np.float32(0.5))


class BoundingVolumes:
    """The hierarchy of triangles on the device. ``nodes``: what build_nodes gave for them."""

    def __init__(self, context, library, nodes: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
        boxes, links, order = nodes
        slack = np.float32(1e-6) * np.abs(boxes).max()
        packed = np.zeros((len(boxes), 8), np.float32)
        packed[:, :3], packed[:, 4:7] = boxes[:, :3] - slack, boxes[:, 3:] + slack
        packed.view(np.uint32)[:, 3], packed.view(np.uint32)[:, 7] = links[:, 0], links[:, 1]
        self._program = library.compute("../benchmarks/device/bounding_volumes.comp")
        self._nodes = context.moderngl.buffer(packed.tobytes())
        self._order = context.moderngl.buffer(order.tobytes())
        self.node_count = len(packed)

    def trace(self, triangles: moderngl.Buffer, rays: moderngl.Buffer, hits: moderngl.Buffer, count: int) -> None:
        """Trace rays, as DeepCubemap.trace does."""
        buffers = {"Rays": rays, "Hits": hits, "Triangles": triangles, "Nodes": self._nodes, "Order": self._order}
        for first in range(0, count, 1 << 18):
            end = min(first + (1 << 18), count)
            self._program.run(end - first, buffers, {"first_ray": first, "end_ray": end})

    def release(self) -> None:
        self._nodes.release()
        self._order.release()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The nearest hits by a bounding volume hierarchy on the CPU, with the same intersection in float32."""

import numba
import numpy as np

from rppm_addon.integrator.common.records.rays import HIT, NO_TRIANGLE, RAY

_LEAF = 4


def _build(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes of a median split: boxes, and (first child or place, count or 0); and the triangles' order.

    Not by numba, which would compile it for longer than it takes.
    """
    order, centers = np.arange(len(low)), (low + high) * np.float32(0.5)
    boxes, links = np.zeros((2 * len(low) + 1, 6), np.float32), np.zeros((2 * len(low) + 1, 2), np.int64)
    stack, used = [(0, 0, len(low))], 1
    while stack:
        node, begin, end = stack.pop()
        part = order[begin:end]
        boxes[node, :3], boxes[node, 3:] = low[part].min(0), high[part].max(0)
        if end - begin <= _LEAF:
            links[node] = begin, end - begin
            continue
        axis = np.argmax(np.ptp(centers[part], axis=0))
        order[begin:end] = part[np.argsort(centers[part, axis])]
        middle = (begin + end) // 2
        links[node] = used, 0
        stack += [(used, begin, middle), (used + 1, middle, end)]
        used += 2
    return boxes[:used], links[:used], order


@numba.njit(cache=True)
def _intersect(origin, axis, shear, vertices):
    """Distance and weights of vertices 1 and 2, in the order of operations of intersection.glsl."""
    x, y = (axis + 1) % 3, (axis + 2) % 3
    az, bz, cz = vertices[0, axis] - origin[axis], vertices[1, axis] - origin[axis], vertices[2, axis] - origin[axis]
    ax = (vertices[0, x] - origin[x]) - shear[0] * az
    ay = (vertices[0, y] - origin[y]) - shear[1] * az
    bx = (vertices[1, x] - origin[x]) - shear[0] * bz
    by = (vertices[1, y] - origin[y]) - shear[1] * bz
    cx = (vertices[2, x] - origin[x]) - shear[0] * cz
    cy = (vertices[2, y] - origin[y]) - shear[1] * cz
    if min(ax, bx, cx) > 0 or min(ay, by, cy) > 0 or max(ax, bx, cx) < 0 or max(ay, by, cy) < 0:
        return np.float32(-1), np.float32(0), np.float32(0)
    area0, area1, area2 = cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax
    zero = np.float32(0)
    miss = np.float32(-1)
    if (area0 < zero or area1 < zero or area2 < zero) and (area0 > zero or area1 > zero or area2 > zero):
        return miss, zero, zero
    area = area0 + area1 + area2
    if area == zero:
        return miss, zero, zero
    distance = (area0 * az + area1 * bz + area2 * cz) * shear[2] / area
    return distance, area1 / area, area2 / area


@numba.njit(cache=True, error_model="numpy")
def _trace(boxes, links, order, triangles, origins, directions, limits, sources, slack):
    count = origins.shape[0]
    nearest = np.empty(count, np.float32)
    found = np.full(count, NO_TRIANGLE, np.uint32)
    weights = np.zeros((count, 2), np.float32)
    for ray in range(count):
        origin, direction = origins[ray], directions[ray]
        axis = 0
        size = np.abs(direction)
        if size[0] > size[1]:
            axis = 0 if size[0] > size[2] else 2
        else:
            axis = 1 if size[1] > size[2] else 2
        shear = np.empty(3, np.float32)
        shear[0] = direction[(axis + 1) % 3] / direction[axis]
        shear[1] = direction[(axis + 2) % 3] / direction[axis]
        shear[2] = np.float32(1) / direction[axis]
        best, hit, u, v = limits[ray], np.uint32(NO_TRIANGLE), np.float32(0), np.float32(0)
        stack = np.empty(64, np.int64)
        stack[0] = 0
        height = 1
        while height > 0:
            height -= 1
            node = stack[height]
            enter, leave = -slack, np.float64(best) + slack
            for k in range(3):
                least = np.float64(boxes[node, k]) - slack - origin[k]
                greatest = np.float64(boxes[node, 3 + k]) + slack - origin[k]
                if direction[k] == 0:
                    if least > 0 or greatest < 0:
                        leave = -np.inf
                else:
                    a, b = least / np.float64(direction[k]), greatest / np.float64(direction[k])
                    enter, leave = max(enter, min(a, b)), min(leave, max(a, b))
            if enter > leave:
                continue
            first, number = links[node]
            if number == 0:
                stack[height], stack[height + 1] = first, first + 1
                height += 2
                continue
            for place in range(first, first + number):
                triangle = np.uint32(order[place])
                if triangle == sources[ray]:
                    continue
                distance, weight1, weight2 = _intersect(origin, axis, shear, triangles[triangle])
                if distance > 0 and (distance < best or (distance == best and triangle < hit)):
                    best, hit, u, v = distance, triangle, weight1, weight2
        nearest[ray], found[ray], weights[ray, 0], weights[ray, 1] = best, hit, u, v
    return nearest, found, weights


class Reference:
    """Nearest hits of rays in (n, 3, 3) float32 triangles."""

    def __init__(self, triangles: np.ndarray) -> None:
        self._triangles = np.ascontiguousarray(triangles)
        self._nodes = _build(triangles.min(1), triangles.max(1))
        # boxes are widened by more than the rounding of distances in float32
        self._slack = 1e-5 * float(np.ptp(triangles.reshape(-1, 3), axis=0).max())

    def trace(self, rays: np.ndarray) -> np.ndarray:
        """Hit records of Ray records."""
        assert rays.dtype == RAY.dtype
        hits = HIT.zeros(len(rays))
        columns = (rays[name] for name in ("origin", "direction", "maximum_distance", "source_triangle"))
        arrays = (np.ascontiguousarray(column) for column in columns)
        nearest, found, weights = _trace(*self._nodes, self._triangles, *arrays, self._slack)
        hits["triangle"], hits["distance"], hits["b1"], hits["b2"] = found, nearest, weights[:, 0], weights[:, 1]
        return hits

# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths of edges in units of the length that Adaptive Subdivision allows, as Cycles measures them."""

import numpy as np

from ....scene.camera import Camera
from ....scene.meshes import DicingView, Instance, Mesh

_MAX_MEASURED = 16
"""Largest number of instances of a mesh for which its edges are measured: those that the camera sees largest."""


class EdgeLengths:
    """Measure of the edges of one mesh, for all of its instances that the camera may see large.

    Each edge is measured by its ends alone, with operations that do not depend on their order: triangles that share an
    edge agree on its length to the last bit.
    """

    def __init__(self, mesh: Mesh, instances: list[Instance], camera: Camera, view: DicingView) -> None:
        """camera: by which edges are measured in pixels. view.rate is the unit in object space as well."""
        dicing = mesh.dicing
        assert dicing is not None
        self._view, self._camera = view, camera
        self._in_pixels = dicing.in_pixels
        self._unit = dicing.edge_length * view.rate
        self._matrices = [np.eye(4)]
        if dicing.in_pixels:
            to_camera = np.linalg.inv(camera.matrix)
            matrices = [to_camera @ np.asarray(instance.matrix, np.float64) for instance in instances]
            self._matrices = _largest(matrices, mesh, camera.orthographic)[:_MAX_MEASURED]

    def seen(self, positions: np.ndarray) -> np.ndarray:
        """(instances, 3, vertices) float64: positions (vertices, 3) as the camera sees them in each instance; object
        space where edges are measured there."""
        x, y, z = positions.astype(np.float64).T
        return np.array([[row[0] * x + row[1] * y + row[2] * z + row[3] for row in of[:3]] for of in self._matrices])

    def between(self, seen: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Lengths of the edges between vertices of these indices, of any shape: the largest of all instances.

        seen: as ``seen`` gives it.
        """
        result = np.zeros(starts.shape)
        for points in seen:
            a, b = points[:, starts], points[:, ends]
            x, y, z = a - b
            lengths = np.sqrt(x * x + y * y + z * z)
            if self._in_pixels:
                lengths /= self._pixel_sizes(0.5 * (a + b))
            np.fmax(result, lengths, out=result)  # instances with matrices that are not finite do not count
        return result / self._unit

    def _pixel_sizes(self, points: np.ndarray) -> np.ndarray:
        """Width of a pixel in meters at points (3, ...) of the camera's space; outside of the picture, the larger the
        farther they are from it."""
        camera, growth = self._camera, self._view.offscreen_scale - 1.0
        size = max(camera.pixel_size, 1e-30)
        if camera.orthographic:
            left, right, bottom, top = camera.window
            frame = np.hypot(right - left, top - bottom)
            return size * (1.0 + growth * _distance_to_box(points, camera.window) / max(frame, 1e-30))
        x, y, z = points
        distances = np.sqrt(x * x + y * y + z * z)
        if camera.panorama is None and growth > 0.0:
            distances = distances + growth * _distance_to_frustum(points, distances, camera.window)
        return size * np.maximum(distances, 1e-30)


def _largest(matrices: list[np.ndarray], mesh: Mesh, is_orthographic: bool) -> list[np.ndarray]:
    """The matrices to the camera's space, those first that show the mesh largest."""
    if len(matrices) <= _MAX_MEASURED or len(mesh.positions) == 0:
        return matrices
    low, high = mesh.positions.min(axis=0).astype(np.float64), mesh.positions.max(axis=0).astype(np.float64)
    stack = np.array(matrices)
    scales = np.cbrt(np.abs(np.linalg.det(stack[:, :3, :3])))
    distances = np.linalg.norm(stack[:, :3, :3] @ (0.5 * (low + high)) + stack[:, :3, 3], axis=1)
    distances -= 0.5 * scales * np.linalg.norm(high - low)
    sizes = scales if is_orthographic else scales / np.maximum(distances, 1e-6)
    return [matrices[index] for index in np.argsort(-sizes, kind="stable").tolist()]


def _distance_to_box(points: np.ndarray, window: tuple[float, float, float, float]) -> np.ndarray:
    """Meters from points (3, ...) to what an orthographic camera has before it."""
    left, right, bottom, top = window
    x, y, z = points
    dx = np.maximum(np.maximum(left - x, x - right), 0.0)
    dy = np.maximum(np.maximum(bottom - y, y - top), 0.0)
    dz = np.maximum(z, 0.0)
    return np.sqrt(dx * dx + dy * dy + dz * dz)


def _distance_to_frustum(
    points: np.ndarray, distances: np.ndarray, window: tuple[float, float, float, float]
) -> np.ndarray:
    """Meters from points (3, ...) to what a perspective camera has before it: to the plane of a side, or where that
    lies behind the camera, to the camera (Camera::world_to_raster_size of Cycles). distances: to the camera."""
    left, right, bottom, top = window
    x, y, z = points
    result = np.zeros_like(x)
    is_behind, is_outside_of_all = np.zeros(x.shape, bool), np.ones(x.shape, bool)
    for across, slope in ((x, right), (-x, -left), (y, top), (-y, -bottom)):
        norm = np.sqrt(1.0 + slope * slope)
        distance = (across + slope * z) / norm
        is_outside = distance > 0.0
        is_before = slope * across >= z
        np.maximum(result, np.where(is_outside & is_before, distance, 0.0), out=result)
        is_behind |= is_outside & ~is_before
        is_outside_of_all &= is_outside
    result = np.where(is_behind, np.where(result > 0.0, np.minimum(result, distances), distances), result)
    return np.where(is_outside_of_all, distances, result)

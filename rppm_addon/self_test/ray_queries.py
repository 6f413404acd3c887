# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays through an acceleration structure and past all of its triangles, with NumPy in and out."""

from collections.abc import Callable

import moderngl
import numpy as np

from ..gl.buffers.records import Record
from ..gl.context.context import Context
from ..gl.programs.programs import ProgramLibrary
from ..integrator.acceleration.acceleration_structure import AccelerationStructure
from ..integrator.common.active_paths import ActivePaths
from ..integrator.common.records.rays import HIT, NO_TRIANGLE, RAY
from ..integrator.deep_cubemap.deep_cubemap import DeepCubemap

Record("BruteForceParameters", first_ray="uint", end_ray="uint", triangle_count="uint")

_BRUTE_FORCE_TESTS = 1 << 24
"""Ray-triangle tests of one dispatch."""

_Operation = Callable[[moderngl.Buffer, moderngl.Buffer, int], None]


def ray_records(origins: np.ndarray, directions: np.ndarray, maximum_distance: float = 1e9) -> np.ndarray:
    """RAY records of (n, 3) origins in meters and directions of length 1."""
    rays = RAY.zeros(len(origins))
    rays["origin"], rays["direction"], rays["maximum_distance"] = origins, directions, maximum_distance
    rays["source_triangle"] = NO_TRIANGLE
    return rays


class TracedTriangles:
    """Triangles on the device and their acceleration structure; a context manager."""

    def __init__(
        self,
        context: Context,
        library: ProgramLibrary,
        triangles: np.ndarray,
        center: np.ndarray,
        resolution: int = 64,
        rasterize: bool | None = True,
        texel_buffers: bool | None = None,
        max_cluster_size: int | None = None,
        structure: AccelerationStructure | None = None,
    ) -> None:
        """triangles: (n, 3, 3) vertices; structure: which this releases, None makes a deep cubemap of the other
        arguments, which are DeepCubemap's. Raises DeviceError."""
        self.context, self.library = context, library
        self.host_triangles = np.asarray(triangles, np.float32)
        vertices = np.zeros((max(3 * len(triangles), 1), 4), np.float32)
        vertices[: 3 * len(triangles), :3] = self.host_triangles.reshape(-1, 3)
        self.triangles = context.moderngl.buffer(vertices.tobytes())
        self.center = np.asarray(center, np.float32)
        self.structure = structure or DeepCubemap(
            context, library, rasterize, texel_buffers=texel_buffers, max_cluster_size=max_cluster_size
        )
        self._rays = ActivePaths(context, library, "rays of a test", "take fewer")
        self.build(resolution)

    def build(self, resolution: int) -> None:
        """Build the acceleration structure anew."""
        distances = np.linalg.norm(self.host_triangles.reshape(-1, 3) - self.center, axis=1)
        radius = distances[np.isfinite(distances)].max(initial=0.0)
        self.structure.build(self.triangles, len(self.host_triangles), self.center, radius, resolution)

    def trace(self, rays: np.ndarray) -> np.ndarray:
        """HIT records of RAY records."""
        return self._run(rays, HIT.dtype, self._of_all(self.structure.trace))

    def occluded(self, rays: np.ndarray, targets: np.ndarray | None = None) -> np.ndarray:
        """uint32, 1 where a ray is free, else 0. targets: triangles that rays go to and that do not count, uint32."""
        if targets is None:
            targets = np.full(len(rays), NO_TRIANGLE, np.uint32)
        ends = self.context.moderngl.buffer(targets.tobytes())
        try:
            return self._run(
                rays,
                np.dtype(np.uint32),
                self._of_all(lambda queried, free, active: self.structure.occluded(queried, ends, free, active)),
            )
        finally:
            ends.release()

    def _of_all(self, operation: Callable[[moderngl.Buffer, moderngl.Buffer, ActivePaths], None]) -> _Operation:
        def run(ray_buffer: moderngl.Buffer, result_buffer: moderngl.Buffer, count: int) -> None:
            self._rays.fill(count)
            operation(ray_buffer, result_buffer, self._rays)

        return run

    def brute_force(self, rays: np.ndarray) -> np.ndarray:
        """HIT records of RAY records, by testing all triangles."""
        program = self.library.compute("self_test/brute_force.comp")
        chunk = max(_BRUTE_FORCE_TESTS // max(len(self.host_triangles), 1), 64)

        def run(ray_buffer: moderngl.Buffer, hit_buffer: moderngl.Buffer, count: int) -> None:
            for first in range(0, count, chunk):
                end = min(first + chunk, count)
                program.run(
                    end - first,
                    {"Rays": ray_buffer, "Hits": hit_buffer, "Triangles": self.triangles},
                    {"first_ray": first, "end_ray": end, "triangle_count": len(self.host_triangles)},
                )

        return self._run(rays, HIT.dtype, run)

    def _run(self, rays: np.ndarray, dtype: np.dtype, operation: _Operation) -> np.ndarray:
        ray_buffer = self.context.moderngl.buffer(rays.tobytes())
        result = self.context.moderngl.buffer(reserve=dtype.itemsize * len(rays))
        try:
            operation(ray_buffer, result, len(rays))
            return np.frombuffer(result.read(), dtype).copy()
        finally:
            ray_buffer.release()
            result.release()

    def release(self) -> None:
        """Free the device's memory."""
        self.structure.release()
        self._rays.release()
        self.triangles.release()

    def __enter__(self) -> "TracedTriangles":
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

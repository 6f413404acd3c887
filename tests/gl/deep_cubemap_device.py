# SPDX-License-Identifier: GPL-3.0-or-later
"""A deep cubemap of a NumPy scene, with NumPy in and out."""

import numpy as np

from rppm_addon.gl.records import Record
from rppm_addon.integrator.common.living_paths import LivingPaths
from rppm_addon.integrator.common.records import HIT, NO_TRIANGLE, RAY
from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap

BRUTE_FORCE = Record("BruteForceParameters", first_ray="uint", end_ray="uint", triangle_count="uint")
_BRUTE_FORCE_TESTS = 1 << 24  # per dispatch


def ray_records(origins, directions, maximum_distance=1e9) -> np.ndarray:
    rays = RAY.zeros(len(origins))
    rays["origin"], rays["direction"], rays["maximum_distance"] = origins, directions, maximum_distance
    rays["source_triangle"] = NO_TRIANGLE
    return rays


class Scene:
    """Triangles on the device and their cubemap; a context manager."""

    def __init__(
        self,
        context,
        library,
        triangles: np.ndarray,
        center,
        resolution: int = 64,
        rasterize: bool | None = True,
        texel_buffers: bool | None = None,
    ) -> None:
        self.context, self.library = context, library
        self.host_triangles = np.asarray(triangles, np.float32)
        vertices = np.zeros((max(3 * len(triangles), 1), 4), np.float32)
        vertices[: 3 * len(triangles), :3] = self.host_triangles.reshape(-1, 3)
        self.triangles = context.moderngl.buffer(vertices.tobytes())
        self.center = np.asarray(center, np.float32)
        self.cubemap = DeepCubemap(context, library, rasterize, texel_buffers=texel_buffers)
        self._rays = LivingPaths(context, library, "rays of a test", "take fewer")
        self.build(resolution)

    def build(self, resolution: int) -> None:
        distances = np.linalg.norm(self.host_triangles.reshape(-1, 3) - self.center, axis=1)
        radius = distances[np.isfinite(distances)].max(initial=0.0)
        self.cubemap.build(self.triangles, len(self.host_triangles), self.center, radius, resolution)

    def trace(self, rays: np.ndarray) -> np.ndarray:
        """Hit records."""
        return self._run(rays, HIT.dtype, self._of_all(self.cubemap.trace))

    def occluded(self, rays: np.ndarray) -> np.ndarray:
        """1 where a ray is free, else 0."""
        return self._run(rays, np.dtype(np.uint32), self._of_all(self.cubemap.occluded))

    def _of_all(self, operation):
        def run(ray_buffer, result_buffer, count):
            self._rays.fill(count)
            operation(ray_buffer, result_buffer, self._rays)

        return run

    def brute_force(self, rays: np.ndarray) -> np.ndarray:
        """Hit records, by testing all triangles."""
        program = self.library.compute("../tests/gl/deep_cubemap_brute_force.comp")
        chunk = max(_BRUTE_FORCE_TESTS // max(len(self.host_triangles), 1), 64)

        def run(ray_buffer, hit_buffer, count):
            for first in range(0, count, chunk):
                end = min(first + chunk, count)
                program.run(
                    end - first,
                    {"Rays": ray_buffer, "Hits": hit_buffer, "Triangles": self.triangles},
                    {"first_ray": first, "end_ray": end, "triangle_count": len(self.host_triangles)},
                )

        return self._run(rays, HIT.dtype, run)

    def _run(self, rays, dtype, operation) -> np.ndarray:
        ray_buffer = self.context.moderngl.buffer(rays.tobytes())
        result = self.context.moderngl.buffer(reserve=dtype.itemsize * len(rays))
        try:
            operation(ray_buffer, result, len(rays))
            return np.frombuffer(result.read(), dtype).copy()
        finally:
            ray_buffer.release()
            result.release()

    def release(self) -> None:
        self.cubemap.release()
        self._rays.release()
        self.triangles.release()

    def __enter__(self) -> "Scene":
        return self

    def __exit__(self, *_) -> None:
        self.release()

# SPDX-License-Identifier: GPL-3.0-or-later
"""UpdatePPMParams: running means of radiance and of the first surface, per pixel."""

import moderngl
import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from .importons import Importons
from .splat_sums import SplatSums

Record("SurfaceParameters", first_pixel="uint", iteration="uint", segment="uint")
Record("FilmParameters", count="uint", quantum="float", first_pixel="uint", iteration="uint")


class Film:
    """Means over the iterations, 16 bytes of radiance and alpha and 20 of normal, depth and their count a pixel.

    ``iteration`` counts, from 1, those that are in the film.
    """

    def __init__(self, context: Context, library: ProgramLibrary, width: int, height: int) -> None:
        self._surface_program = library.compute("film/surface.comp")
        self._accumulate = library.compute("film/accumulate.comp")
        remedy = "lower the resolution"
        self._radiance = GrowingBuffer(context, "film", remedy)
        self._surface = GrowingBuffer(context, "film surface", remedy)
        self._radiance.require(16 * width * height)
        self._surface.require(16 * width * height)
        self._surface_counts = GrowingBuffer(context, "film surface counts", remedy)
        self._surface_counts.require(4 * width * height)
        self.width, self.height = width, height

    @property
    def memory_bytes(self) -> dict[str, int]:
        return {buffer.name: buffer.size for buffer in (self._radiance, self._surface, self._surface_counts)}

    def add_surface(
        self, camera: moderngl.Buffer, importons: Importons, first_pixel: int, iteration: int, segment: int
    ) -> None:
        """Add the first surfaces that the camera paths of a band have found in a segment."""
        importons.living.run(
            self._surface_program,
            {
                "Camera": camera,
                "Closures": importons.closures.buffer,
                "Rays": importons.rays.buffer,
                "CameraPaths": importons.paths.buffer,
                "Surfaces": self._surface.buffer,
                "SurfaceCounts": self._surface_counts.buffer,
            },
            {"first_pixel": first_pixel, "iteration": iteration, "segment": segment},
        )

    def add(self, radiances: moderngl.Buffer, sums: SplatSums, count: int, first_pixel: int, iteration: int) -> None:
        """Add the band's estimate of an iteration."""
        self._accumulate.run(
            count,
            {"Radiances": radiances, "SplatSums": sums.buffer, "Film": self._radiance.buffer},
            {"count": count, "quantum": sums.quantum, "first_pixel": first_pixel, "iteration": iteration},
        )

    def read_radiance(self) -> np.ndarray:
        """(height, width, 4) float32 radiance W/(m^2 sr) and alpha, row 0 at the bottom."""
        return self._radiance.read(np.float32, 4 * self.width * self.height).reshape(self.height, self.width, 4).copy()

    def read_surface(self) -> tuple[np.ndarray, np.ndarray]:
        """(height, width, 3) mean normals and (height, width) depth along the view axis in metres."""
        surface = self._surface.read(np.float32, 4 * self.width * self.height).reshape(self.height, self.width, 4)
        return surface[..., :3].copy(), surface[..., 3].copy()

    def read_surface_counts(self) -> np.ndarray:
        """(height, width) uint32 iterations that the mean normal is of: those whose path did not end before."""
        return self._surface_counts.read(np.uint32, self.width * self.height).reshape(self.height, self.width).copy()

    def restore(self, radiance: np.ndarray, normal: np.ndarray, depth: np.ndarray, surface_counts: np.ndarray) -> None:
        """Take the means that read_radiance, read_surface and read_surface_counts gave."""
        self._radiance.upload(radiance)
        self._surface.upload(np.concatenate([normal, depth[..., None]], axis=-1))
        self._surface_counts.upload(surface_counts)

    def release(self) -> None:
        for buffer in (self._radiance, self._surface, self._surface_counts):
            buffer.release()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon splatting by rasterization: onto the camera view (direct) and onto cubemap views (indirect), section 4.2."""

from collections.abc import Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record, stride
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable, DrawProgram
from ...gl.programs.programs import ProgramLibrary
from ..common.band import MAX_RASTER_PIXELS
from ..common.stage_sizes import StageSizes, band_pixels
from .splat_sums import SUM_PARAMETERS, SplatSums
from .stored_photons import CameraRaster, SplatTargets, StoredPhotons

_CUBE_RESOLUTION, _BLOCK_SIZE = 128, 8
Constants("SplatCubemap", signed=True, BLOCK_SIZE=_BLOCK_SIZE)
_FEW_IMPORTONS = 40_000
"""Up to so many have a cubemap of half the side: the same picture, on llvmpipe in 7 to 23 % less time."""
_FACES_OF_A_SPLAT = 3
"""A cone of 30 degrees touches at most so many faces of a cube."""

Record("SplatParameters", count="uint", minimum_radius="float", radius="float", gathers="uint")
Record("QuadParameters", width="uint", height="uint", **SUM_PARAMETERS)
Record(
    "CubeParameters",
    center="vec3",
    count="uint",
    minimum_radius="float",
    radius="float",
    resolution="uint",
    gathers="uint",
    **SUM_PARAMETERS,
)
StorageBlock("Heads", "uint heads[];")
StorageBlock("Core", "uint core_count; uint core_importons[];")
StorageBlock("Jobs", "uint job_vertices; uint draw_arguments[3]; SplatJob jobs[];")


def _resolution(sizes: StageSizes) -> int:
    """Pixels along the sides of the splat cubemap."""
    few = band_pixels(sizes) <= _FEW_IMPORTONS
    return max(_BLOCK_SIZE, _CUBE_RESOLUTION // 2) if few else _CUBE_RESOLUTION


def _head_count(sizes: StageSizes) -> int:
    resolution = _resolution(sizes)
    return 6 * (resolution**2 + (resolution // _BLOCK_SIZE) ** 2 + 4)


class Splatting(BufferSet):
    """Adds photons to the importons of a band, one route of density estimation (density_estimator.py)."""

    _jobs = StorageBuffer(
        "splat jobs",
        "uvec4",
        header="uvec4",
        remedy="lower the photons per iteration or the photon path length",
        block="Jobs",
    )
    _heads = StorageBuffer("splat cubemap", "uint", _head_count, block="Heads")
    _core = StorageBuffer("splat core list", "uint", band_pixels, header="uint", block="Core")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        gl = context.moderngl
        self._direct_jobs = library.compute("density_estimation/splatting/direct_jobs.comp")
        self._direct_program = library.draw(
            "density_estimation/splatting/quads.vert", "density_estimation/splatting/direct.frag"
        )
        self._insert = library.compute("density_estimation/splatting/insert.comp")
        self._indirect_jobs = library.compute("density_estimation/splatting/indirect_jobs.comp")
        self._indirect_program = library.draw(
            "density_estimation/splatting/quads.vert", "density_estimation/splatting/indirect.frag"
        )
        self._core_program = library.compute("density_estimation/splatting/core.comp")
        self._resolution = _resolution(sizes)
        self._direct_view = self.own(gl.empty_framebuffer((min(sizes.width, MAX_RASTER_PIXELS), sizes.bands[0].rows)))
        self._cube_size = (3 * self._resolution, 2 * self._resolution)
        self._cube_view = self.own(gl.empty_framebuffer(self._cube_size))

    @staticmethod
    def holds(context: Context, photons: StoredPhotons) -> bool:
        """Whether a device may have room for an iteration's photons in one buffer."""
        return (_FACES_OF_A_SPLAT * photons.count + 1) * stride("uvec4") <= context.storage_block_limit

    def prepare(self, photons: StoredPhotons) -> None:
        """Make room for an iteration's photons."""
        self._jobs.require_items(_FACES_OF_A_SPLAT * photons.count)

    def splat(self, photons: StoredPhotons, importons: SplatTargets, sums: SplatSums) -> None:
        """Add to the sums what the photons that were prepared for give."""
        if importons.raster is not None:
            self._direct(photons, importons, sums, importons.raster)
        else:
            self._indirect(photons, importons, sums)

    def _reset_jobs(self) -> None:
        """The arguments of the indirect draw: no vertices yet, one instance."""
        self._jobs.buffer.write(np.array([0, 1, 0, 0], np.uint32).tobytes())

    def _draw(
        self,
        program: DrawProgram,
        view: moderngl.Framebuffer,
        size: tuple[int, int],
        blocks: dict[str, Bindable],
        parameters: Mapping[str, object],
    ) -> None:
        """The quads of the jobs, into a view's part of that size."""
        width, height = size
        program.draw(
            view,
            self._jobs.buffer,
            {**self.blocks, **blocks},
            {"width": width, "height": height, **parameters},
            viewport=(0, 0, width, height),
        )

    def _direct(self, photons: StoredPhotons, importons: SplatTargets, sums: SplatSums, raster: CameraRaster) -> None:
        """DirectSplatting: onto the importons of the camera's first hits."""
        self._reset_jobs()
        self._direct_jobs.run(
            photons.count,
            {**photons.blocks, **self.blocks, "Camera": raster.camera},
            {
                "count": photons.count,
                "minimum_radius": importons.minimum_radius(photons),
                "radius": importons.narrow_radius(photons),
                "gathers": importons.gathers,
            },
        )
        self._draw(
            self._direct_program,
            self._direct_view,
            (raster.width, raster.rows),
            {**photons.blocks, **importons.blocks, **sums.blocks},
            sums.parameters,
        )

    def _indirect(self, photons: StoredPhotons, importons: SplatTargets, sums: SplatSums) -> None:
        """IndirectSplatting: onto importons anywhere, by the cubemap's lists."""
        self._heads.clear()
        self._core.buffer.write(bytes(4))
        self._reset_jobs()
        cube = {
            "center": importons.center,
            "minimum_radius": importons.minimum_radius(photons),
            "radius": importons.narrow_radius(photons),
            "resolution": self._resolution,
            "gathers": importons.gathers,
            **sums.parameters,
        }
        importons.active.run(
            self._insert,
            {**photons.blocks, **self.blocks, "Importons": importons.importons},
            {**cube, "count": importons.active.capacity},
        )
        self._indirect_jobs.run(
            photons.count,
            {**photons.blocks, **self.blocks},
            {**cube, "count": photons.count},
        )
        splats = {**photons.blocks, **importons.blocks, **sums.blocks}
        self._draw(
            self._indirect_program,
            self._cube_view,
            self._cube_size,
            splats,
            sums.parameters,
        )
        self._core_program.run(
            photons.count,
            {**self.blocks, **splats},
            {**cube, "count": photons.count},
        )

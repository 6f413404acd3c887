# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons in hashed grids, from which each importon gathers those around it: the same sums as splatting gives.

Photons are sorted into the buckets of several grids by a counting sort, once an iteration. The importons of a segment
are grouped by cells in the same way, so that threads side by side walk the same photons. Nothing depends on the order
in which photons or importons come to lie.
"""

from typing import Any

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..common.stage_sizes import StageSizes, band_pixels
from .splat_sums import SUM_PARAMETERS, SplatSums
from .stored_photons import SplatTargets, StoredPhotons

_GRID_PARAMETERS = {
    "caustic_sides": "vec4",
    "wide_side": "float",
    "caustic_buckets": "uint",
    "wide_buckets": "uint",
}
Record("GridParameters", count="uint", **_GRID_PARAMETERS)
Record("AllocateParameters", count="uint")
Record("GroupParameters", buckets="uint", side="float", group_size="uint")
Record(
    "GatherPhotonsParameters",
    max_rounds="uint",
    rounding="float",
    caustics="uint",
    **_GRID_PARAMETERS,
    **SUM_PARAMETERS,
)
StorageBlock("Buckets", "uint cursor; uint wide_in_use[2]; uint pairs_in_media; uvec2 buckets[];")
StorageBlock("SortedPhotons", "uvec4 sorted_photons[];")
StorageBlock("Visits", "uint visit_groups[3]; uint visit_count; uvec2 visits[];")

_FINER_SIDES = (2.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0)
"""Caustic grids after the first, which is for the ends of gathering rays and the first iteration, by their radius as a
part of the largest elsewhere: importons whose radius is that much smaller, since they are near the camera or take many
photons, look at fewer."""
_CAUSTIC_GRIDS, _WIDE_GRIDS = 1 + len(_FINER_SIDES), 2
Constants("PhotonGrids", CAUSTIC_GRIDS=_CAUSTIC_GRIDS)
_FEWEST_BUCKETS = 1 << 10
_ROUNDING_STEPS = 8.0
"""Float spacings at the largest coordinate: more than the rounding of a sphere's ends and of their division."""
_MAX_ROUNDS = 2000
"""Most rounds of a thread on software devices: llvmpipe ends the loops of a thread after 65535 rounds in all. The
threads of a vector, up to 16, may have to wait for each other in both loops."""
_NO_LIMIT = 0xFFFFFFFF
_FEWER_PIXELS = "lower the resolution"


def _buckets(count: int) -> int:
    """A power of two, at least the count."""
    return max(_FEWEST_BUCKETS, 1 << (max(count, 1) - 1).bit_length())


class PhotonGrid(BufferSet):
    """Adds photons to the importons of a band, one route of density estimation (density_estimator.py)."""

    remedy = "lower the photons per iteration or the photon path length"
    _grid = StorageBuffer("photon grid", "uvec2", header="uvec4")
    _sorted_photons = StorageBuffer("sorted photons", "uvec4", texel_bytes=16, block="SortedPhotons")
    _importon_grid = StorageBuffer(
        "importon grid", "uvec2", lambda sizes: _buckets(band_pixels(sizes)), "uvec4", _FEWER_PIXELS
    )
    _visits = StorageBuffer("importon visits", "uvec2", band_pixels, "uvec4", _FEWER_PIXELS)
    _unfinished_visits = StorageBuffer("unfinished importon visits", "uvec2", band_pixels, "uvec4", _FEWER_PIXELS)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._count_photons = library.compute("density_estimation/photon_grid/count_photons.comp")
        self._place_photons = library.compute("density_estimation/photon_grid/place_photons.comp")
        self._count_importons = library.compute("density_estimation/photon_grid/count_importons.comp")
        self._place_importons = library.compute("density_estimation/photon_grid/place_importons.comp")
        self._allocate = library.compute("density_estimation/photon_grid/allocate.comp")
        self._gather = library.compute("density_estimation/photon_grid/gather.comp")
        self._max_rounds = _MAX_ROUNDS if context.is_software else _NO_LIMIT
        self._parameters: dict[str, Any] = {}

    @property
    def visited(self) -> int:
        """Importons of the last splat that gathered; waits for the device."""
        return int(self._importon_grid.read(np.uint32, 1)[0])

    def prepare(self, photons: StoredPhotons) -> None:
        """Sort an iteration's photons into the grids."""
        radii, caustics = photons.radii, photons.caustic_count
        spacing = float(np.spacing(np.float32(photons.largest_coordinate)))
        self._rounding = max(_ROUNDING_STEPS * spacing, 1e-30)
        caustic_radii = radii.final_gather, *(part * radii.caustic for part in _FINER_SIDES)
        self._parameters = {
            "caustic_sides": [self._side(radius) for radius in caustic_radii],
            "wide_side": self._side(max(radii.final_gather, radii.wide)),
            "caustic_buckets": _buckets(caustics),
            "wide_buckets": _buckets(photons.global_photon_count),
        }
        self._holds_caustics = caustics > 0
        buckets = _CAUSTIC_GRIDS * _buckets(caustics) + _WIDE_GRIDS * _buckets(photons.global_photon_count)
        self._grid.require_items(buckets)
        self._sorted_photons.require_items(_CAUSTIC_GRIDS * caustics + photons.global_photon_count)
        cells = {"Buckets": self._grid.buffer}
        parameters = {**self._parameters, "count": photons.count}
        self._grid.clear()
        self._count_photons.run(photons.count, {**photons.blocks, **cells}, parameters)
        self._allocate.run(buckets, cells, {"count": buckets})
        self._place_photons.run(photons.count, {**photons.blocks, **self.blocks, **cells}, parameters)

    def _side(self, radius: float) -> float:
        """Return the side of cells, meters, for spheres up to a radius, meters.

        The reach of the spheres is a little longer in shaders/density_estimation/photon_grid/gather.comp.
        """
        return 2.0 * (1.001 * radius + 2.0 * self._rounding)

    def splat(self, photons: StoredPhotons, importons: SplatTargets, sums: SplatSums) -> None:
        """Add to the sums what the photons that were prepared give."""
        self._group(importons)
        visits, unfinished = self._visits, self._unfinished_visits
        while True:
            unfinished.buffer.write(np.array([0, 1, 1, 0], np.uint32).tobytes())
            self._gather.run_indirect(
                visits.buffer,
                0,
                {
                    **photons.blocks,
                    **sums.blocks,
                    **self.blocks,
                    **importons.blocks,
                    "Buckets": self._grid.buffer,
                    "Visits": visits.buffer,
                    "UnfinishedVisits": unfinished.buffer,
                },
                {
                    "max_rounds": self._max_rounds,
                    "rounding": self._rounding,
                    "caustics": self._holds_caustics,
                    **self._parameters,
                    **sums.parameters,
                },
            )
            if self._max_rounds == _NO_LIMIT or not unfinished.read(np.uint32, 1)[0]:
                return
            visits, unfinished = unfinished, visits

    def _group(self, importons: SplatTargets) -> None:
        """List the importons that gather, those of a cell side by side."""
        buckets = _buckets(importons.active.known_count)
        cells = {"Buckets": self._importon_grid.buffer}
        parameters = {
            "buckets": buckets,
            "side": 0.5 * self._parameters["wide_side"],
            "group_size": self._gather.local_size,
        }
        self._importon_grid.clear()
        self._visits.buffer.write(np.array([0, 1, 1, 0], np.uint32).tobytes())
        importons.active.run(self._count_importons, {"Importons": importons.importons, **cells}, parameters)
        self._allocate.run(buckets, cells, {"count": buckets})
        importons.active.run(
            self._place_importons,
            {"Importons": importons.importons, **cells, "Visits": self._visits.buffer},
            parameters,
        )

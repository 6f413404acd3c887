# SPDX-License-Identifier: GPL-3.0-or-later
"""The volume photon map: photons that media have scattered, and the camera rays that gather them."""

import math

import numpy as np

from ...gl.buffer_sets import ComputeShader, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ..camera_paths.importons import Importons
from ..common.band import Band
from ..common.iteration import Iteration
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes
from ..density_estimation.radii import shrinkage_in
from ..density_estimation.splat_sums import SUM_PARAMETERS, SplatSums
from ..device_scene.stage_context import StageContext
from ..photons.photons import Photons

Record("ListMediumPhotonsParameters", count="uint")
Record("MediumGridParameters", buckets="uint", side="float")
Record(
    "GatherInMediaParameters",
    segment="uint",
    first_pixel="uint",
    radius="float",
    free_paths="float",
    side="float",
    buckets="uint",
    first_candidate="uint",
    candidates="uint",
    draws_beams="uint",
    straight_photons="uint",
    least_free_path="float",
    **SUM_PARAMETERS,
)
StorageBlock(
    "MediumPhotons",
    "uint medium_photon_count; uint straight_photon_count; uint direct_photon_count; uint medium_photons_unused; "
    "uint medium_photons[];",
)
"""Numbers of the photons that media have scattered, and how many of them nothing but surfaces that store no photons had
scattered before; and how many others came straight from a light, which shadow rays stand for."""

_EXPECTED_PHOTONS = 8
"""Photons in the kernel of the first iteration, where they lie evenly in the media."""
_WIDEST = 0.1
"""Largest radius over Media.reach."""
_FEWEST_BUCKETS = 1 << 10
_WIDEST_KERNEL = 2.5
"""Largest radius in dense media over that by the number of photons."""
_FREE_PATHS = 0.7
"""Radius of the first iteration in dense media, mean free paths."""
Constants("MediumPhotonKernel", signed=True, WIDEST=_WIDEST_KERNEL)
_MOST_STRAIGHT = 0.25
"""Fraction of the photons that come to media straight or by surfaces that store none which may have come by the latter
where camera paths are scattered: they find no such light."""
_CANDIDATES = 30_000
"""Photons that a thread looks at: llvmpipe ends the loops of a thread after 65535 rounds."""


class MediumPhotonMap(Stage):
    """Photons in media, by cells of a hashed grid, and their density along camera rays."""

    memory_group = "media"
    remedy = "lower the photons per iteration or the photon path length"
    _numbers = StorageBuffer("photons in media", "uint", header="uvec4", block="MediumPhotons")
    _grid = StorageBuffer("grid of photons in media", "uvec2", header="uvec4", block="Buckets")
    _sorted = StorageBuffer("sorted photons in media", "uvec4", texel_bytes=16, block="SortedPhotons")
    _list = ComputeShader("media/photon_map/list.comp")
    _count = ComputeShader("media/photon_map/count.comp")
    _allocate = ComputeShader("density_estimation/photon_grid/allocate.comp")
    _place = ComputeShader("media/photon_map/place.comp")
    _gather = ComputeShader("media/photon_map/gather.comp")
    photon_count = 0
    """Photons of the iteration that the map holds."""
    radius = 0.0
    """Radius of the kernel, meters."""
    _straight_count = 0
    """Photons of the map that nothing but specular surfaces has scattered before."""
    _direct_count = 0
    """Photons in media, beside those of the map, that come straight from lights."""
    _shrinkage = 1.0
    """Radii over those of the first iteration."""

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where materials or the world have a volume."""
        return sizes.features.has_media

    def build(self, context: StageContext, photons: Photons, iteration: Iteration, volume: float, reach: float) -> None:
        """Sort the photons of an iteration; ``volume``: of the media, m^3; ``reach``: Media.reach."""
        self.photon_count = 0
        if not (self.is_on and context.materials.media.scatter):
            return
        with context.timers.stage("photon map of media"):
            slots = max(photons.slots, 1)
            self._numbers.require_items(slots)
            self._numbers.write(np.zeros(4, np.uint32))
            blocks = {**context.blocks, **photons.blocks, **self.blocks}
            self._list.run(slots, blocks, {"count": slots})
            counts = map(int, self._numbers.read(np.uint32, 3))
            self.photon_count, self._straight_count, self._direct_count = counts
            if not self.photon_count:
                return
            self._shrinkage = shrinkage_in(3, iteration.number, context.settings.alpha)
            self.radius = self._first_radius(volume, reach) * self._shrinkage
            buckets = self._buckets
            self._grid.require_items(buckets)
            self._grid.clear()
            self._sorted.require_items(self.photon_count)
            blocks = {**photons.blocks, **self.blocks}
            self._count.run(self.photon_count, blocks, self._cells)
            self._allocate.run(buckets, blocks, {"count": buckets})
            self._place.run(self.photon_count, blocks, self._cells)

    def gather(
        self,
        context: StageContext,
        importons: Importons,
        sums: SplatSums,
        band: Band,
        segment: int,
        beams_from: float | None,
    ) -> None:
        """Add the light that media scatter toward the camera along the rays of a segment, but for direct light.

        beams_from: mean free path, meters, from which beams bring that light to straight rays; None where they do not.
        """
        if not self.photon_count:
            return
        with context.timers.stage("gathering in media"):
            blocks = {**context.blocks, **importons.blocks, **self.blocks, **sums.blocks}
            for first in range(0, self.photon_count, _CANDIDATES):
                importons.active.run(
                    self._gather,
                    blocks,
                    {
                        "segment": segment,
                        "first_pixel": band.first_pixel,
                        "radius": self.radius,
                        "free_paths": _FREE_PATHS * self._shrinkage,
                        **self._cells,
                        "first_candidate": first,
                        "candidates": _CANDIDATES,
                        "straight_photons": self._straight_count,
                        "draws_beams": beams_from is not None,
                        "least_free_path": beams_from or 0.0,
                        **sums.parameters,
                    },
                )

    def count_pairs(self) -> int:
        """Return the pairs of a photon and a point of a ray of the iteration, where photons are counted. Waits for the
        device."""
        return int(self._grid.read(np.uint32, 4)[3]) if self.photon_count else 0

    def _first_radius(self, volume: float, reach: float) -> float:
        """Return the radius of the first iteration with as many photons, meters."""
        ball = _EXPECTED_PHOTONS * volume / self.photon_count
        return min(math.cbrt(3.0 * ball / (4.0 * math.pi)), _WIDEST * reach)

    @property
    def is_lit_by_specular_surfaces(self) -> bool:
        """True where specular surfaces let much of the light into media: photons alone bring it."""
        return self._straight_count > _MOST_STRAIGHT * (self._straight_count + self._direct_count)

    @property
    def _buckets(self) -> int:
        return max(_FEWEST_BUCKETS, 1 << (self.photon_count - 1).bit_length())

    @property
    def _cells(self) -> dict[str, float]:
        return {"buckets": self._buckets, "side": 2.0005 * _WIDEST_KERNEL * self.radius}

# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon beams: the ways of photons through thin media, drawn onto the camera's raster (Jarosz et al. 2011)."""

import numpy as np

from ...gl.buffer_sets import ComputeShader, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..camera_paths.importons import Importons
from ..common.band import MAX_RASTER_PIXELS
from ..common.iteration import Iteration
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes, band_pixels
from ..density_estimation.radii import shrinkage_in
from ..density_estimation.splat_sums import SUM_PARAMETERS, SplatSums
from ..density_estimation.stored_photons import CameraRaster
from ..device_scene.stage_context import StageContext
from ..photons.photons import Photons

PHOTON_BEAM = Record(
    "PhotonBeam",
    origin="vec3",
    extent="float",
    direction="vec3",
    photon="uint",
    flux="vec3",
    flags="uint",
    path="uint",
    depth="uint",
    bounce_counts="uint",
    light_group="uint",
    max_bounces="uint",
    unused0="uint",
    unused1="uint",
    unused2="uint",
)
"""The way of a photon through a medium, from ``origin`` to where it is scattered or leaves it, ``extent`` meters away:
a short beam, whose flux, W, is that at its origin. ``photon`` is the number of the photon at its end; the other members
are those of a Photon and of its PhotonOrigin."""
StorageBlock("PhotonBeams", "uint beam_count; PhotonBeam photon_beams[];")
BEAM_TARGET = Record(
    "BeamTarget",
    origin="vec3",
    mark="uint",
    direction="vec3",
    far="float",
    throughput="vec3",
    flags="uint",
    depth="uint",
    unused0="uint",
    unused1="uint",
    unused2="uint",
)
"""A camera ray through thin media up to the distance ``far``, meters. ``mark`` is the number of the segment, from 1 on,
in which it was written."""
StorageBlock("BeamTargets", "uint beam_target_count; uint beam_pair_count; BeamTarget beam_targets[];")
Record(
    "BeamTargetParameters",
    segment="uint",
    least_free_path="float",
)
Record(
    "BeamParameters",
    width="uint",
    height="uint",
    segment="uint",
    radius="float",
    radius_pixels="float",
    **SUM_PARAMETERS,
)

_DEPTH = 3.0
"""Optical depth of media, over the side of a cube as large as they are, up to which beams stand for their photons: in
denser ones points are better (docs/benchmarks/volumes.md)."""
_BEAMS_A_COLUMN = 64
"""Beams for each column of pixels of the picture. More would take more time than they save noise."""
_EXPECTED_BEAMS = 16
"""Beams that a camera ray is to meet in the first iteration."""
_FIRST_PIXELS, _FEWEST_PIXELS = 1.5, 0.6
"""Smallest radius in the first iteration and in all, pixels."""
_NEAR = 0.25
"""Distance from the camera, over the side of a cube as large as the media, below which beams get no narrower in the
first iteration. As wide as pixels, one that passes near the camera would be a bright streak."""
_SEGMENTS = 8
"""Segments of straight camera paths onto which beams are drawn."""


class PhotonBeams(Stage):
    """Photon beams of an iteration, and the camera rays that they add light to: those that have come straight from the
    camera. The other rays gather photons at points (photon_map.py)."""

    memory_group = "media"
    remedy = "lower the resolution or the photons per iteration"
    beams = StorageBuffer("photon beams", PHOTON_BEAM, header="uvec4", block="PhotonBeams")
    _targets = StorageBuffer(
        "targets of photon beams", BEAM_TARGET, band_pixels, header="uvec4", block="BeamTargets", zeroed=True
    )
    _find_targets = ComputeShader("media/beams/targets.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        if not self.is_on:
            return
        self._draw = library.draw("media/beams/quads.vert", "media/beams/splat.frag")
        rows = sizes.bands[0].rows
        self._view = self.own(context.moderngl.empty_framebuffer((min(sizes.width, MAX_RASTER_PIXELS), rows)))
        self._width = sizes.width
        self._mark = 0
        self._size = 0.0
        self.beam_count = 0
        """Beams of the iteration."""
        self.radius = self.radius_pixels = 0.0
        """Radius of the beams, meters, and the least one in pixels."""

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where materials or the world have a volume."""
        return sizes.features.has_media

    def clear(self, volume: float) -> None:
        """Forget the beams of the iteration before; ``volume``: of the media, m^3."""
        if not self.is_on:
            return
        self._size = volume ** (1.0 / 3.0)
        self.beams.require_items(1)
        self.beams.write(np.zeros(4, np.uint32))
        self._targets.write(np.zeros(4, np.uint32))

    @property
    def least_free_path(self) -> float:
        """Mean free path, meters, of the densest media in which beams stand for photons."""
        return self._size / _DEPTH

    def count_pairs(self) -> int:
        """Return the pairs of a beam and a ray of the iteration, where photons are counted. Waits for the device."""
        return int(self._targets.read(np.uint32, 2)[1]) if self.is_on else 0

    def probability(self, photon_count: int) -> float:
        """Return the probability with which the way of a photon becomes a beam."""
        return min(_BEAMS_A_COLUMN * self._width / max(photon_count, 1), 1.0)

    def prepare(self, context: StageContext, iteration: Iteration) -> None:
        """Choose the radius for the beams of an iteration."""
        if not (self.is_on and context.materials.media.scatter):
            return
        self.beam_count = int(self.beams.read(np.uint32, 1)[0])
        shrinkage = shrinkage_in(1, iteration.number, context.settings.alpha)
        self.radius_pixels = max(_FIRST_PIXELS * shrinkage, _FEWEST_PIXELS)
        camera = context.scene.camera
        pixel = (camera.window[1] - camera.window[0]) / camera.width
        nearest = 0.0 if camera.orthographic else _NEAR * self._size * shrinkage * pixel * self.radius_pixels
        self.radius = max(_EXPECTED_BEAMS * self._size / (2.0 * max(self.beam_count, 1)) * shrinkage, nearest)

    def splat(
        self,
        context: StageContext,
        photons: Photons,
        importons: Importons,
        sums: SplatSums,
        raster: CameraRaster | None,
        segment: int,
    ) -> None:
        """Add the light of the beams to the straight camera rays of a segment."""
        if not (self.is_on and context.materials.media.scatter and self.beam_count):
            return
        if raster is None or not self.draws(raster, segment):
            return
        with context.timers.stage("photon beams"):
            self._mark += 1
            self._targets.write(np.zeros(1, np.uint32))
            importons.active.run(
                self._find_targets,
                {**context.blocks, **importons.blocks, **self.blocks},
                {"segment": self._mark, "least_free_path": self.least_free_path},
            )
            if not int(self._targets.read(np.uint32, 1)[0]):
                return
            self._draw.draw(
                self._view,
                6 * self.beam_count,
                {**context.blocks, **photons.blocks, **self.blocks, **sums.blocks, "Camera": raster.camera},
                {
                    "width": raster.width,
                    "height": raster.rows,
                    "segment": self._mark,
                    "radius": self.radius,
                    "radius_pixels": self.radius_pixels,
                    **sums.parameters,
                },
                viewport=(0, 0, raster.width, raster.rows),
            )

    @staticmethod
    def draws(raster: CameraRaster | None, segment: int) -> bool:
        """Whether beams are drawn onto the straight rays of a segment, which then gather no points in thin media."""
        return raster is not None and segment < _SEGMENTS

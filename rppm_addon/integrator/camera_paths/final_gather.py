# SPDX-License-Identifier: GPL-3.0-or-later
"""Final gather: the radiance that arrives along one ray at the first surface of a camera path that stores photons.

Neighboring pixels reuse each other's rays within a few Eq. 3 radii, which shrink by Eq. 2 and so keep the estimate
consistent. After Jensen, Realistic Image Synthesis Using Photon Mapping (2001), section 9.2, and Bekaert, Sbert and
Halton, Accelerating Path Tracing by Re-Using Paths (2002).
"""

import math

import moderngl

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.buffers import GrowingBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..common.band import Band
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes, band_pixels
from ..density_estimation.radii import Radii
from ..density_estimation.splat_sums import SplatSums
from ..device_scene.stage_context import StageContext

FINAL_GATHER_ORIGIN = Record(
    "FinalGatherOrigin",
    position="vec3",
    reuse_radius="float",
    weight="vec3",
    normal="uint",
)
"""The vertex of a camera path from which the ray of its final gather leaves.

- ``position`` is that of the last vertex that scattered the path; with the final gather, it stays.
- ``reuse_radius``, meters: the footprint of Eq. 4, or 0 where neighboring pixels do not reuse the ray because a rough
  lobe sampled it. It is NO_FINAL_GATHER until a final gather begins, which gives the members below a value.
- ``weight`` is the throughput at the origin times BSDF and cosine over the pdf of the ray's direction: a pixel gets the
  radiance that arrives along the ray times this.
- ``normal`` is on the side of the surface from which the ray leaves (packed)."""
FINAL_GATHER_HIT = Record(
    "FinalGatherHit",
    position="vec3",
    normal="uint",
    radiance="vec3",
)
"""The end of the ray of a final gather, by which neighboring pixels reuse it; only those with a FinalGatherOrigin
have one.

- ``position`` is that of the first surface with a lobe that stores photons; where the ray met none, it is a point in
  the ray's direction that is far away from all neighbors.
- ``normal`` is on the side of the surface that the ray hit (packed).
- ``radiance`` is that of the environment and of media, W/(m^2 sr), which arrives at the origin along the ray. It has
  the MIS weight of the ray beside photons and shadow rays. Radiance that is not to be reused goes to the pixel at once.
"""
NO_FINAL_GATHER = -1.0
"""Reuse radius of a path without a final gather."""
Constants("FinalGather", NO_FINAL_GATHER=NO_FINAL_GATHER)
StorageBlock("FinalGatherOrigins", "FinalGatherOrigin final_gather_origins[];")
StorageBlock("FinalGatherHits", "FinalGatherHit final_gather_hits[];")
StorageBlock("GatherRadiances", "vec4 gather_radiances[];")

Record("CollectParameters", count="uint", quantum="float")
Record(
    "ReuseParameters",
    count="uint",
    width="uint",
    first_pixel="uint",
    taps="uint",
    radius_in_pixels="float",
    reuse_radius="float",
)

_MAX_TAPS = 48
"""Maximum number of neighbors whose rays a pixel reuses."""
REUSE_RADIUS = 5.0
"""Radius of reuse, in Eq. 3 radii: indirect light varies more slowly than caustics."""


class FinalGather(Stage):
    """The origins and hits of a band's final gather, and the radiance that arrives along its rays."""

    memory_group = "final gather"
    remedy = "lower the resolution"
    origins = StorageBuffer("final gather origins", FINAL_GATHER_ORIGIN, band_pixels, block="FinalGatherOrigins")
    hits = StorageBuffer("final gather hits", FINAL_GATHER_HIT, band_pixels, block="FinalGatherHits")
    radiances = StorageBuffer("final gather radiance", "vec4", band_pixels, block="GatherRadiances")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._collect_program = library.compute("camera_paths/final_gather/collect.comp")
        self._reuse_program = library.compute("camera_paths/final_gather/reuse.comp")

    def clear(self) -> None:
        """Forget the radiance of the band before."""
        self.radiances.clear()

    def add(
        self,
        context: StageContext,
        sums: SplatSums,
        radiances: GrowingBuffer,
        band: Band,
        radii: Radii,
    ) -> None:
        """Add the final gather to the ``radiances`` of pixels: each reuses its own ray and those of its neighbors.

        Nothing is done where the settings have no final gather.
        """
        if not context.gathers:
            return
        with context.timers.stage("final gather"):
            self._collect_program.run(
                band.pixel_count,
                {**sums.blocks, **self.blocks},
                {"count": band.pixel_count, "quantum": sums.quantum},
            )
            self.reuse(context, self.radiances.buffer, radiances.buffer, band, radii)

    def reuse(
        self, context: StageContext, gathered: moderngl.Buffer, radiances: moderngl.Buffer, band: Band, radii: Radii
    ) -> None:
        """Add radiance that arrived along the rays (``gathered``, vec4 each), or a part of it, to the ``radiances``
        (vec4) of the pixels that reuse the rays.

        Pictures that are denoised do without the neighbors' rays: what pixels have in common passes for light there.
        """
        radius = 0.0 if context.settings.use_denoising else REUSE_RADIUS * radii.in_pixels
        self._reuse_program.run(
            band.pixel_count,
            {**context.blocks, **self.blocks, "GatherRadiances": gathered, "Radiances": radiances},
            {
                "count": band.pixel_count,
                "width": band.columns,
                "first_pixel": band.first_pixel,
                "taps": min(_MAX_TAPS, math.ceil(math.pi * radius**2)) if radius >= 0.5 else 0,
                "radius_in_pixels": radius,
                "reuse_radius": REUSE_RADIUS,
            },
        )

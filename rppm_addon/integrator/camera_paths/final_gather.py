# SPDX-License-Identifier: GPL-3.0-or-later
"""Final gather: what camera paths find along one ray from the first surface that stores photons.

Neighboring pixels share what their rays found within a few Eq. 3 radii, which shrink by Eq. 2 and so keep the estimate
consistent. After Jensen, Realistic Image Synthesis Using Photon Mapping (2001), section 9.2, and Bekaert, Sbert and
Halton, Accelerating Path Tracing by Re-Using Paths (2002).
"""

import math

import moderngl

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.buffers import GrowingBuffer
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

GATHERING_VERTEX = Record(
    "GatheringVertex",
    position="vec3",
    shared_radius="float",
    weight="vec3",
    normal="uint",
    found="vec3",
    radius="float",
    hit="vec3",
    hit_normal="uint",
)
"""Where a camera path set out to gather, with its BSDF and throughput over the ray's density, sr. ``radius`` is
the importon's, meters, and so is ``shared_radius``, but for 0 where what the ray finds is not shared; less than 0
marks none. ``normal`` is on the side that the ray went to, ``found`` the radiance of the world that the ray came to by
sharp surfaces, but for the photons' share, at once, if the world is even, or from a second such vertex, of which
``radius`` then is. ``hit`` is where the ray arrived at a surface that stores photons, ``hit_normal`` on its side; where
it came to none, far behind all. Before the path gathers, ``position`` is where it was scattered last."""
StorageBlock("GatheringVertices", "GatheringVertex gathering_vertices[];")
StorageBlock("GatherRadiances", "vec4 gather_radiances[];")


Record("FoundParameters", count="uint", quantum="float")
Record(
    "ShareParameters",
    count="uint",
    width="uint",
    first_pixel="uint",
    taps="uint",
    radius_in_pixels="float",
    shared_radius="float",
)

_MOST_TAPS = 48
"""Neighbors that a pixel looks at."""
SHARED_RADIUS = 5.0
"""Times the Eq. 3 radius: indirect light varies more slowly than caustics."""


class FinalGather(Stage):
    """Where the paths of a band set out to gather, and what they found."""

    memory_group = "final gather"
    remedy = "lower the resolution"
    vertices = StorageBuffer("gathering vertices", GATHERING_VERTEX, band_pixels, block="GatheringVertices")
    radiances = StorageBuffer("found radiance", "vec4", band_pixels, block="GatherRadiances")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._found_program = library.compute("camera_paths/final_gather/found.comp")
        self._share_program = library.compute("camera_paths/final_gather/share.comp")

    def clear(self) -> None:
        """Forget what the band before found."""
        self.radiances.clear()

    def share(
        self,
        context: StageContext,
        sums: SplatSums,
        radiances: GrowingBuffer,
        band: Band,
        radii: Radii,
    ) -> None:
        """Add what the gathering rays found to the ``radiances`` of the pixels that they left from and of those around.

        Nothing is done where the settings have no final gather.
        """
        if not context.gathers:
            return
        with context.timers.stage("final gather"):
            self._found_program.run(
                band.pixel_count,
                {**sums.blocks, **self.blocks},
                {"count": band.pixel_count, "quantum": sums.quantum},
            )
            self.share_found(context, self.radiances.buffer, radiances.buffer, band, radii)

    def share_found(
        self, context: StageContext, found: moderngl.Buffer, radiances: moderngl.Buffer, band: Band, radii: Radii
    ) -> None:
        """Add what gathering rays found (vec4 each), or a part of that, to the ``radiances`` (vec4) of those pixels."""
        radius = SHARED_RADIUS * radii.in_pixels
        self._share_program.run(
            band.pixel_count,
            {**context.blocks, **self.blocks, "GatherRadiances": found, "Radiances": radiances},
            {
                "count": band.pixel_count,
                "width": band.columns,
                "first_pixel": band.first_pixel,
                "taps": min(_MOST_TAPS, math.ceil(math.pi * radius**2)) if radius >= 0.5 else 0,
                "radius_in_pixels": radius,
                "shared_radius": SHARED_RADIUS,
            },
        )

# SPDX-License-Identifier: GPL-3.0-or-later
"""Final gather: what camera paths find along one ray from the first surface that stores photons.

Neighbouring pixels share what their rays found: the mean over a disk of a few Eq. 3 radii, which shrinks by Eq. 2 and
so keeps the estimate consistent. After Jensen, Realistic Image Synthesis Using Photon Mapping (2001), section 9.2.
"""

import math

import moderngl

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from .records import GATHERING_VERTEX
from .splat_sums import SplatSums

Record("FoundParameters", count="uint", quantum="float")
Record(
    "ShareParameters",
    count="uint",
    width="uint",
    first_pixel="uint",
    taps="uint",
    radius_in_pixels="float",
    shared_radius="float",
    seed="uint",
    iteration="uint",
)

_MOST_TAPS = 32
"""Neighbours that a pixel looks at."""
SHARED_RADIUS = 6.0
"""Times the Eq. 3 radius: indirect light varies more slowly than caustics."""


class FinalGather:
    """Where the paths of a band set out to gather, and what they found."""

    def __init__(self, context: Context, library: ProgramLibrary, pixels: int) -> None:
        self._found_program = library.compute("final_gather/found.comp")
        self._share_program = library.compute("final_gather/share.comp")
        remedy = "lower the resolution"
        self.vertices = GrowingBuffer(context, "gathering vertices", remedy)
        self.radiances = GrowingBuffer(context, "found radiance", remedy)
        self.vertices.require(GATHERING_VERTEX.size * pixels)
        self.radiances.require(16 * pixels)

    @property
    def memory_bytes(self) -> dict[str, int]:
        return {buffer.name: buffer.size for buffer in (self.vertices, self.radiances)}

    def begin(self) -> None:
        """Forget what the band before found."""
        self.radiances.clear()

    def run(
        self,
        sums: SplatSums,
        radiances: moderngl.Buffer,
        count: int,
        width: int,
        first_pixel: int,
        radius_in_pixels: float,
        seed: int,
        iteration: int,
    ) -> None:
        """Add what was found to the pixels' ``radiances``; ``radius_in_pixels`` is the iteration's of Eq. 3."""
        self._found_program.run(
            count,
            {
                "SplatSums": sums.buffer,
                "FoundRadiances": self.radiances.buffer,
                "GatheringVertices": self.vertices.buffer,
            },
            {"count": count, "quantum": sums.quantum},
        )
        radius = SHARED_RADIUS * radius_in_pixels
        self._share_program.run(
            count,
            {
                "GatheringVertices": self.vertices.buffer,
                "FoundRadiances": self.radiances.buffer,
                "Radiances": radiances,
            },
            {
                "count": count,
                "width": width,
                "first_pixel": first_pixel,
                "taps": min(_MOST_TAPS, math.ceil(math.pi * radius**2)) if radius >= 0.5 else 0,
                "radius_in_pixels": radius,
                "shared_radius": SHARED_RADIUS,
                "seed": seed,
                "iteration": iteration,
            },
        )

    def release(self) -> None:
        self.vertices.release()
        self.radiances.release()

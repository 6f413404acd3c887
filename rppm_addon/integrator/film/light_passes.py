# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes that split the light of a picture by how the first surface scatters it, and by caustics.

Whatever is added to Combined is also added to one of these passes, so that together they equal it. The film adds
emission at the vertices of camera paths (shaders/film/path_emission.comp).
"""

import enum

import moderngl

from ...gl.buffer_sets import ComputeShader, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.settings import DirectLight as DirectLightMode
from ..camera_paths.final_gather import FinalGather
from ..common.band import Band
from ..common.stage_sizes import StageSizes, band_pixels
from ..density_estimation.splat_sums import LightSum
from .events import BandEvents, Listener
from .film import pass_bits

Record(
    "LightPassParameters",
    segment="uint",
    pixels="uint",
    passes="uint",
    count="uint",
    scattered="uint",
    caustics="uint",
    light_sums="uint",
    part="uint",
    in_media="uint",
    quantum="float",
)
StorageBlock("GatheredCaustics", "vec4 gathered_caustics[];")


class GatherPart(enum.IntEnum):
    """Parts of the radiance that arrives along the rays of the final gather."""

    ALL = 0
    DIRECT = 1
    CAUSTICS = 2


Constants("GatherParts", GATHER_PART=GatherPart)


def _scattered_pixels(sizes: StageSizes) -> int:
    return band_pixels(sizes) if sizes.has_scattered_light else 0


def _caustic_pixels(sizes: StageSizes) -> int:
    return band_pixels(sizes) if sizes.has_caustics else 0


class LightPasses(Listener):
    """Adds to the film's passes what shadow rays, gathering rays and photons add to a band's radiance."""

    memory_group = "passes"
    remedy = "lower the resolution"
    _gathered_direct = StorageBuffer("gathered direct light", "vec4", _scattered_pixels, block="GatheredDirect")
    _gathered_caustics = StorageBuffer("gathered caustics", "vec4", _caustic_pixels, block="GatheredCaustics")
    _reused = StorageBuffer("reused light of passes", "vec4", band_pixels)
    _add_direct = ComputeShader("film/light_passes/direct.comp")
    _collect = ComputeShader("film/light_passes/collect.comp")
    _add_gathered = ComputeShader("film/light_passes/gathered.comp")
    _add_photons = ComputeShader("film/light_passes/photons.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._passes = pass_bits(sizes)
        self._kept = LightSum.of(sizes) & ~LightSum.GROUPS

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where passes show scattered light or caustics."""
        return sizes.has_scattered_light or sizes.has_caustics

    def clear(self) -> None:
        """Clear what the previous band has left."""
        if LightSum.CAUSTICS in self._kept:
            self._gathered_caustics.clear()

    def medium_light_added(self, events: BandEvents, segment: int) -> None:
        """Listener.medium_light_added: add the contributions of shadow rays from media."""
        if events.iteration.enters_film:
            self._add_contributions(events, segment, in_media=True)

    def direct_light_added(self, events: BandEvents, segment: int) -> None:
        """Listener.direct_light_added: add the contributions of shadow rays."""
        by_rays = events.context.settings.direct_light is DirectLightMode.RAYS
        if events.iteration.enters_film and by_rays:
            self._add_contributions(events, segment, in_media=False)

    def _add_contributions(self, events: BandEvents, segment: int, in_media: bool) -> None:
        context, direct_light, band = events.context, events.direct_light, events.band
        with context.timers.stage("light passes"):
            direct_light.active_rays.run(
                self._add_direct,
                {**context.blocks, **events.importons.blocks, **direct_light.blocks, **self.blocks},
                self._parameters(band, segment) | {"in_media": in_media},
            )

    def band_ended(self, events: BandEvents) -> None:
        """Listener.band_ended: add the light of the final gather and of photons."""
        context, band, sums, final_gather = events.context, events.band, events.sums, events.final_gather
        with context.timers.stage("light passes"):
            parameters = self._parameters(band) | {"quantum": sums.quantum}
            blocks = {**context.blocks, **events.importons.blocks, **self.blocks}
            self._add_photons.run(band.pixel_count, blocks, parameters)
            if not context.gathers:
                return
            self._collect.run(band.pixel_count, blocks, parameters)
            for part, radiances in self._parts(final_gather).items():
                self._reused.clear()
                final_gather.reuse(context, radiances, self._reused.buffer, band, events.radii)
                self._add_gathered.run(
                    band.pixel_count, {**blocks, "Radiances": self._reused.buffer}, parameters | {"part": int(part)}
                )

    def _parts(self, final_gather: FinalGather) -> dict[GatherPart, moderngl.Buffer]:
        """Return the buffers of the radiance that neighboring pixels reuse, by part."""
        parts: dict[GatherPart, moderngl.Buffer] = {}
        if LightSum.SCATTERED in self._kept:
            parts |= {GatherPart.ALL: final_gather.radiances.buffer, GatherPart.DIRECT: self._gathered_direct.buffer}
        if LightSum.CAUSTICS in self._kept:
            parts[GatherPart.CAUSTICS] = self._gathered_caustics.buffer
        return parts

    def _parameters(self, band: Band, segment: int = 0) -> dict[str, float]:
        return {
            "pixels": band.pixel_count,
            "passes": self._passes,
            "segment": segment,
            "count": band.pixel_count,
            "scattered": LightSum.SCATTERED in self._kept,
            "caustics": LightSum.CAUSTICS in self._kept,
            "light_sums": int(self._kept),
            "part": int(GatherPart.ALL),
            "in_media": False,
            "quantum": 0.0,
        }

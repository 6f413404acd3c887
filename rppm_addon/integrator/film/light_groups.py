# SPDX-License-Identifier: GPL-3.0-or-later
"""Light groups: the light of some lights, objects or the world as a picture of its own.

Whatever is added to Combined is also added to the group of its light source, so that the groups and the light of
sources without a group add up to it.
"""

from ...gl.buffer_sets import ComputeShader, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.settings import DirectLight as DirectLightMode
from ..common.stage_sizes import StageSizes, band_pixels
from .events import BandEvents, Listener

Record(
    "LightGroupParameters",
    groups="uint",
    group="uint",
    count="uint",
    quantum="float",
)
Record("LightObjectParameters", groups="uint")
StorageBlock("GroupedLight", "float grouped_light[];")
StorageBlock("RadianceBefore", "vec4 radiance_before[];")

_CHANNELS = 3
_KINDS_OF_LIGHT = 2
"""Kinds of light of a group: light of the pixel itself, and light along the ray of its final gather
(shaders/film/light_groups/grouped.glsl)."""


def _grouped_values(sizes: StageSizes) -> int:
    return _CHANNELS * _KINDS_OF_LIGHT * len(sizes.light_groups) * band_pixels(sizes)


class LightGroups(Listener):
    """Sums the light of each group in a band and adds it to the film's passes."""

    memory_group = "passes"
    remedy = "lower the resolution or have fewer light groups"
    _grouped = StorageBuffer("light of groups", "float", _grouped_values, block="GroupedLight")
    _radiance_before = StorageBuffer("radiance before emission", "vec4", band_pixels, block="RadianceBefore")
    _gathered = StorageBuffer("gathered light of a group", "vec4", band_pixels)
    _reused = StorageBuffer("reused light of a group", "vec4", band_pixels)
    _add_direct = ComputeShader("film/light_groups/direct.comp")
    _add_light_objects = ComputeShader("film/light_groups/light_objects.comp")
    _add_emission = ComputeShader("film/light_groups/emission.comp")
    _collect = ComputeShader("film/light_groups/collect.comp")
    _accumulate = ComputeShader("film/light_groups/accumulate.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._groups = len(sizes.light_groups)

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where light groups have passes."""
        return bool(sizes.light_groups)

    def clear(self) -> None:
        """Clear what the previous band has left."""
        if self.is_on:
            self._grouped.clear()

    def medium_light_added(self, events: BandEvents, segment: int) -> None:
        """Listener.medium_light_added: add the contributions of shadow rays from media."""
        if not events.iteration.enters_film:
            return
        with events.context.timers.stage("light groups"):
            self._add_contributions(events)

    def direct_light_added(self, events: BandEvents, segment: int) -> None:
        """Listener.direct_light_added: add the contributions of shadow rays, and of light objects along the rays."""
        if not events.iteration.enters_film:
            return
        context, importons = events.context, events.importons
        with context.timers.stage("light groups"):
            if context.settings.direct_light is DirectLightMode.RAYS:
                self._add_contributions(events)
            importons.active.run(
                self._add_light_objects,
                {**context.blocks, **importons.blocks, **self.blocks},
                {"groups": self._groups},
            )

    def _add_contributions(self, events: BandEvents) -> None:
        direct_light = events.direct_light
        direct_light.active_rays.run(
            self._add_direct, {**events.context.blocks, **direct_light.blocks, **self.blocks}, self._parameters()
        )

    def paths_scattered(self, events: BandEvents, segment: int) -> None:
        """Listener.paths_scattered: add the emission of surfaces and of the world."""
        if not events.iteration.enters_film:
            return
        with events.context.timers.stage("light groups"):
            events.importons.active.run(
                self._add_emission,
                {**events.context.blocks, **events.importons.blocks, **self.blocks},
                self._parameters(),
            )

    def band_ended(self, events: BandEvents) -> None:
        """Listener.band_ended: add the band's estimate to the film's passes, with what photons and gathering rays
        bring."""
        context, band, sums, final_gather = events.context, events.band, events.sums, events.final_gather
        with context.timers.stage("light groups"):
            light = {**context.blocks, **self.blocks}
            for group in range(self._groups):
                parameters = self._parameters() | {
                    "group": group,
                    "count": band.pixel_count,
                    "quantum": sums.quantum,
                }
                self._reused.clear()
                if context.gathers:
                    blocks = {**light, "GatherRadiances": self._gathered.buffer}
                    self._collect.run(band.pixel_count, blocks, parameters)
                    final_gather.reuse(context, self._gathered.buffer, self._reused.buffer, band, events.radii)
                self._accumulate.run(
                    band.pixel_count,
                    {**light, "Radiances": self._reused.buffer},
                    parameters,
                )

    def _parameters(self) -> dict[str, float]:
        return {
            "groups": self._groups,
            "group": 0,
            "count": 0,
            "quantum": 0.0,
        }

# SPDX-License-Identifier: GPL-3.0-or-later
"""Light groups: the light of some lights, objects or the world as a picture of its own.

Whatever adds to Combined adds the same to the group of the light that it comes from, so that all groups and what is in
none add up to it.
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
Record("PassedLightParameters", groups="uint")
StorageBlock("GroupedLight", "float grouped_light[];")
StorageBlock("SeenLight", "vec4 seen_light[];")

_CHANNELS = 3
_KINDS_OF_LIGHT = 2
"""Number of kinds of light of a group: light that a pixel has received, and light that its gathering ray has found
(shaders/film/light_groups/grouped.glsl)."""


def _grouped_values(sizes: StageSizes) -> int:
    return _CHANNELS * _KINDS_OF_LIGHT * len(sizes.light_groups) * band_pixels(sizes)


class LightGroups(Listener):
    """Finds the light of each group in a band and adds it to the film's passes."""

    memory_group = "passes"
    remedy = "lower the resolution or have fewer light groups"
    _grouped = StorageBuffer("light of groups", "float", _grouped_values, block="GroupedLight")
    _seen = StorageBuffer("seen light of groups", "vec4", band_pixels, block="SeenLight")
    _found = StorageBuffer("found light of a group", "vec4", band_pixels)
    _taken = StorageBuffer("gathered light of a group", "vec4", band_pixels)
    _add_direct = ComputeShader("film/light_groups/direct.comp")
    _add_passed = ComputeShader("film/light_groups/passed.comp")
    _add_seen = ComputeShader("film/light_groups/seen.comp")
    _take_found = ComputeShader("film/light_groups/found.comp")
    _accumulate = ComputeShader("film/light_groups/accumulate.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._groups = len(sizes.light_groups)

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where light groups have passes."""
        return bool(sizes.light_groups)

    def clear(self) -> None:
        """Forget what the band before found."""
        if self.is_on:
            self._grouped.clear()

    def direct_light_found(self, events: BandEvents, segment: int) -> None:
        """Listener.direct_light_found: add what DirectLight.add has added, and light objects that the paths pass."""
        if not events.iteration.enters_film:
            return
        context, importons, direct_light = events.context, events.importons, events.direct_light
        with context.timers.stage("light groups"):
            if context.settings.direct_light is DirectLightMode.RAYS:
                direct_light.active_rays.run(
                    self._add_direct,
                    {**context.blocks, **direct_light.blocks, **self.blocks},
                    self._parameters(),
                )
            importons.active.run(
                self._add_passed,
                {**context.blocks, **importons.blocks, **self.blocks},
                {"groups": self._groups},
            )

    def paths_scattered(self, events: BandEvents, segment: int) -> None:
        """Listener.paths_scattered: add what else the paths have met."""
        if not events.iteration.enters_film:
            return
        with events.context.timers.stage("light groups"):
            events.importons.active.run(
                self._add_seen,
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
                self._taken.clear()
                if context.gathers:
                    found = {**light, "GatherRadiances": self._found.buffer}
                    self._take_found.run(band.pixel_count, found, parameters)
                    final_gather.reuse(context, self._found.buffer, self._taken.buffer, band, events.radii)
                self._accumulate.run(
                    band.pixel_count,
                    {**light, "Radiances": self._taken.buffer},
                    parameters,
                )

    def _parameters(self) -> dict[str, float]:
        return {
            "groups": self._groups,
            "group": 0,
            "count": 0,
            "quantum": 0.0,
        }

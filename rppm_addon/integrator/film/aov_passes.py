# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of AOV Output nodes: means over the iterations of what the nodes write."""

from collections.abc import Mapping

import numpy as np

from ...gl.buffer_sets import BufferSet, ComputeShader
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..camera_paths.importons import Importons
from ..common.band import Band
from ..common.film_buffers import FilmBuffer
from ..common.stage_sizes import StageSizes, aov_channels
from ..device_scene.stage_context import StageContext

Record("AovParameters", count="uint")


class AovPasses(BufferSet):
    """Channels of all AOV passes, 4 bytes each for every pixel of the film."""

    remedy = "lower the resolution"
    _values = FilmBuffer("AOVs", "float", aov_channels)
    _accumulate = ComputeShader("film/aovs.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._channels = aov_channels(sizes)
        self._passes = tuple(entry for entry in sizes.passes if entry.is_aov)

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """BufferSet.is_needed: for passes of AOV Output nodes."""
        return aov_channels(sizes) > 0

    def add(self, context: StageContext, importons: Importons, band: Band) -> None:
        """Add what AOV Output nodes have written in an iteration to the means of a band."""
        if not self.is_on:
            return
        count = band.pixel_count * self._channels
        blocks = {**context.blocks, **importons.blocks, "FilmAovs": self._values.of(band)}
        self._accumulate.run(count, blocks, {"count": count})

    def read(self) -> dict[str, np.ndarray]:
        """Return the passes by name, (height, width) or (height, width, channels) float32."""
        values = self._values.read(np.float32, self._channels)
        ends = np.cumsum([0, *(len(entry.channels) for entry in self._passes)])
        parts = {entry.name: values[..., a:b].copy() for entry, a, b in zip(self._passes, ends, ends[1:])}
        return {name: part[..., 0] if part.shape[-1] == 1 else part for name, part in parts.items()}

    def restore(self, passes: Mapping[str, np.ndarray]) -> None:
        """Take what ``read`` gave; KeyError where a pass misses."""
        if self.is_on:
            planes = [np.atleast_3d(np.asarray(passes[entry.name], np.float32)) for entry in self._passes]
            self._values.upload(np.concatenate(planes, axis=-1))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples of an iteration's pixels, which separate the noise of photons from the rest (common/photon_counts.py)."""

import math

import numpy as np

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..common.stage_sizes import StageSizes
from .events import BandEvents, Listener

Record(
    "PhotonNoiseParameters",
    count="uint",
    width="uint",
    columns="uint",
    first_row="uint",
    step="uint",
    gathers="uint",
    quantum="float",
)
StorageBlock("NoiseSamples", "vec4 noise_samples[];")

_MAX_SAMPLES = 1 << 16


def sample_step(width: int, height: int) -> int:
    """Return the step between the rows, and between the columns, of a film that have samples."""
    return math.ceil(math.sqrt(width * height / _MAX_SAMPLES))


def _samples(sizes: StageSizes) -> int:
    step = sample_step(sizes.width, sizes.height)
    return math.ceil(sizes.width / step) * math.ceil(sizes.bands[0].rows / step)


class PhotonNoise(Listener):
    """Reads samples of bands, and counts the vertices of camera paths, in iterations that weigh noise."""

    memory_group = "passes"
    remedy = "lower the resolution"
    _samples = StorageBuffer("samples of noise", "vec4", _samples, block="NoiseSamples")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._split = library.compute("film/photon_noise/split.comp")
        self._join = library.compute("film/photon_noise/join.comp")
        self.step = sample_step(sizes.width, sizes.height)
        self.shape = math.ceil(sizes.height / self.step), math.ceil(sizes.width / self.step)
        """Rows and columns of the samples of all bands."""
        self.vertices = 0
        """Vertices of the iteration's camera paths so far."""

    def begin(self) -> None:
        """Forget the iteration before."""
        self.vertices = 0

    def direct_light_added(self, events: BandEvents, segment: int) -> None:
        """Listener.direct_light_added: count the vertices of a segment of camera paths. Waits for the device in
        iterations that weigh noise."""
        if events.iteration.weighs_noise:
            self.vertices += events.importons.active.read_count()

    def sample(self, events: BandEvents) -> np.ndarray:
        """(rows, columns, 4) float32 luminances of a band's samples, with the film's exposure, for NoiseSamples.of.

        To be asked for when nothing needs the band's radiances any more. Waits for the device.
        """
        context, importons, gather = events.context, events.importons, events.final_gather
        sums, band = events.sums, events.band
        first_row = -band.first_row % self.step
        rows, columns = max(math.ceil((band.rows - first_row) / self.step), 0), math.ceil(band.columns / self.step)
        parameters = {
            "width": band.columns,
            "columns": columns,
            "first_row": first_row,
            "step": self.step,
            "gathers": context.gathers,
            "quantum": sums.quantum,
        }
        with context.timers.stage("learning"):
            self._split.run(
                band.pixel_count,
                {**context.blocks, **importons.blocks, **self.blocks},
                {**parameters, "count": band.pixel_count},
            )
            if context.gathers:
                gather.reuse(context, gather.radiances.buffer, importons.radiances.buffer, band, events.radii)
            self._join.run(
                rows * columns,
                {**importons.blocks, **self.blocks},
                {**parameters, "count": rows * columns},
            )
            found = self._samples.read(np.float32, 4 * rows * columns).reshape(rows, columns, 4)
            return found * np.float32(context.scene.exposure)

# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectPhotonHits and TracePhotons: photons from the lights through the scene."""

import moderngl
import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from .first_hits import FirstHits
from .living_paths import LivingPaths
from .records import (
    CLOSURE,
    DEPARTURE,
    FLUX_GROUP,
    FLUX_NAMES,
    FLUX_SUMS,
    HIT,
    PHOTON,
    PHOTON_PATH,
    RAY,
)
from .stages import Stages

Record(
    "ScatterPhotonsParameters",
    photon_count="uint",
    segment="uint",
    segments="uint",
    seed="uint",
    iteration="uint",
    specular_alpha="float",
    looks_back="uint",
)
Record("DepartParameters", photon_count="uint", segment="uint")
Record("BalanceParameters", photon_count="uint", segments="uint")


class Photons:
    """The photon buffer of one iteration: ``photons`` at index segment * photon_count + path; ``world_radiances`` tells
    of each path the world's radiance where it began, the largest channel, 0 from other lights."""

    def __init__(self, context: Context, library: ProgramLibrary, photon_count: int, segments: int) -> None:
        """photon_count: the most that an iteration has."""
        self._context = context
        self._scatter = library.compute("photons/scatter.comp")
        self._depart = library.compute("photons/depart.comp")
        self._balance = library.compute("photons/balance.comp")
        self.photon_count, self.segments = photon_count, segments
        remedy = "lower the photons per iteration or the photon path length"
        self.photons = GrowingBuffer(context, "photons", remedy)
        self._paths = GrowingBuffer(context, "photon paths", remedy)
        self._rays = GrowingBuffer(context, "photon rays", remedy)
        self._hits = GrowingBuffer(context, "photon hits", remedy)
        self._closures = GrowingBuffer(context, "photon closures", remedy)
        self._departures = GrowingBuffer(context, "photon departures", remedy)
        self.world_radiances = GrowingBuffer(context, "world radiances", remedy)
        self.world_radiances.require(4 * photon_count)
        self._emitted = GrowingBuffer(context, "emitted photons", remedy)
        self._sums = GrowingBuffer(context, "flux sums", remedy)
        self._living = LivingPaths(context, library, "living photon paths", remedy)
        self.first_hits = FirstHits(context, library)
        self.photons.require(PHOTON.size * photon_count * segments)
        for buffer, record in (
            (self._paths, PHOTON_PATH),
            (self._rays, RAY),
            (self._hits, HIT),
            (self._closures, CLOSURE),
            (self._departures, DEPARTURE),
            (self._emitted, PHOTON_PATH),
        ):
            buffer.require(record.size * photon_count)
        self._living.require(photon_count, to_keep=True)
        self._sums.require(FLUX_SUMS.size * -(-photon_count // FLUX_GROUP))

    @property
    def _buffers(self) -> tuple[GrowingBuffer, ...]:
        paths = self._paths, self._rays, self._hits, self._closures, self._departures
        return self.photons, *paths, self._emitted, self._sums, self.world_radiances

    @property
    def _blocks(self) -> dict[str, moderngl.Buffer]:
        """Storage blocks of the programs that send photons on."""
        return {
            "Closures": self._closures.buffer,
            "Rays": self._rays.buffer,
            "PhotonPaths": self._paths.buffer,
            "Photons": self.photons.buffer,
            "Departures": self._departures.buffer,
        }

    @property
    def memory_bytes(self) -> dict[str, int]:
        buffers = {buffer.name: buffer.size for buffer in self._buffers}
        return buffers | self._living.memory_bytes | self.first_hits.memory_bytes

    def run(self, stages: Stages, iteration: int, photon_count: int) -> None:
        """Emit the iteration's photons and trace them to the last segment, or to that after which none lives."""
        self.photon_count = photon_count
        settings, timers = stages.settings, stages.timers
        for segment in range(self.segments):
            if segment == 0:
                self._emit(stages, iteration)
                self._context.moderngl.copy_buffer(self._emitted.buffer, self._paths.buffer)
            else:
                with timers.stage("photon tracing"):
                    self._living.keep(self._rays.buffer)
                    if self._living.known_empty:
                        return
                    stages.deep_cubemap.trace(self._rays.buffer, self._hits.buffer, self._living)
            with timers.stage("photon resolve"):
                self._resolve(stages, iteration, segment, looks_back=False)
            # Nothing goes on from the last segment's hits.
            looks_back = stages.materials.any_depends_on_view and segment < self.segments - 1
            with timers.stage("photon scattering"):
                self._living.run(
                    self._scatter,
                    {**self._blocks, "Materials": stages.materials.buffers["Materials"]},
                    {
                        "photon_count": self.photon_count,
                        "segment": segment,
                        "segments": self.segments,
                        "seed": settings.seed,
                        "iteration": iteration,
                        "specular_alpha": settings.specular_roughness**2,
                        "looks_back": looks_back,
                    },
                )
            if looks_back:
                self._look_back(stages, iteration, segment)

    def _resolve(self, stages: Stages, iteration: int, segment: int, looks_back: bool) -> None:
        stages.resolve.run(
            self._rays.buffer,
            self._hits.buffer,
            self._closures.buffer,
            self._living,
            iteration,
            segment,
            photon_paths=self._paths.buffer,
            looks_back=looks_back,
        )

    def _look_back(self, stages: Stages, iteration: int, segment: int) -> None:
        """Photons get the flux that a viewer would see from where they go."""
        with stages.timers.stage("photon resolve"):
            self._resolve(stages, iteration, segment, looks_back=True)
        with stages.timers.stage("photon scattering"):
            parameters = {"photon_count": self.photon_count, "segment": segment}
            self._living.run(self._depart, self._blocks, parameters)

    def _emit(self, stages: Stages, iteration: int) -> None:
        """DirectPhotonHits: photons leave the lights and find their first hits."""
        rays, hits, paths = self._rays.buffer, self._hits.buffer, self._paths.buffer
        with stages.timers.stage("emission"):
            self._living.fill(self.photon_count)
            stages.emission.run(
                rays, paths, self.world_radiances.buffer, self.photon_count, stages.settings.seed, iteration
            )
            stages.emission.emitters.tint_photons(
                stages.resolve, rays, hits, self._closures.buffer, paths, self._living, iteration
            )
        with stages.timers.stage("first photon hits"):
            self.first_hits.find(stages, rays, hits, self._living)
            if stages.emission.has_falloff:
                stages.emission.fall_off(rays, hits, paths, self.photon_count, stages.settings.seed, iteration)

    def flux_balance(self) -> dict[str, float]:
        """Where the flux of the last iteration went, W summed over the channels.

        ``deposited`` is what the paths still carried to their last vertex, where they are cut off; ``absorbed`` is what
        the vertices before kept. ``lost`` is flux on a ray of which no segment tells: it must be zero.
        Russian roulette makes single events absorb more or less than their share, the sum being right.
        """
        groups = -(-self.photon_count // FLUX_GROUP)
        self._balance.run(
            self.photon_count,
            {"Emitted": self._emitted.buffer, "Photons": self.photons.buffer, "Sums": self._sums.buffer},
            {"photon_count": self.photon_count, "segments": self.segments},
        )
        sums = self._sums.read(FLUX_SUMS.dtype, groups)
        return {name: float(sums[name].sum(dtype=np.float64)) for name in FLUX_NAMES}

    def read(self) -> np.ndarray:
        """(segments, photon_count) PHOTON records of the last iteration."""
        records = self.photons.read(PHOTON.dtype, self.segments * self.photon_count)
        return records.reshape(self.segments, self.photon_count)

    def release(self) -> None:
        for buffer in (*self._buffers, self._living, self.first_hits):
            buffer.release()

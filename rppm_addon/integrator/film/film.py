# SPDX-License-Identifier: GPL-3.0-or-later
"""UpdatePPMParams: running means of radiance and of the passes, per pixel."""

from collections.abc import Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import ComputeShader, Part, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...scene.passes import FILM_PASSES, SCATTERED_LIGHT, SHADOW_CATCHER, VECTOR, Accumulation
from ..common.band import Band
from ..common.film_buffers import FilmBuffer, FilmParts
from ..common.stage_sizes import StageSizes, band_pixels
from ..device_scene.stage_context import StageContext
from .aov_passes import AovPasses
from .cryptomatte import Cryptomatte
from .events import BandEvents, Listener
from .motion_vectors import MotionVectors

Record(
    "PassParameters",
    segment="uint",
    pixels="uint",
    passes="uint",
    keeps_paths="uint",
    media_scatter="uint",
    mist_start="float",
    mist_inverse_depth="float",
    mist_exponent="float",
    world_origin="vec3",
)
Record("FilmParameters", count="uint", quantum="float", first_pixel="uint", is_filtered="uint")
StorageBlock("Film", "vec4 film[];")
StorageBlock("PhotonLight", "vec4 photon_light[];")
"""Means of what photons bring, W/(m^2 sr), and of the squared luminance of all else."""
StorageBlock("GroupValues", "float group_values[];")
"""Light of each pixel of a band, three channels for each light group."""
StorageBlock("PassCounts", "uvec2 pass_counts[];")
StorageBlock("PassValues", "float pass_values[];")
"""Values of a band's passes, one pass after the other (shaders/film/passes.glsl)."""
Constants(
    "Passes",
    ACCUMULATION=Accumulation,
    PASS={entry.identifier.upper(): number for number, entry in enumerate(FILM_PASSES)},
    PASS_COUNT=len(FILM_PASSES),
    PASS_CHANNELS=[len(entry.channels) for entry in FILM_PASSES],
    PASS_ACCUMULATION=[entry.accumulation.value for entry in FILM_PASSES],
    PASS_NOTHING=[entry.nothing for entry in FILM_PASSES],
)


_EMISSION_PASSES = ("Emission", "Environment", "Denoising Albedo", *(entry.name for entry in SCATTERED_LIGHT))
"""Passes that include emission at the vertices of camera paths."""


def _shows_emission(sizes: StageSizes) -> bool:
    return any(entry.name in _EMISSION_PASSES for entry in sizes.passes)


def _channels(sizes: StageSizes) -> int:
    return sum(len(entry.channels) for entry in sizes.passes if entry in FILM_PASSES)


def _shows_surfaces(sizes: StageSizes) -> bool:
    return any(entry in FILM_PASSES or entry.is_aov or entry.name == VECTOR for entry in sizes.passes)


def _group_channels(sizes: StageSizes) -> int:
    return sum(len(entry.channels) for entry in sizes.passes if entry.light_group)


def _pass_paths(sizes: StageSizes) -> int:
    return band_pixels(sizes) if _shows_emission(sizes) else 0


def pass_bits(sizes: StageSizes) -> int:
    """The passes that the film keeps, as bits by their places in FILM_PASSES."""
    return sum(1 << FILM_PASSES.index(entry) for entry in sizes.passes if entry in FILM_PASSES)


def exposed(radiance: np.ndarray, exposure: float) -> np.ndarray:
    """(height, width, 4) radiance and alpha of a film, which is changed, as it is shown."""
    radiance[..., :3] *= exposure
    radiance[..., 3] = np.clip(radiance[..., 3], 0.0, 1.0)
    return radiance


class Film(Listener):
    """Means over the iterations: 16 bytes of radiance and alpha a pixel, 4 for each channel of a pass, and 8 of their
    counts where there are passes; 16 more where viewports filter the picture."""

    memory_group = "passes"
    remedy = "lower the resolution"
    _radiance = FilmBuffer("film", "vec4", together=True)
    _values = FilmBuffer("pass values", "float", _channels)
    _photon_light = FilmBuffer("photons' part of the film", "vec4", lambda sizes: sizes.is_filtered, together=True)
    _counts = FilmBuffer("pass counts", "uvec2", _shows_surfaces)
    _paths = StorageBuffer("pass paths", "vec4", _pass_paths, block="PassPaths")
    _cryptomatte = Part(Cryptomatte)
    _motion_vectors = Part(MotionVectors)
    _aovs = Part(AovPasses)
    _begin_passes = ComputeShader("film/begin_passes.comp")
    _pass_program = ComputeShader("film/passes.comp")
    _accumulate = ComputeShader("film/accumulate.comp")
    _group_values = FilmBuffer("passes of light groups", "float", _group_channels)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._add_emission = library.compute("film/path_emission.comp") if _shows_emission(sizes) else None
        catches = sizes.has_catchers and any(entry.name == SHADOW_CATCHER for entry in sizes.passes)
        self._caught_shadows = library.compute("film/caught_shadows.comp") if catches else None
        self._context = context
        self.width, self.height, self._bands = sizes.width, sizes.height, sizes.bands
        self.passes = tuple(entry for entry in sizes.passes if entry in FILM_PASSES)
        """Requested passes that passes.comp writes."""
        self._passes = pass_bits(sizes)
        self.rendered_passes = sizes.passes
        """Passes that read_passes returns, and those that do not depend on iterations (Accumulation.INSPECTION)."""
        self._groups = tuple(entry for entry in sizes.passes if entry.light_group)
        self._shows_surfaces = _shows_surfaces(sizes)
        """Whether passes show the first surfaces of paths."""
        self._is_filtered = sizes.is_filtered

    def band_begun(self, events: BandEvents) -> None:
        """Listener.band_begun: prepare the passes for the iteration."""
        if not events.iteration.enters_film or not self._shows_surfaces:
            return
        context, band = events.context, events.band
        blocks = {**context.blocks, "PassCounts": self._counts.of(band)}
        self._begin_passes.run(band.pixel_count, blocks, self._parameters(context, band, 0))

    def direct_light_added(self, events: BandEvents, segment: int) -> None:
        """Listener.direct_light_added: add the first surfaces of camera paths to the passes, where the paths reach them
        in this segment, and the shadows on catchers."""
        if not events.iteration.enters_film:
            return
        context, importons, band = events.context, events.importons, events.band
        self._cryptomatte.add(context, importons, band, segment)
        if not self._shows_surfaces:
            return
        counts, parameters = self._counts.of(band), self._parameters(context, band, segment)
        self._motion_vectors.add(context, importons, counts, band, events.iteration, segment)
        blocks = {**context.blocks, **importons.blocks, "PassCounts": counts}
        importons.active.run(self._pass_program, blocks, parameters)
        if self._caught_shadows is not None:
            importons.active.run(self._caught_shadows, blocks, parameters)

    def paths_scattered(self, events: BandEvents, segment: int) -> None:
        """Listener.paths_scattered: add the emission at the vertices of a segment."""
        if self._add_emission is None or not events.iteration.enters_film:
            return
        context, importons, band = events.context, events.importons, events.band
        importons.active.run(
            self._add_emission,
            {**context.blocks, **importons.blocks},
            self._parameters(context, band, segment),
        )

    def band_ended(self, events: BandEvents) -> None:
        """Listener.band_ended: add the band's estimate, and what AOV Output nodes have written."""
        context, band, sums = events.context, events.band, events.sums
        with context.timers.stage("film"):
            self._accumulate.run(
                band.pixel_count,
                {
                    **context.blocks,
                    **events.importons.blocks,
                    "Film": self._radiance.of(band),
                    "PhotonLight": self._photon_light.of(band),
                },
                {
                    "count": band.pixel_count,
                    "quantum": sums.quantum,
                    "first_pixel": self._radiance.first_pixel(band),
                    "is_filtered": self._is_filtered,
                },
            )
        self._aovs.add(context, events.importons, band)

    def blocks_of(self, band: Band) -> dict[str, Bindable]:
        """Storage blocks of a band's passes: those of shaders/film/passes.glsl, and GroupValues."""
        return {"PassValues": self._values.of(band), "GroupValues": self._group_values.of(band)}

    def _parameters(self, context: StageContext, band: Band, segment: int) -> dict[str, object]:
        mist = context.scene.world.mist
        return {
            "pixels": band.pixel_count,
            "passes": self._passes,
            "segment": segment,
            "keeps_paths": self._add_emission is not None,
            "media_scatter": context.materials.media.scatter,
            "mist_start": mist.start,
            "mist_inverse_depth": 1.0 / mist.depth if mist.depth > 0.0 else 0.0,
            "mist_exponent": mist.exponent,
            "world_origin": context.scene.world_offset,
        }

    @property
    def radiance(self) -> FilmParts:
        """(pixels, 4) float32 of what read_radiance gives."""
        return self._radiance

    @property
    def photon_light(self) -> FilmParts:
        """(pixels, 4) float32 means of what photons bring, and of the squared luminance of all else, where kept."""
        return self._photon_light

    def copy_pass(self, name: str, into: moderngl.Buffer, first: int) -> int:
        """Lay what read_passes gives of a pass into a buffer of float32, from the number ``first`` on.

        Returns the number behind it. Raises ValueError for a pass that the film does not keep.
        """
        number = [entry.name for entry in self.passes].index(name)
        before = sum(len(entry.channels) for entry in self.passes[:number])
        channels = len(self.passes[number].channels)
        for band, values in zip(self._bands, self._values, strict=True):
            count, place = channels * band.pixel_count, first + channels * band.first_pixel
            self._context.moderngl.copy_buffer(
                into, values.buffer, 4 * count, read_offset=4 * before * band.pixel_count, write_offset=4 * place
            )
        return first + channels * self.width * self.height

    def read_radiance(self) -> np.ndarray:
        """(height, width, 4) float32 radiance W/(m^2 sr) and alpha, row 0 at the bottom."""
        return self._radiance.read(np.float32, 4)

    def read_passes(self) -> dict[str, np.ndarray]:
        """By name, (height, width) or (height, width, channels) float32 of the passes that the film keeps."""
        found, first = {}, 0
        for entry in self.passes:
            channels = len(entry.channels)
            parts = [
                buffer.read(np.float32, channels * band.pixel_count, 4 * first * band.pixel_count)
                for band, buffer in zip(self._bands, self._values, strict=True)
            ]
            shape = (self.height, self.width, channels) if channels > 1 else (self.height, self.width)
            found[entry.name] = np.concatenate(parts).reshape(shape)
            first += channels
        apart = self._motion_vectors.read() | self._cryptomatte.read()
        return found | apart | self._aovs.read() | self._read_groups()

    def _read_groups(self) -> dict[str, np.ndarray]:
        if not self._groups:
            return {}
        light = self._group_values.read(np.float32, 3 * len(self._groups))
        light = light.reshape(self.height, self.width, len(self._groups), 3)
        return {entry.name: light[:, :, number].copy() for number, entry in enumerate(self._groups)}

    def read_pass_counts(self) -> np.ndarray:
        """(height, width, 2) uint32: iterations whose paths the means include, and those
        among them whose path reached a surface. (0, 0, 2) where there are no passes."""
        if not self._shows_surfaces:
            return np.zeros((0, 0, 2), np.uint32)
        return self._counts.read(np.uint32, 2)

    def restore(self, radiance: np.ndarray, passes: Mapping[str, np.ndarray], pass_counts: np.ndarray) -> None:
        """Take the means that read_radiance, read_passes and read_pass_counts gave; KeyError where a pass misses."""
        self._radiance.upload(radiance)
        if self.passes:
            values = [np.asarray(passes[entry.name], np.float32) for entry in self.passes]
            for band, buffer in zip(self._bands, self._values, strict=True):
                rows = slice(band.first_row, band.first_row + band.rows)
                buffer.upload(np.concatenate([part[rows].reshape(-1) for part in values]))
        if self._shows_surfaces:
            self._counts.upload(pass_counts)
        if self._motion_vectors.is_on:
            self._motion_vectors.restore(passes[VECTOR])
        self._aovs.restore(passes)
        if self._groups:
            self._group_values.upload(
                np.stack([np.asarray(passes[entry.name], np.float32) for entry in self._groups], axis=2)
            )
        self._cryptomatte.restore(passes)

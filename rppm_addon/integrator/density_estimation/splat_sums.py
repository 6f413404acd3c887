# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums of what photons add to the importons of each pixel, in whole quanta of radiance."""

import contextlib
import enum
import functools
import math
import operator
from collections.abc import Iterator

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ..common.stage_sizes import StageSizes, band_pixels

SUM_PARAMETERS = {
    "quanta": "float",
    "roulette": "uint",
    "counting": "uint",
    "light_sums": "uint",
    "light_groups": "uint",
}
"""Parameters of programs that include roulette.glsl, add.glsl, collect.glsl or light.glsl of
shaders/density_estimation/splat_sums/."""

StorageBlock("SplatSums", "uint sum_words[];")
StorageBlock("PhotonCounts", "uint photon_counts[];")
StorageBlock("LightSums", "uint light_words[];")
StorageBlock("GroupSums", "uint group_words[];")

_PHOTON_QUANTA = 1 << 24
_SUM_WORDS, _COUNT_WORDS = 12, 6
"""Words of a pixel in SplatSums, and in PhotonCounts (shaders/density_estimation/splat_sums/sums.glsl)."""
_SCATTERED_SUMS, _CAUSTICS_SUMS, _VOLUME_SUMS = 6, 2, 2


class LightSum(enum.IntFlag):
    """Kinds of sums that are kept beside those of all light."""

    SCATTERED = 1
    """Sums by how the first surface scatters the light."""
    CAUSTICS = 2
    GROUPS = 4
    """Sums by the light group of the source."""
    VOLUME = 8
    """Sums of what media scatter straight to the camera. They are kept with those of SCATTERED."""

    @classmethod
    def of(cls, sizes: StageSizes) -> "LightSum":
        """Return the kinds of sums that the passes ask for."""
        wanted = {
            cls.SCATTERED: sizes.has_scattered_light,
            cls.CAUSTICS: sizes.has_caustics,
            cls.GROUPS: bool(sizes.light_groups),
            cls.VOLUME: sizes.has_scattered_light and sizes.features.has_media,
        }
        return functools.reduce(operator.or_, (flag for flag, is_wanted in wanted.items() if is_wanted), cls(0))


Constants(
    "LightSums",
    LIGHT_SUMS=LightSum,
    SCATTERED_SUMS=_SCATTERED_SUMS,
    CAUSTICS_SUM=_SCATTERED_SUMS,
    FINAL_GATHER_CAUSTICS=_SCATTERED_SUMS + 1,
    CAUSTICS_SUMS=_CAUSTICS_SUMS,
    VOLUME_DIRECT_SUM=_SCATTERED_SUMS + _CAUSTICS_SUMS,
    VOLUME_SUMS=_VOLUME_SUMS,
)


def _light_words(sizes: StageSizes) -> int:
    wanted = LightSum.of(sizes)
    kept = {
        LightSum.SCATTERED: _SCATTERED_SUMS,
        LightSum.CAUSTICS: _CAUSTICS_SUMS,
        LightSum.VOLUME: _VOLUME_SUMS,
    }
    return _SUM_WORDS // 2 * sum(count for flag, count in kept.items() if flag in wanted) * band_pixels(sizes)


def _group_words(sizes: StageSizes) -> int:
    return _SUM_WORDS * len(sizes.light_groups) * band_pixels(sizes)


def radiance_quantum(photon_flux: float, radius: float) -> float:
    """W/(m^2 sr), a power of two: what the sums of splats count in.

    A white diffuse surface reflects about 2^24 of them when a photon of mean flux (W) is spread over a disk of the
    largest splat radius (m). Sums end at 2^64.
    """
    radiance = photon_flux / (math.pi**2 * max(radius, 1e-12) ** 2) / _PHOTON_QUANTA
    return 2.0 ** math.floor(math.log2(min(max(radiance, 1e-30), 1e20)))


class SplatSums(BufferSet):
    """Sums of the photons of each pixel of a band, and their numbers (density_estimation/splat_sums/sums.glsl)."""

    remedy = "lower the resolution"
    _sums = StorageBuffer("gathered radiance", "uint", lambda sizes: _SUM_WORDS * band_pixels(sizes), block="SplatSums")
    _photon_counts = StorageBuffer(
        "photon counts", "uint", lambda sizes: _COUNT_WORDS * band_pixels(sizes), block="PhotonCounts"
    )
    _light_sums = StorageBuffer("gathered radiance of light passes", "uint", _light_words, block="LightSums")
    _group_sums = StorageBuffer("gathered radiance of light groups", "uint", _group_words, block="GroupSums")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self.kept = LightSum.of(sizes)
        """Kinds of light sums that are kept."""
        self._groups = len(sizes.light_groups)
        self.count_in(1.0, 0, 0)

    def count_in(self, quantum: float, roulette: int, counting: int) -> None:
        """Set what the sums count in, W/(m^2 sr), the seed of the roulette (0 keeps all pairs of a photon and a pixel),
        and the seed of the photons' signs (0 neither counts the photons that pixels take nor sums them with signs)."""
        self.quantum = quantum
        self.counting = counting
        self.parameters = {
            "quanta": (2.0 if roulette else 1.0) / quantum,
            "roulette": roulette,
            "counting": counting,
            "light_sums": int(self.kept),
            "light_groups": self._groups,
        }
        """Values of SUM_PARAMETERS."""

    @contextlib.contextmanager
    def left_alone(self) -> Iterator[None]:
        """Leave the sums as they are within the context: photons that are splatted meanwhile add nothing."""
        parameters = self.parameters
        self.parameters = parameters | {"quanta": 0.0, "counting": 0}
        try:
            yield
        finally:
            self.parameters = parameters

    def clear(self) -> None:
        """Forget the band before."""
        self._sums.clear()
        for sums in (self._light_sums, self._group_sums):
            if sums.size:
                sums.clear()
        if self.counting:
            self._photon_counts.clear()

    def read(self, count: int) -> np.ndarray:
        """(count, 2, 3) uint64 quanta of the band's first pixels: what their importons took, what their rays found."""
        return self._sums.read(np.uint64, 6 * count).reshape(-1, 2, 3)

    @property
    def photons_for_one(self) -> int:
        """Number of photons that one counted photon stands for."""
        return 2 if self.parameters["roulette"] else 1

    def photons_taken(self, count: int) -> np.ndarray:
        """(count, 2) how many photons the importons of each of the band's pixels took, where they are counted:
        global ones, and caustic ones but for those at the ends of gathering rays."""
        return self._counted(count)[:, :2] * self.photons_for_one

    def signed(self, count: int) -> np.ndarray:
        """(count, 2) int64 quanta of luminance of the band's first pixels, each photon path with a random sign: what
        their importons took, what their rays found."""
        return np.ascontiguousarray(self._counted(count)[:, 2:]).view(np.int64)

    def _counted(self, count: int) -> np.ndarray:
        return self._photon_counts.read(np.uint32, _COUNT_WORDS * count).reshape(-1, _COUNT_WORDS)

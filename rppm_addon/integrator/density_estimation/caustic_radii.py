# SPDX-License-Identifier: GPL-3.0-or-later
"""Radii for caustics that follow the photons, pixel by pixel.

Where few photons come, Eq. 3's disk holds next to none, and the picture is noise until many iterations have passed.
So pixels begin with a multiple of it, and come back to it as they are seen to take many. Factors only fall, by what
earlier iterations took; Eq. 2 shrinks what remains, so the estimate stays consistent.
"""

from collections.abc import Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import ComputeShader
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.timers import StageTimers
from ...gl.programs.program import Bindable
from ..common.band import Band
from ..common.film_buffers import FilmBuffer
from ..common.stage import Stage
from .radii import EXPECTED_CAUSTIC_PHOTONS, Radii
from .splat_sums import SplatSums

StorageBlock("RadiusFactors", "float radius_factors[];")


Record("NarrowParameters", count="uint", max_factor="float", expected="float")

_MIN_FRACTION = 0.25
"""Least fraction of the first iteration's photons that is assumed: disks of fewer hold too few photons to measure how
dense they lie."""


class CausticRadii(Stage):
    """Factors that multiply Eq. 3's radius of each pixel of the film, from the second iteration on."""

    memory_group = "passes"
    remedy = "lower the resolution"
    _factors = FilmBuffer("radius factors", "float")
    _program = ComputeShader("density_estimation/caustic_radii/narrow.comp")

    def factors(self, band: Band) -> moderngl.Buffer:
        """(pixels,) float32 of a band of the film."""
        return self._factors.of(band)

    def narrow(
        self,
        blocks: Mapping[str, Bindable],
        sums: SplatSums,
        band: Band,
        radii: Radii,
        fraction: float,
        timers: StageTimers,
    ) -> None:
        """Learn from the photons that a band's pixels took in an iteration.

        blocks: the uniform block Iteration among others. fraction: photons of the iteration over those of the first.
        Of fewer photons disks hold fewer: that makes noise, which is weighed (common/photon_counts.py), and no wider
        blur.
        """
        held = max(fraction, _MIN_FRACTION)
        with timers.stage("learning"):
            self._program.run(
                band.pixel_count,
                {**blocks, **sums.blocks, "RadiusFactors": self._factors.of(band)},
                {
                    "count": band.pixel_count,
                    "max_factor": radii.max_factor,
                    "expected": EXPECTED_CAUSTIC_PHOTONS * radii.shrinkage**2 * held / sums.photons_for_one,
                },
            )

    def read(self) -> np.ndarray:
        """(height, width) float32 factors, once the first iteration has been."""
        return self._factors.read(np.float32, 1)[..., 0]

    def restore(self, factors: np.ndarray) -> None:
        """Take what read gave."""
        self._factors.upload(factors)

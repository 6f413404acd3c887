# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of few samples without most of their noise, for viewports.

Only light by rays is filtered: that of photons, all caustics among it, is left as it is. Edges of surfaces stop the
filter by depth and normal, textures by albedo, and shadows by how much brighter they are than noise can make them. As
samples come, noise tells less and less, and from MAX_SAMPLES on nothing is filtered.
"""

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.records import Record, stride
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.passes import FILM_PASSES
from ..common.require import require
from ..common.stage_sizes import StageSizes, film_pixels
from ..common.viewport_demands import FILTERED_PASSES
from ..film.film import Film

Record(
    "NoiseFilterParameters",
    width="uint",
    pixels="uint",
    albedo="uint",
    normal="uint",
    depth="uint",
    emission="uint",
    environment="uint",
    iteration="uint",
    step="uint",
    strength="float",
    luminance_step="float",
)
StorageBlock("Signals", "vec4 signals[];")
"""Light over albedo, W/(m^2 sr), and the variance of its luminance; in the end the picture with alpha."""
StorageBlock("Guides", "vec4 guides[];")
"""Unit normal, in the camera's axes, and depth, meters; 0 where there is no surface."""

STEPS = (1, 2, 4, 8, 16)
"""Pixels between the taps of a round."""
MAX_SAMPLES = 256
"""Largest number of samples of a picture that is filtered."""
_WHOLE_SAMPLES = 64
"""Number of samples up to which the filtered picture is shown alone."""
_IMAGES = "images of the noise filter"


def strength(samples: int, of: int) -> float:
    """The part that the filtered picture has in what is shown after ``samples`` of ``of``: 0 at the end."""
    end = min(of, MAX_SAMPLES)
    return min(1.0, max(0.0, (end - samples) / max(end - min(_WHOLE_SAMPLES, end // 2), 1)))


def _luminance_step(samples: int) -> float:
    """By how many standard deviations of the noise a pixel may be brighter than another of the same light: 4 of the
    first samples (Schied et al. 2017), 1 from the eighth on, as variances are known better by then."""
    return min(4.0, max(1.0, 8.0 / samples))


def _pass_values(sizes: StageSizes) -> int:
    kept = (entry for entry in FILM_PASSES if entry.name in FILTERED_PASSES)
    return film_pixels(sizes) * sum(len(entry.channels) for entry in kept)


class NoiseFilter(BufferSet):
    """Filters films of one size."""

    remedy = "make the viewport smaller"
    _guides = StorageBuffer("guides of the noise filter", "vec4", film_pixels)
    _passes = StorageBuffer("passes of the noise filter", "float", _pass_values, texel_bytes=16)
    """Passes of a film that the filter reads, one after the other in the order of FILTERED_PASSES."""
    picture = StorageBuffer("filtered picture", "vec4", film_pixels)
    """Radiance W/(m^2 sr) and alpha, once it was filtered."""

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._prepare = library.compute("viewport/noise_filter/prepare.comp")
        self._smooth = library.compute("viewport/noise_filter/smooth.comp")
        self._despeckle = library.compute("viewport/noise_filter/despeckle.comp")
        size, gl = (sizes.width, sizes.height), context.moderngl
        self.size = size
        self._images = [self.own(gl.texture(size, 4, dtype="f4"), _IMAGES) for _ in range(2)]
        for image in self._images:
            image.filter = (moderngl.NEAREST, moderngl.NEAREST)

    @classmethod
    def expected_bytes(cls, sizes: object) -> dict[str, int]:
        """BufferSet.expected_bytes, with its textures."""
        assert isinstance(sizes, StageSizes)
        return super().expected_bytes(sizes) | {_IMAGES: 2 * stride("vec4") * film_pixels(sizes)}

    def filter(self, film: Film, samples: int, strength: float) -> None:
        """Filter a film of so many samples that keeps what the filter takes; ``strength`` is above 0."""
        pixels = film.width * film.height
        places, end = [], 0
        for name in FILTERED_PASSES:
            places.append(end)
            end = film.copy_pass(name, self._passes.buffer, end)
        albedo, normal, depth, emission, environment = places
        parameters = {
            "width": film.width,
            "pixels": pixels,
            "albedo": albedo,
            "normal": normal,
            "depth": depth,
            "emission": emission,
            "environment": environment,
            "iteration": samples,
            "step": 0,
            "strength": strength,
            "luminance_step": _luminance_step(samples),
        }
        buffers = {
            "Film": require(film.radiance.whole),
            "PhotonLight": require(film.photon_light.whole),
            "PassValues": self._passes.buffer,
        }
        signals = {"Signals": self.picture.buffer}
        self._prepare.run(pixels, buffers | signals | {"Guides": self._guides.buffer}, parameters)
        signal, guide = self._images
        guide.write(self._guides.buffer)
        for step in STEPS:
            signal.write(self.picture.buffer)
            images = {"signal_image": signal, "guide_image": guide}
            self._smooth.run(pixels, signals | images, parameters | {"step": step})
        signal.write(self.picture.buffer)
        self._despeckle.run(pixels, buffers | signals | {"signal_image": signal}, parameters)

    def read(self) -> np.ndarray:
        """(height, width, 4) float32 radiance W/(m^2 sr) and alpha, row 0 at the bottom."""
        width, height = self.size
        return self.picture.read(np.float32, 4 * width * height).reshape(height, width, 4).copy()

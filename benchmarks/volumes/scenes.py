# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of the comparison: the medium of each, and the density of the cloud. Their geometry is in `common.glsl`."""

from dataclasses import dataclass

import numpy as np

WIDTH, HEIGHT = 320, 240
TANGENT = 0.4
"""Tangent of half the vertical angle of view."""


CLOUD_DEPTH, CLOUD_MAJORANT = 10.0, 16.0
"""Optical depth through the cloud's middle at a majorant in 1/m; in proportion at others."""


@dataclass(frozen=True)
class VolumeScene:
    """A medium and the number of its geometry: ``majorant`` in 1/m bounds the extinction and is all of it in fog."""

    name: str
    number: int
    majorant: float
    albedo: float
    anisotropy: float

    @property
    def depth(self) -> float:
        """Optical depth from front to back, in the middle."""
        return self.majorant * (CLOUD_DEPTH / CLOUD_MAJORANT if self.is_cloud else 2.0)

    @property
    def is_cloud(self) -> bool:
        return self.number == 2

    def defines(self) -> dict[str, object]:
        return {
            "SCENE": self.number,
            "MAJORANT": float(self.majorant),
            "ALBEDO": float(self.albedo),
            "G": float(self.anisotropy),
            "WIDTH": WIDTH,
            "HEIGHT": HEIGHT,
        }


SCENES = (
    VolumeScene("lamp", 0, 0.5, 0.9, 0.3),
    VolumeScene("caustic", 1, 0.2, 0.9, 0.3),
    VolumeScene("cloud", 2, CLOUD_MAJORANT, 0.999, 0.7),
)


def cloud_densities(size: int = 64) -> np.ndarray:
    """(size, size, size) float32 fractions of the majorant in the cube around the unit ball.

    Noise of four octaves carves the ball; the optical depth of its middle is CLOUD_DEPTH at CLOUD_MAJORANT.
    """
    generator = np.random.default_rng(5)
    axis = (np.arange(size) + 0.5) / size * 2.0 - 1.0
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    noise = np.zeros((size, size, size))
    for octave in range(4):
        spectrum = np.fft.fftn(generator.standard_normal(noise.shape))
        frequency = np.fft.fftfreq(size) * size
        squared = sum(np.square(part) for part in np.meshgrid(frequency, frequency, frequency, indexing="ij"))
        band = np.fft.ifftn(spectrum * np.exp(-squared / (2.0 * (1.5 * 2.0**octave) ** 2))).real
        noise += band / band.std() * 0.5**octave
    radius = np.sqrt(x * x + y * y + z * z)
    density = np.clip(1.2 * (0.75 - radius) + 0.22 * noise + 0.15, 0.0, 0.5)
    density[radius > 0.97] = 0.0
    middle = slice(size // 2 - 8, size // 2 + 8)
    mean_depth = density[:, middle, middle].mean(axis=(1, 2)).sum() * 2.0 / size
    density *= CLOUD_DEPTH / mean_depth / CLOUD_MAJORANT
    if density.max() > 1.0:
        raise ValueError(f"the majorant is too small: {density.max() * CLOUD_MAJORANT:.1f} is needed")
    return density.astype(np.float32)


def compared_pixels(scene: VolumeScene) -> np.ndarray:
    """(HEIGHT, WIDTH) bool: pixels that enter the error, all but those of the glass ball with a margin of a pixel."""
    if scene.number != 1:
        return np.ones((HEIGHT, WIDTH), bool)
    x = ((np.arange(WIDTH) + 0.5) / WIDTH * 2.0 - 1.0) * TANGENT * WIDTH / HEIGHT
    y = ((np.arange(HEIGHT) + 0.5) / HEIGHT * 2.0 - 1.0) * TANGENT
    rays = np.stack(np.broadcast_arrays(x[None, :], y[:, None], -1.0), -1)
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    to = np.array([0.0, 0.3, -3.6])
    nearest = rays @ to
    return np.sqrt(np.maximum(to @ to - nearest**2, 0.0)) > 0.3 + 0.03

# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's image as texture and as a distribution to sample directions from."""

import moderngl
import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..scene.images import Image
from ..scene.scene import Scene

_WIDEST = 512


def linear_pixels(image: Image) -> np.ndarray:
    """(height, width, 3) float32 scene-linear pixels, finite and not negative."""
    pixels = image.pixels[..., :3]
    if pixels.dtype == np.uint8:
        pixels = pixels.astype(np.float32) / 255
        if image.encoding == "SRGB":
            pixels = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    return np.clip(np.nan_to_num(pixels, posinf=0.0), 0.0, None).astype(np.float32)


def _reduced(brightness: np.ndarray) -> np.ndarray:
    """Brightness averaged over whole blocks until it is at most _WIDEST wide."""
    step = -(-brightness.shape[1] // _WIDEST)
    height, width = (n // step * step for n in brightness.shape)
    if step == 1 or height == 0:
        return brightness
    return brightness[:height, :width].reshape(height // step, step, width // step, step).mean(axis=(1, 3))


def distribution_of(brightness: np.ndarray) -> np.ndarray:
    """Cumulated shares of rows, then of the cells of each row, flat float32.

    ``brightness`` is (height, width), row 0 at the bottom; rows count by the sine of their polar angle.
    """
    height, width = brightness.shape
    sine = np.sin(np.pi * (np.arange(height) + 0.5) / height)[:, None]
    weight = (brightness + 0.01 * brightness.mean()) * sine
    rows = weight.sum(axis=1)
    cells = np.cumsum(weight, axis=1) / rows[:, None]
    cells[:, -1] = 1.0
    cumulated = np.cumsum(rows) / rows.sum()
    cumulated[-1] = 1.0
    return np.concatenate([cumulated, cells.ravel()]).astype(np.float32)


class Environment:
    """The world for shaders/emission/environment.glsl; width 0 stands for a constant world."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self.distribution = GrowingBuffer(context, "environment distribution")
        self._texture: moderngl.Texture | None = None
        self.width = self.height = 0
        self.mean_radiance = np.zeros(3)

    @property
    def memory_bytes(self) -> int:
        return self.distribution.size + 16 * self._texture.width * self._texture.height

    def build(self, scene: Scene) -> None:
        """Upload the world's image, if it has one that is not black."""
        world = scene.world
        self.mean_radiance = np.maximum(world.radiance, 0.0).astype(np.float64)
        self.width = self.height = 0
        pixels = np.ones((1, 1, 3), np.float32)
        if world.image >= 0:
            pixels = linear_pixels(scene.images[world.image])
            sine = np.sin(np.pi * (np.arange(len(pixels)) + 0.5) / len(pixels))[:, None, None]
            self.mean_radiance = self.mean_radiance * ((pixels * sine).mean(axis=(0, 1)) / sine.mean())
            brightness = _reduced(pixels.mean(axis=2, dtype=np.float64))
            if brightness.max() > 0:
                self.height, self.width = brightness.shape
                self.distribution.upload(distribution_of(brightness))
        if self._texture is not None:
            self._texture.release()
        rgba = np.ones((*pixels.shape[:2], 4), np.float32)
        rgba[..., :3] = pixels
        self._texture = self._context.moderngl.texture(pixels.shape[1::-1], 4, rgba.tobytes(), dtype="f4")
        self._texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self._texture.repeat_x, self._texture.repeat_y = True, False

    def use(self) -> None:
        """Bind the image to texture unit 0, where environment.glsl reads it."""
        self._texture.use(0)

    def release(self) -> None:
        self.distribution.release()
        if self._texture is not None:
            self._texture.release()

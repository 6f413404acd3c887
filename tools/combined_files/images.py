# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that are computed: tiles, wood, normal maps of heights, leaves with alpha, skies."""

import bpy
import numpy as np

from .draws import Draws


def image(name: str, pixels: np.ndarray, data: bool = False) -> bpy.types.Image:
    """A packed image of (H, W, 4) values, float where these exceed 1; data: without a color space."""
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height, alpha=True, float_buffer=bool(pixels.max() > 1.0), is_data=data)
    made.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    made.pack()
    return made


def heights(draws: Draws, size: int = 64) -> np.ndarray:
    """(size, size) values from 0 to 1 of a smooth pattern that repeats."""
    y, x = np.mgrid[:size, :size] * (2.0 * np.pi / size)
    waves = sum(
        np.sin(draws.randint(-4, 4) * x + draws.randint(1, 5) * y + draws.uniform(0.0, 6.0)) / (1 + at)
        for at in range(5)
    )
    return (waves - waves.min()) / (waves.max() - waves.min())


def colored(draws: Draws, size: int = 64) -> np.ndarray:
    """(size, size, 4) of two colors, mixed by heights, with lines of tiles between them."""
    a, b = np.array(draws.color()), np.array(draws.color())
    pixels = a + heights(draws, size)[..., None] * (b - a)
    if draws.maybe():
        width = size // draws.pick((2, 4, 8))
        y, x = np.mgrid[:size, :size]
        pixels[(y % width < 2) | ((x + width // 2 * (y // width % 2)) % width < 2), :3] *= 0.3
    return pixels


def normal_map(of: np.ndarray, strength: float = 2.0) -> np.ndarray:
    """(H, W, 4) tangent-space normals of (H, W) heights, as colors."""
    up, right = np.gradient(of * strength * 4.0)
    normals = np.stack([-right, -up, np.ones_like(of)], axis=-1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.concatenate([0.5 + 0.5 * normals, np.ones((*of.shape, 1))], axis=-1)


def gray(values: np.ndarray, low: float = 0.0, high: float = 1.0) -> np.ndarray:
    """(H, W, 4) grays of (H, W) values that are brought from 0...1 to a range."""
    scaled = low + (high - low) * values
    return np.stack([scaled, scaled, scaled, np.ones_like(scaled)], axis=-1)


def leaf(draws: Draws, size: int = 32) -> np.ndarray:
    """(size, size, 4) of a leaf, whose alpha is its shape."""
    y, x = (np.mgrid[:size, :size] + 0.5) / size
    inside = np.abs(x - 0.5) < 0.35 * np.sin(np.pi * y) ** draws.uniform(0.6, 1.5)
    pixels = np.array(draws.color(0.8)) * np.array((0.6, 1.0, 0.3, 1.0)) * (0.6 + 0.4 * y[..., None])
    pixels[..., 3] = inside
    return pixels


def sky(draws: Draws, height: int = 64) -> np.ndarray:
    """(H, 2 H, 4) radiance of an environment with a horizon and some windows of light."""
    y, x = np.mgrid[:height, : 2 * height] / height
    low, high = np.array(draws.color(0.5, (0.05, 0.3))), np.array(draws.color(0.5, (0.3, 1.0)))
    pixels = low + (high - low) * np.clip(4.0 * (y - 0.45), 0.0, 1.0)[..., None]
    for _ in range(draws.randint(1, 4)):
        at, up, width, tall = draws.uniform(0.0, 1.8), draws.uniform(0.5, 0.85), *(draws.uniform(0.05, 0.2),) * 2
        inside = (np.abs(x - at) < width) & (np.abs(y - up) < tall)
        pixels[inside, :3] += np.array(draws.color(0.3, (3.0, 12.0)))[:3]
    pixels[..., 3] = 1.0
    return pixels

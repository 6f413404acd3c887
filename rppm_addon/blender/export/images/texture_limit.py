# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture Limit of Simplify: images are halved until no side is longer."""

import itertools

import bpy
import numpy as np

from ....scene import Image


def texture_limit(scene: bpy.types.Scene, viewport: bool) -> int:
    """Pixels of the longest side that a scene allows images, 0 for any: of viewports or of final renders."""
    chosen = getattr(getattr(scene, "cycles", None), "texture_limit" if viewport else "texture_limit_render", "OFF")
    return int(chosen) if scene.render.use_simplify and chosen != "OFF" else 0


def limited(image: Image, longest: int) -> Image:
    """An image of which no side has more pixels, each the mean of squares of encoded ones, as in Cycles; rows and
    columns that fill no square are cut off."""
    height, width = image.pixels.shape[:2]
    side = 1
    while max(height, width) > longest * side:
        side *= 2
    if side == 1:
        return image
    rows, columns = max(height // side, 1), max(width // side, 1)
    high, wide = min(side, height), min(side, width)
    used, are_bytes = image.pixels[: rows * high, : columns * wide], image.pixels.dtype == np.uint8
    white = np.float32(255.0 if are_bytes else 1.0)
    means = np.zeros((rows, columns, 4), np.float32)
    for y, x in itertools.product(range(high), range(wide)):  # one by one: many means lie halfway between two bytes
        means += used[y::high, x::wide] * (np.float32(1.0) / white)
    means *= np.float32(1.0 / (high * wide))
    pixels = (means * white + np.float32(0.5)).astype(np.uint8) if are_bytes else means
    return Image(image.name, pixels, image.encoding)

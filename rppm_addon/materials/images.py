# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as shaders read them: records of images, and their texels one after the other."""

import numpy as np

from ..scene.images import Image
from .records import IMAGE_ENTRY, TexelFormat

MISSING = Image("missing", np.array([[[255, 0, 255, 255]]], np.uint8), "LINEAR")
"""Magenta, in place of an image that there is not."""


def image_records(images: list[Image]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return (n,) IMAGE_ENTRY records, and the texels of each image, (m,) uint32, which follow each other on the
    device."""
    entries = IMAGE_ENTRY.zeros(len(images))
    texels, first = [], 0
    for entry, image in zip(entries, images, strict=True):
        data, kind = _texels(image)
        height, width = image.pixels.shape[:2]
        entry["first_texel"], entry["width"], entry["height"], entry["format"] = first, width, height, kind
        texels.append(data)
        first += len(data)
    return entries, texels


def _texels(image: Image) -> tuple[np.ndarray, TexelFormat]:
    pixels, srgb = np.ascontiguousarray(image.pixels), image.encoding == "SRGB"
    if pixels.dtype == np.uint8:
        return pixels.reshape(-1, 4).view(np.uint32).ravel(), TexelFormat.SRGB_BYTES if srgb else TexelFormat.BYTES
    halves = np.clip(np.nan_to_num(pixels), -65504, 65504).astype(np.float16)
    return halves.reshape(-1, 4).view(np.uint32).ravel(), TexelFormat.SRGB_HALF if srgb else TexelFormat.HALF

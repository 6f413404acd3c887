# SPDX-License-Identifier: GPL-3.0-or-later
"""Images used by materials and the world."""

from dataclasses import dataclass, field

import numpy as np

from .common.declared import declared


@dataclass
class Image:
    """Pixels of an image, row 0 at the bottom."""

    name: str
    pixels: np.ndarray = field(metadata=declared("height", "width", 4, types="fu", finite=False))
    """(height, width, 4) float32 or uint8, encoded as ``encoding`` says."""
    encoding: str = field(default="LINEAR", metadata=declared(choices=("LINEAR", "SRGB")))
    """LINEAR (scene-linear Rec.709) or SRGB (the sRGB transfer curve)."""


def encode_srgb(linear: np.ndarray) -> np.ndarray:
    """Linear Rec.709 values as sRGB (IEC 61966-2-1), whose curve goes on above 1; of the shape and type given."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0) ** (1.0 / 2.4) - 0.055)


def decode_srgb(encoded: np.ndarray) -> np.ndarray:
    """Linear Rec.709 values of sRGB ones, the inverse of encode_srgb; of the shape and type given."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((np.maximum(encoded, 0.0) + 0.055) / 1.055) ** 2.4)

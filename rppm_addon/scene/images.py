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

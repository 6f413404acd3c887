# SPDX-License-Identifier: GPL-3.0-or-later
"""Images used by materials and the world."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Image:
    """Pixels of an image, row 0 at the bottom."""

    name: str
    pixels: np.ndarray
    """(height, width, 4) float32 or uint8, encoded as ``encoding`` says."""
    encoding: str = "LINEAR"
    """LINEAR (scene-linear Rec.709) or SRGB (the sRGB transfer curve)."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of pictures as people look at them: RPPM's, Cycles' and the difference, many on one sheet."""

from collections.abc import Sequence

import numpy as np
import PIL.Image
import PIL.ImageDraw

from .figures import exposure_of, shown_picture

LABEL = 12
"""Height of a line of text below a picture, pixels."""
GAIN = 2.5
"""Contrast of the difference, gray being none."""


def pair_image(ours: np.ndarray, theirs: np.ndarray) -> PIL.Image.Image:
    """RPPM's picture, Cycles' and the difference in a row, of (H, W, 4) each, row 0 at the bottom."""
    exposure = exposure_of(theirs) if np.any(theirs[..., :3] > 0.0) else exposure_of(ours)
    a, b = shown_picture(ours, exposure), shown_picture(theirs, exposure)
    row = np.concatenate([a, b, np.clip(0.5 + GAIN * (a - b), 0.0, 1.0)], axis=1)[::-1]
    return PIL.Image.fromarray(np.round(255.0 * row).astype(np.uint8))


def sheet(images: Sequence[PIL.Image.Image], labels: Sequence[str], columns: int) -> PIL.Image.Image:
    """Images in a grid, each with a label below."""
    width, height = max(image.width for image in images), max(image.height for image in images) + LABEL
    made = PIL.Image.new("RGB", (columns * width, -(-len(images) // columns) * height), (24, 24, 24))
    draw = PIL.ImageDraw.Draw(made)
    for index, (image, label) in enumerate(zip(images, labels, strict=True)):
        left, top = index % columns * width, index // columns * height
        made.paste(image, (left, top))
        draw.text((left + 2, top + height - LABEL), label, fill=(220, 220, 220))
    return made

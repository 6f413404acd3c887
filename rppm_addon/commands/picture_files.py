# SPDX-License-Identifier: GPL-3.0-or-later
"""PNG files, and whether pictures are whole. Pillow is not part of Blender: this is for the rppm program alone."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import PIL.Image
import PIL.PngImagePlugin

from ..pictures import renamed_when_whole

if TYPE_CHECKING:
    import OpenEXR


def write_png(path: str | Path, pixels: np.ndarray) -> None:
    """Write (H, W, 3 or 4) uint8, sRGB, straight alpha, row 0 at the bottom. Raises PictureError."""
    chunks = PIL.PngImagePlugin.PngInfo()
    chunks.add(b"sRGB", b"\0")
    image = PIL.Image.fromarray(np.ascontiguousarray(pixels[::-1]))
    with renamed_when_whole(path) as temporary:
        image.save(temporary, format="PNG", pnginfo=chunks)


def is_whole(path: str | Path) -> bool:
    """Whether an EXR (of any number of parts) or PNG file is there, can be read to its end and has finite numbers."""
    try:
        return _png_is_whole(Path(path)) if Path(path).suffix == ".png" else _exr_is_whole(Path(path))
    except (OSError, RuntimeError, ValueError, TypeError, KeyError, SyntaxError):  # Pillow: SyntaxError for bad sums
        return False


def _exr_is_whole(path: Path) -> bool:
    import OpenEXR

    if not path.is_file():
        return False
    with OpenEXR.File(str(path), header_only=True) as file:
        announced = len(file.parts)
    with OpenEXR.File(str(path)) as file:  # a part whose pixels cannot be read is left out
        return 0 < announced == len(file.parts) and _is_finite(file)


def _is_finite(file: "OpenEXR.File") -> bool:
    """Whether the picture itself, that is Combined, has numbers alone."""
    return all(np.isfinite(file.channels()[name].pixels).all() for name in ("RGBA", "RGB") if name in file.channels())


_PNG_END = b"\0\0\0\0IEND\xaeB`\x82"
"""Pillow does without the sum of the last chunk."""


def _png_is_whole(path: Path) -> bool:
    if not path.read_bytes().endswith(_PNG_END):
        return False
    with PIL.Image.open(path) as image:
        image.verify()  # the sums of all chunks
    with PIL.Image.open(path) as image:
        image.load()
    return True

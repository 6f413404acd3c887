# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of studio lights, read by Blender when a viewport is first lit by them."""

import logging

import bpy

from ...scene import Image
from ..export.images.images import read_pixels

logger = logging.getLogger(__name__)

_MOST = 8
_pictures: dict[str, Image | None] = {}
"""By path; None where the file cannot be read."""
_wanted: set[str] = set()


def picture(path: str) -> Image | None:
    """The picture of a studio light; None, until ``load_wanted`` has been called, for one that was not yet read."""
    if path and path not in _pictures:
        _wanted.add(path)
    return _pictures.get(path)


def load_wanted() -> bool:
    """Read what was asked for; whether there was any. Not while Blender draws or updates, which forbid it."""
    if not _wanted:
        return False
    for path in _wanted:
        _pictures[path] = _load(path)
        while len(_pictures) > _MOST:
            del _pictures[next(iter(_pictures))]
    _wanted.clear()
    return True


def _load(path: str) -> Image | None:
    try:
        image = bpy.data.images.load(path)
    except RuntimeError:
        logger.warning("the studio light %s cannot be read; choose another", path)
        return None
    try:
        pixels = read_pixels(image)
        is_encoded = not image.is_float and image.colorspace_settings.name == "sRGB"
    finally:
        bpy.data.images.remove(image)
    if pixels is None:
        return None
    pixels[..., 3] = 1.0
    return Image(path, pixels, "SRGB" if is_encoded else "LINEAR")


def forget() -> None:
    """Give the pictures back."""
    _pictures.clear()
    _wanted.clear()

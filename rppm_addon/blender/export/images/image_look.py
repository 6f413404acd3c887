# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors of Blender's images as they are to be filtered: encoded where Cycles does it, and times alpha."""

from dataclasses import dataclass

import bpy
import numpy as np

from ....scene.common.working_space import REC709, WorkingSpace
from ....scene.images import Image, encode_srgb
from .color_spaces import WHITE_IN_CYCLES, scene_linear, working_space

_PART = 1 << 16
"""Numbers that are looked at while they lie in a cache."""
_DATA = {"Non-Color", "Raw", "scene_linear"}
_MULTIPLIED_BY_ALPHA = {"PNG": False, "OPEN_EXR": True}
"""Formats of files that Blender makes floats of, and whether Cycles takes their colors for times alpha."""


@dataclass(frozen=True)
class ImageLook:
    """Properties of a Blender image other than its pixels, so that threads need not ask Blender."""

    name: str
    space: str
    alpha_mode: str
    is_float: bool
    is_associated: bool
    is_in_file: bool
    file_format: str
    working: WorkingSpace
    """Space of the scene's colors."""

    @classmethod
    def of(cls, image: bpy.types.Image) -> "ImageLook":
        """Return the properties of an image."""
        space, in_file = image.colorspace_settings.name, image.source != "GENERATED" and image.packed_file is None
        associated, kind = is_associated(image), image.file_format
        mode, is_float = image.alpha_mode, image.is_float
        return cls(image.name, space, mode, is_float, associated, in_file, kind, working_space())

    @property
    def times_alpha(self) -> int:
        """Number of times, 0 to 2, that the colors of its bytes are multiplied by alpha.

        Cycles takes those in files for straight, whatever the user says.
        """
        if not self.is_associated:
            return 0
        return 2 if self.alpha_mode == "PREMUL" and self.is_in_file else 1

    @property
    def is_linear(self) -> bool:
        """True where the file has linear colors of the working space, or data."""
        return self.space in {*_DATA, self.working.name} or (self.working is REC709 and self.space == "Linear")

    @property
    def is_srgb(self) -> bool:
        """True where the renderer decodes the colors, which are those of Rec.709 by the curve of sRGB."""
        return self.space == "sRGB" and self.working is REC709

    @property
    def needs_blender(self) -> bool:
        """True where Blender is asked to convert its colors."""
        return not (self.is_float or self.is_linear or self.is_srgb)


def encoded(look: ImageLook, pixels: np.ndarray) -> Image:
    """Image of pixels (height, width, 4) float32 as Blender gives them, which are changed."""
    space = look.space
    if look.alpha_mode == "NONE":
        pixels[..., 3] = 1.0
    if look.is_float:
        # Blender has made them linear. Cycles reads files by itself, and takes from Blender what is packed or painted.
        pixels[..., :3] *= WHITE_IN_CYCLES.get(space, 1.0)
        is_srgb = look.is_srgb and look.is_in_file
        if look.is_in_file and look.is_associated and look.file_format in _MULTIPLIED_BY_ALPHA:
            _as_in_file(look, pixels)
        elif is_srgb:
            pixels[..., :3] = encode_srgb(pixels[..., :3])
        return Image(look.name, pixels, "SRGB" if is_srgb else "LINEAR")
    if look.needs_blender:
        encoded = pixels[..., :3]
        if look.times_alpha == 2:
            encoded = _times_alpha(_bytes(pixels)) / np.float32(255.0)
        linear = scene_linear(encoded, space) * WHITE_IN_CYCLES.get(space, 1.0)
        pixels[..., :3] = linear * pixels[..., 3:] if look.times_alpha else linear
        return Image(look.name, pixels, "LINEAR")
    encoding = "SRGB" if look.is_srgb else "LINEAR"
    pixels = _bytes(pixels)
    if look.is_associated and pixels[..., 3].min() < 255:
        colors = _times_alpha(pixels) if look.times_alpha == 2 else pixels[..., :3].astype(np.uint16)
        pixels[..., :3] = colors * pixels[..., 3:] // 255
    return Image(look.name, pixels, encoding)


def _as_in_file(look: ImageLook, pixels: np.ndarray) -> None:
    """Bring linear colors, which Blender has multiplied by alpha, to what Cycles makes of the file of floats.

    Cycles does not ask whether the user takes the file's colors for straight.
    """
    if look.is_srgb or look.alpha_mode == "STRAIGHT":
        alpha = np.where(pixels[..., 3:] > 0.0, pixels[..., 3:], np.float32(1.0))
        pixels[..., :3] /= alpha
        if look.is_srgb:
            pixels[..., :3] = encode_srgb(pixels[..., :3])
        if look.alpha_mode == "PREMUL":
            pixels[..., :3] *= alpha
    if not _MULTIPLIED_BY_ALPHA[look.file_format]:
        pixels[..., :3] *= pixels[..., 3:]


def _times_alpha(pixels: np.ndarray) -> np.ndarray:
    """(height, width, 3) uint16 colors of bytes, multiplied by their alpha and rounded."""
    return (pixels[..., :3].astype(np.uint16) * pixels[..., 3:] + 127) // 255


def _bytes(pixels: np.ndarray) -> np.ndarray:
    """Bytes that Blender has given as numbers from 0 to 1."""
    flat, result = pixels.reshape(-1), np.empty(pixels.size, np.uint8)
    for start in range(0, len(flat), _PART):
        part = flat[start : start + _PART] * np.float32(255.0)
        result[start : start + _PART] = np.rint(part, out=part)
    return result.reshape(pixels.shape)


def is_associated(image: bpy.types.Image | None) -> bool:
    """Return True where colors come multiplied by alpha, and are divided by it where alpha is used as well."""
    return (
        image is not None
        and image.alpha_mode in {"STRAIGHT", "PREMUL"}
        and image.colorspace_settings.name not in {"Non-Color", "Raw"}
    )

# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender images to pixels, each exported once."""

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...scene import Image

if TYPE_CHECKING:
    from .values import Evaluator

_LINEAR_SPACES = {"Linear Rec.709", "Linear", "Non-Color", "Raw", "scene_linear"}


class ImageTable:
    """The images of a scene under export."""

    def __init__(self) -> None:
        self.images: list[Image] = []
        self._indices: dict[tuple, int | None] = {}
        self._means: dict[int, np.ndarray] = {}

    def index(self, image: bpy.types.Image, node: bpy.types.Node, evaluator: "Evaluator") -> int | None:
        """Index of the image, exported now if it is new; None, with a warning, when it has no pixels."""
        associated = _is_associated(image, node)
        key = (image.as_pointer(), associated)
        if key not in self._indices:
            exported = self._export(image, node, evaluator, associated)
            self._indices[key] = exported
            if exported is not None and _is_opaque(self.images[exported].pixels):
                self._indices[key[0], not associated] = exported
        index = self._indices[key]
        if index is None:
            place = image.filepath or "no file"
            evaluator.warn(node, f'needs image "{image.name}", which is missing ({place}); {_REMEDY}')
        return index

    def mean(self, index: int) -> np.ndarray:
        """Mean linear colour of an exported image, (3,) float64."""
        if index not in self._means:
            image = self.images[index]
            colors = image.pixels[..., :3]
            if image.encoding == "SRGB":
                self._means[index] = _SRGB_TO_LINEAR[colors.reshape(-1, 3)].mean(axis=0)
            elif colors.dtype == np.uint8:
                self._means[index] = colors.reshape(-1, 3).mean(axis=0) / 255.0
            else:
                self._means[index] = colors.reshape(-1, 3).mean(axis=0, dtype=np.float64)
        return self._means[index]

    def mean_alpha(self, image: bpy.types.Image, node: bpy.types.Node, evaluator: "Evaluator") -> float:
        """Mean opacity of an image, 1 when it is missing."""
        index = self.index(image, node, evaluator)
        if index is None:
            return 1.0
        alpha = self.images[index].pixels[..., 3]
        mean = float(alpha.mean(dtype=np.float64)) / (255.0 if alpha.dtype == np.uint8 else 1.0)
        if mean < 1.0:
            evaluator.warn(node, "gives an alpha that varies; its mean is used")
        return mean

    def _export(
        self, image: bpy.types.Image, node: bpy.types.Node, evaluator: "Evaluator", associated: bool
    ) -> int | None:
        pixels = read_pixels(image)
        if pixels is None:
            return None
        if image.source == "TILED":
            evaluator.warn(node, "uses UDIM tiles; only the first tile is rendered")
        space = image.colorspace_settings.name
        encoding = "LINEAR"
        if associated:
            pixels[..., :3] *= pixels[..., 3:]
        if not image.is_float:
            pixels = np.rint(np.clip(pixels, 0.0, 1.0) * 255.0).astype(np.uint8)
            encoding = "SRGB" if space == "sRGB" else "LINEAR"
        if space != "sRGB" and space not in _LINEAR_SPACES:
            evaluator.warn(node, f'has an image in the colour space "{space}", which is read as sRGB')
            encoding = "LINEAR" if image.is_float else "SRGB"
        self.images.append(Image(image.name, pixels, encoding))
        return len(self.images) - 1


def _is_associated(image: bpy.types.Image, node: bpy.types.Node) -> bool:
    """Whether a node shows colours times their alpha, while they are still encoded.

    Cycles does so unless the node's alpha is used as well.
    """
    alpha = node.outputs.get("Alpha")
    has_alpha = image.alpha_mode in {"STRAIGHT", "PREMUL"} and image.colorspace_settings.name not in _DATA
    return has_alpha and not image.is_float and not (alpha is not None and alpha.is_linked)


def _is_opaque(pixels: np.ndarray) -> bool:
    return bool((pixels[..., 3] == (255 if pixels.dtype == np.uint8 else 1.0)).all())


_DATA = {"Non-Color", "Raw"}
_REMEDY = "find it with File > External Data > Find Missing Files; magenta stands in"

_SRGB_TO_LINEAR = np.arange(256) / 255.0
_SRGB_TO_LINEAR = np.where(
    _SRGB_TO_LINEAR <= 0.04045, _SRGB_TO_LINEAR / 12.92, ((_SRGB_TO_LINEAR + 0.055) / 1.055) ** 2.4
)


def read_pixels(image: bpy.types.Image) -> np.ndarray | None:
    """Pixels as Blender stores them, (height, width, 4) float32, row 0 at the bottom.

    None when the image has none, as when its file is missing.
    """
    width, height = image.size
    if width < 1 or height < 1:
        return None
    channels = image.channels
    flat = np.empty(width * height * channels, np.float32)
    try:
        image.pixels.foreach_get(flat)
    except (RuntimeError, TypeError):
        return None
    if not image.has_data:
        return None
    stored = np.nan_to_num(flat.reshape(height, width, channels), copy=False, nan=0.0, posinf=65504.0, neginf=0.0)
    if channels == 4:
        return stored
    pixels = np.ones((height, width, 4), np.float32)
    if channels == 3:
        pixels[..., :3] = stored
    else:
        pixels[..., :3] = stored[..., :1]
        if channels == 2:
            pixels[..., 3] = stored[..., 1]
    return pixels

# SPDX-License-Identifier: GPL-3.0-or-later
"""What materials emit."""

import numpy as np

from ..scene.images import Image
from ..scene.materials import Lobe, LobeKind, Material


def image_means(images: list[Image]) -> list[np.ndarray]:
    """Mean colour of each image, (3,), in the image's own encoding."""

    def mean(image: Image) -> np.ndarray:
        scale = 255.0 if image.pixels.dtype == np.uint8 else 1.0
        return image.pixels.reshape(-1, 4).mean(axis=0, dtype=np.float64)[:3] / scale

    return [mean(image) for image in images]


def emitted_radiance(material: Material, image_means: list[np.ndarray]) -> np.ndarray:
    """(3,) radiance that a material emits, W/(m^2 sr); textures count by their mean."""

    def of(lobe: Lobe) -> np.ndarray:
        if lobe.kind is LobeKind.EMISSION:
            texture = image_means[lobe.color_image] if lobe.color_image >= 0 else 1.0
            return lobe.weight * np.asarray(lobe.color) * texture
        if lobe.kind is LobeKind.PRINCIPLED:
            return lobe.weight * lobe.alpha * np.asarray(lobe.emission)
        return np.zeros(3)

    return np.maximum(sum((of(lobe) for lobe in material.lobes), np.zeros(3)), 0.0)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials and images in GPU buffers, as shaders/materials/ reads them."""

import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..scene.images import Image
from ..scene.materials import Lobe, LobeKind, Material
from . import albedo_tables
from .emitted import emitted_radiance, image_means
from .records import IMAGE_ENTRY, MATERIAL, MATERIAL_LOBE, NO_IMAGE

DEFAULT_MATERIAL = Material("default", [Lobe(LobeKind.DIFFUSE, color=(0.8, 0.8, 0.8))])
"""What faces without a material look like, as in Blender."""

_SRGB, _BYTES, _HALVES = 0, 1, 2


def _texels(image: Image) -> tuple[np.ndarray, int]:
    pixels = np.ascontiguousarray(image.pixels)
    if pixels.dtype == np.uint8:
        return pixels.reshape(-1, 4).view(np.uint32).ravel(), _SRGB if image.encoding == "SRGB" else _BYTES
    halves = np.clip(np.nan_to_num(pixels), -65504, 65504).astype(np.float16)
    return halves.reshape(-1, 4).view(np.uint32).ravel(), _HALVES


class MaterialTables:
    """The buffers Materials, MaterialLobes, Images, Texels and AlbedoTables."""

    def __init__(self, context: Context) -> None:
        names = ("Materials", "MaterialLobes", "Images", "Texels", "AlbedoTables")
        self._buffers = {
            name: GrowingBuffer(context, f"material {name}", "use smaller or fewer image textures") for name in names
        }
        self._buffers["AlbedoTables"].upload(albedo_tables.load())
        self.default_material = 0
        self.emitted = np.zeros((1, 3))

    @property
    def buffers(self) -> dict:
        """moderngl buffers by block name."""
        return {name: buffer.buffer for name, buffer in self._buffers.items()}

    @property
    def memory_bytes(self) -> dict[str, int]:
        return {buffer.name: buffer.size for buffer in self._buffers.values()}

    def build(self, materials: list[Material], images: list[Image]) -> None:
        """Upload the materials, and the images that their lobes use.

        ``default_material`` is afterwards the index of the material for faces without one, and
        ``emitted`` (materials + 1, 3) the radiance of each, W/(m^2 sr).
        """
        self.default_material = len(materials)
        lobes = [lobe for material in [*materials, DEFAULT_MATERIAL] for lobe in material.lobes]
        used = sorted({lobe.color_image for lobe in lobes if lobe.color_image >= 0})
        place = {image: index for index, image in enumerate(used)}
        entries = IMAGE_ENTRY.zeros(max(1, len(used)))
        texels, first = [], 0
        for entry, image in zip(entries, used, strict=False):
            data, kind = _texels(images[image])
            height, width = images[image].pixels.shape[:2]
            entry["first_texel"], entry["width"], entry["height"], entry["format"] = first, width, height, kind
            texels.append(data)
            first += len(data)

        means = image_means(images)
        self.emitted = np.array([emitted_radiance(material, means) for material in [*materials, DEFAULT_MATERIAL]])
        material_records = MATERIAL.zeros(len(materials) + 1)
        lobe_records = MATERIAL_LOBE.zeros(max(1, len(lobes)))
        material_records["emitted"] = self.emitted.mean(axis=1)
        position = 0
        for record, material in zip(material_records, [*materials, DEFAULT_MATERIAL], strict=True):
            record["absorption"] = np.maximum(material.absorption, 0.0)
            record["first_lobe"], record["lobe_count"] = position, len(material.lobes)
            for lobe in material.lobes:
                _fill_lobe(lobe_records[position], lobe, place.get(lobe.color_image, NO_IMAGE))
                position += 1
        self._buffers["Materials"].upload(material_records)
        self._buffers["MaterialLobes"].upload(lobe_records)
        self._buffers["Images"].upload(entries)
        self._buffers["Texels"].upload(np.concatenate(texels) if texels else np.zeros(1, np.uint32))

    def release(self) -> None:
        for buffer in self._buffers.values():
            buffer.release()


def _fill_lobe(record: np.ndarray, lobe: Lobe, image: int) -> None:
    """Clamp what a user may have typed to what the formulas take."""
    record["kind"], record["color_image"], record["weight"] = int(lobe.kind), image, lobe.weight
    record["color"] = np.maximum(lobe.color, 0.0)
    record["specular_tint"], record["emission"] = np.maximum(lobe.specular_tint, 0.0), np.maximum(lobe.emission, 0.0)
    record["roughness"] = np.clip(lobe.roughness, 0.0, 1.0)
    record["ior"] = np.clip(lobe.ior, 1e-3, 1e3)
    record["specular_level"] = max(lobe.specular_level, 0.0)
    for name in ("metallic", "transmission", "alpha"):
        record[name] = np.clip(getattr(lobe, name), 0.0, 1.0)
    record["multiscatter"] = lobe.multiscatter

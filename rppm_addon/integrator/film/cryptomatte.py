# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte: means over the iterations of what covers each pixel, by object, material and asset."""

import enum
from collections.abc import Callable, Mapping

import numpy as np

from ...gl.buffer_sets import BufferSet, ComputeShader, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.cryptomatte import (
    ASSETS,
    DEFAULT_MATERIAL,
    MATERIALS,
    OBJECTS,
    asset_of,
    identifiers_of,
    joined,
    layers_of,
    split,
)
from ...scene.passes import CRYPTOMATTE_PAIRS
from ..camera_paths.importons import Importons
from ..common.band import Band
from ..common.film_buffers import FilmBuffer
from ..common.stage_sizes import StageSizes, band_pixels
from ..device_scene.stage_context import StageContext

Record(
    "CryptomatteParameters",
    segment="uint",
    pair_count="uint",
    names="uint",
    any_catchers="uint",
)


class _Names(enum.IntEnum):
    """Kinds of names of a layer."""

    OF_INSTANCES = 0
    OF_MATERIALS = 1


Constants("CryptomatteNames", NAMES=_Names)


def _pairs(layer: str) -> Callable[[StageSizes], int]:
    def count(sizes: StageSizes) -> int:
        return CRYPTOMATTE_PAIRS * len(layers_of(sizes.passes).get(layer, ()))

    return count


def _caught_paths(sizes: StageSizes) -> int:
    return band_pixels(sizes) if sizes.has_catchers else 0


class Cryptomatte(BufferSet):
    """Pairs of an identifier and the fraction that it covers, 8 bytes each, as many a pixel as the passes of a layer
    have."""

    remedy = "lower the resolution or the levels of Cryptomatte"
    _objects = FilmBuffer("cryptomatte of objects", "uvec2", _pairs(OBJECTS))
    _materials = FilmBuffer("cryptomatte of materials", "uvec2", _pairs(MATERIALS))
    _assets = FilmBuffer("cryptomatte of assets", "uvec2", _pairs(ASSETS))
    _caught_after = StorageBuffer("paths behind shadow catchers", "uint", _caught_paths, block="CaughtAfter")
    _object_names = StorageBuffer("identifiers of objects", "uint")
    _material_names = StorageBuffer("identifiers of materials", "uint")
    _asset_names = StorageBuffer("identifiers of assets", "uint")
    _program = ComputeShader("film/cryptomatte/cover.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._layers = layers_of(sizes.passes)
        self._buffers = {
            OBJECTS: (self._objects, self._object_names),
            MATERIALS: (self._materials, self._material_names),
            ASSETS: (self._assets, self._asset_names),
        }
        self._known: dict[str, list[str]] = {}
        """Names whose identifiers are on the device, by layer."""

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """BufferSet.is_needed: for passes of Cryptomatte."""
        return bool(layers_of(sizes.passes))

    def add(self, context: StageContext, importons: Importons, band: Band, segment: int) -> None:
        """Add the surfaces that the camera paths of a band have come to in a segment, before they scatter on."""
        if not self.is_on:
            return
        for layer, entries in self._layers.items():
            pairs, names = self._buffers[layer]
            if segment == 0:
                self._upload_names(context, layer)
            importons.active.run(
                self._program,
                {
                    **context.blocks,
                    **importons.blocks,
                    **self.blocks,
                    "Identifiers": names.buffer,
                    "Pairs": pairs.of(band),
                },
                {
                    "segment": segment,
                    "pair_count": CRYPTOMATTE_PAIRS * len(entries),
                    "names": _Names.OF_MATERIALS if layer == MATERIALS else _Names.OF_INSTANCES,
                    "any_catchers": self._caught_after.size > 0,
                },
            )

    def _upload_names(self, context: StageContext, layer: str) -> None:
        """See to it that the identifiers are those of the scene, which may have moved or be another one."""
        scene = context.scene
        if layer == MATERIALS:
            names = [*(material.name for material in scene.materials), DEFAULT_MATERIAL]
            names += [names[material] for _, material in context.materials.media.places.copies]
        else:
            names = [placement.instance.object_name for placement in context.geometry.placements]
            if layer == ASSETS:
                names = [asset_of(scene, name) for name in names]
        if names != self._known.get(layer):
            self._buffers[layer][1].upload(identifiers_of(names))
            self._known[layer] = names

    def read(self) -> dict[str, np.ndarray]:
        """The passes by name, (height, width, 4) float32, in each pixel in the order in which things were found."""
        found: dict[str, np.ndarray] = {}
        for layer, entries in self._layers.items():
            count = CRYPTOMATTE_PAIRS * len(entries)
            words = self._buffers[layer][0].read(np.float32, 2 * count)
            found |= split(entries, words.reshape(*words.shape[:2], count, 2))
        return found

    def restore(self, passes: Mapping[str, np.ndarray]) -> None:
        """Take what ``read`` gave; KeyError where a pass misses."""
        for layer, entries in self._layers.items():
            self._buffers[layer][0].upload(joined(entries, passes))

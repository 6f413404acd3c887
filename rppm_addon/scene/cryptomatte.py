# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte: passes that show compositors which object, material or asset covers how much of a pixel.

Friedman and Jones, Fully automatic ID mattes with support for motion blur and transparency, 2015; names, hashes and
metadata as in the Cryptomatte specification 1.2 and in Cycles.
"""

import functools
import json
from collections.abc import Iterable, Mapping

import numpy as np

from .passes import CRYPTOMATTE_PAIRS, PASSES, Accumulation, RenderPass, passes_named
from .scene import Scene

OBJECTS, MATERIALS, ASSETS = LAYERS = ("CryptoObject", "CryptoMaterial", "CryptoAsset")
"""Layers: the passes of each are named after it, with a number behind."""
DEFAULT_MATERIAL = "default_surface"
"""Name that Cycles gives to the material of faces without one."""


@functools.lru_cache(1 << 16)
def hash_of(name: str) -> int:
    """MurmurHash3 (Appleby), x86, 32 bits, seed 0, of a name in UTF-8."""

    def rotated(value: int, bits: int) -> int:
        return (value << bits | value >> (32 - bits)) & 0xFFFFFFFF

    def scrambled(block: bytes) -> int:
        value = int.from_bytes(block, "little") * 0xCC9E2D51 & 0xFFFFFFFF
        return rotated(value, 15) * 0x1B873593 & 0xFFFFFFFF

    data = name.encode()
    whole = len(data) // 4 * 4
    state = 0
    for start in range(0, whole, 4):
        state = (rotated(state ^ scrambled(data[start : start + 4]), 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    state ^= scrambled(data[whole:]) ^ len(data)
    state = (state ^ state >> 16) * 0x85EBCA6B & 0xFFFFFFFF
    state = (state ^ state >> 13) * 0xC2B2AE35 & 0xFFFFFFFF
    return state ^ state >> 16


def identifiers_of(names: Iterable[str]) -> np.ndarray:
    """(n,) uint32: the bits of the floats that stand for names. None is 0, infinite, no number or denormal."""
    hashes = np.array([hash_of(name) for name in names], np.uint32)
    exponents = np.clip(hashes >> np.uint32(23) & np.uint32(0xFF), 1, 254).astype(np.uint32)
    return hashes & np.uint32(0x807FFFFF) | exponents << np.uint32(23)


def layer_of(entry: RenderPass) -> str:
    """The layer that a pass of accumulation COVERAGE is part of."""
    return entry.name[:-2]


def layers_of(passes: Iterable[RenderPass]) -> dict[str, tuple[RenderPass, ...]]:
    """The passes of each layer that has any, by level."""
    found: dict[str, tuple[RenderPass, ...]] = {}
    for entry in passes:
        if entry.accumulation is Accumulation.COVERAGE:
            found[layer_of(entry)] = (*found.get(layer_of(entry), ()), entry)
    return found


def split(entries: Iterable[RenderPass], pairs: np.ndarray) -> dict[str, np.ndarray]:
    """Pairs (height, width, n, 2) float32 of a layer as its passes (height, width, 4)."""
    height, width = pairs.shape[:2]
    parts = pairs.reshape(height, width, -1, 2 * CRYPTOMATTE_PAIRS)
    return {entry.name: np.ascontiguousarray(parts[:, :, part]) for part, entry in enumerate(entries)}


def joined(entries: Iterable[RenderPass], passes: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the pairs (height, width, n, 2) that split took apart. Raises KeyError where a pass is missing."""
    parts = np.concatenate([passes[entry.name] for entry in entries], axis=-1)
    return parts.reshape(*parts.shape[:2], -1, 2)


def ranked(passes: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The passes of a film as compositors want them: in each pixel the largest fractions first."""
    layers = layers_of(entry for entry in PASSES if entry.name in passes)
    found = dict(passes)
    for entries in layers.values():
        pairs = joined(entries, passes)
        order = np.argsort(-pairs[..., 1], axis=-1, kind="stable")
        found |= split(entries, np.take_along_axis(pairs, order[..., None], axis=2))
    return found


class MergedCoverage:
    """The pairs of a layer over the iterations of several parts."""

    def __init__(self, entries: tuple[RenderPass, ...]) -> None:
        self.entries = entries
        """The passes of the layer."""
        self._identifiers: np.ndarray | None = None
        self._sums: np.ndarray | None = None

    def add(self, pairs: np.ndarray, iterations: int) -> None:
        """Add what (height, width, n, 2) float32 pairs a part of so many iterations has."""
        sums = pairs[..., 1].astype(np.float64) * iterations
        if self._identifiers is None or self._sums is None:
            self._identifiers, self._sums = pairs[..., 0].copy(), sums
            return
        for slot in range(pairs.shape[2]):
            identifier = pairs[..., slot, 0]
            # As the film has it: what finds no place counts for the last one.
            free = (self._identifiers == identifier[..., None]) | (self._identifiers == 0.0)
            place = np.where(free.any(axis=-1), free.argmax(axis=-1), pairs.shape[2] - 1)[..., None]
            before = np.take_along_axis(self._identifiers, place, axis=-1)
            held = np.where(before == 0.0, identifier[..., None], before)
            np.put_along_axis(self._identifiers, place, held, axis=-1)
            total = np.take_along_axis(self._sums, place, axis=-1) + sums[..., slot, None]
            np.put_along_axis(self._sums, place, total, axis=-1)

    def pairs(self, iterations: int) -> np.ndarray:
        """(height, width, n, 2) float32, of all iterations."""
        assert self._identifiers is not None and self._sums is not None
        return np.stack([self._identifiers, (self._sums / iterations).astype(np.float32)], axis=-1)


def asset_of(scene: Scene, object_name: str) -> str:
    """The name of the object that stands above all that an object belongs to: its topmost parent, or itself."""
    return scene.asset_names.get(object_name, object_name)


def names_in(layer: str, scene: Scene) -> list[str]:
    """All names that a layer of a scene may have, each once."""
    if layer == MATERIALS:
        return list(dict.fromkeys([*(material.name for material in scene.materials), DEFAULT_MATERIAL]))
    many = (array.first for array in scene.instance_arrays)
    objects = dict.fromkeys(instance.object_name for instance in (*scene.instances, *many))
    return list(objects if layer == OBJECTS else dict.fromkeys(asset_of(scene, name) for name in objects))


def metadata(scene: Scene, prefix: str = "") -> dict[str, str]:
    """Attributes by which compositors find the layers of a scene's picture, and the names in them.

    prefix: what comes before the names of passes in the file, such as "ViewLayer.".
    """
    found: dict[str, str] = {}
    for layer in layers_of(passes_named(scene.settings.passes)):
        name = prefix + layer
        key = f"cryptomatte/{hash_of(name):08x}"[: len("cryptomatte/") + 7]
        manifest = {member: f"{hash_of(member):08x}" for member in names_in(layer, scene)}
        found |= {
            f"{key}/name": name,
            f"{key}/hash": "MurmurHash3_32",
            f"{key}/conversion": "uint32_to_float32",
            f"{key}/manifest": json.dumps(manifest, ensure_ascii=False, separators=(",", ":")),
        }
    return found

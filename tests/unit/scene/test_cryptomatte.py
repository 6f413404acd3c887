# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte's names, hashes, ranks and sums."""

import json
import random

import numpy as np
import pytest
from support.floor import floor_scene

from rppm_addon.scene import cryptomatte
from rppm_addon.scene.passes import passes_named

LAYER = passes_named(["CryptoObject00", "CryptoObject01"])


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("", 0),
        ("hello", 0x248BFA47),
        ("hello, world", 0x149BBB7F),
        ("The quick brown fox jumps over the lazy dog", 0x2E4FF723),
    ],
)
def test_hashes_are_those_of_murmur(name, expected):
    """Appleby's MurmurHash3_x86_32, as published for these texts."""
    assert cryptomatte.hash_of(name) == expected


def test_identifiers_are_floats_that_every_file_keeps():
    names = [f"Object.{number:05d}" for number in range(3000)]
    bits = cryptomatte.identifiers_of(names)
    floats = bits.view(np.float32)
    assert np.isfinite(floats).all() and (np.abs(floats) >= np.finfo(np.float32).tiny).all()
    hashes = np.array([cryptomatte.hash_of(name) for name in names], np.uint32)
    assert ((bits != hashes) & ((hashes >> 23 & 0xFF) % 255 > 0)).sum() == 0
    assert (bits != hashes).any()  # some hash is no usual float


def test_the_largest_share_comes_first():
    pairs = np.array([[7, 0.25], [-3, 0.5], [9, 0.25], [0, 0]], np.float32).reshape(1, 1, 4, 2)
    ranked = cryptomatte.ranked({**cryptomatte.split(LAYER, pairs), "Depth": np.ones((1, 1), np.float32)})
    np.testing.assert_array_equal(ranked["CryptoObject00"][0, 0], (-3, 0.5, 7, 0.25))
    np.testing.assert_array_equal(ranked["CryptoObject01"][0, 0], (9, 0.25, 0, 0))
    assert ranked["Depth"] == 1.0


def found_by(iterations: list[list[int]]) -> np.ndarray:
    """The pairs of one pixel of a film whose iterations each found identifiers, in equal shares."""
    shares: dict[int, float] = {}
    for found in iterations:
        for identifier in found:
            shares[identifier] = shares.get(identifier, 0.0) + 1.0 / (len(found) * len(iterations))
    pairs = np.zeros((1, 1, 4, 2), np.float32)
    for place, (identifier, share) in enumerate(shares.items()):
        pairs[0, 0, place] = identifier, share
    return pairs


def test_parts_merge_to_the_whole():
    chance = random.Random(3)
    iterations = [chance.sample([5, -6, 7, 8], chance.randint(0, 3)) for _ in range(12)]
    merged = cryptomatte.MergedCoverage(LAYER)
    for first, end in ((0, 2), (2, 3), (3, 12)):
        merged.add(found_by(iterations[first:end]), end - first)
    whole = {identifier: share for identifier, share in found_by(iterations)[0, 0] if share > 0}
    result = {identifier: share for identifier, share in merged.pairs(12)[0, 0] if share > 0}
    assert result == pytest.approx(whole, rel=1e-6) and len(whole) == 4


def test_what_finds_no_place_counts_for_the_last_pair():
    merged = cryptomatte.MergedCoverage(LAYER)
    merged.add(found_by([[1, 2, 3, 4]]), 1)
    merged.add(found_by([[5], [2]]), 2)
    shares = {int(identifier): share for identifier, share in merged.pairs(3)[0, 0]}
    assert shares == pytest.approx({1: 1 / 12, 2: 5 / 12, 3: 1 / 12, 4: 5 / 12})


def test_metadata_names_layers_and_what_is_in_them():
    scene = floor_scene()
    scene.settings.passes = ("CryptoObject00", "CryptoMaterial00", "CryptoMaterial01", "CryptoAsset00")
    scene.instances[0].object_name = 'The "Floor" ß'
    scene.asset_names = {'The "Floor" ß': "House"}
    found = cryptomatte.metadata(scene, "ViewLayer.")
    layers = {name.split("/")[1]: value for name, value in found.items() if name.endswith("/name")}
    assert sorted(layers.values()) == ["ViewLayer.CryptoAsset", "ViewLayer.CryptoMaterial", "ViewLayer.CryptoObject"]
    manifests = {}
    for key, layer in layers.items():
        assert key == f"{cryptomatte.hash_of(layer):08x}"[:7]
        assert found[f"cryptomatte/{key}/hash"] == "MurmurHash3_32"
        assert found[f"cryptomatte/{key}/conversion"] == "uint32_to_float32"
        manifests[layer.partition(".")[2]] = json.loads(found[f"cryptomatte/{key}/manifest"])
    assert {name: list(names) for name, names in manifests.items()} == {
        "CryptoObject": ['The "Floor" ß'],
        "CryptoMaterial": ["Gray", "default_surface"],
        "CryptoAsset": ["House"],
    }
    assert manifests["CryptoAsset"]["House"] == f"{cryptomatte.hash_of('House'):08x}"
    scene.settings.passes = ("Depth",)
    assert cryptomatte.metadata(scene) == {}

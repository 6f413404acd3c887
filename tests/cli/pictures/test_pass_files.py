# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte, AOVs, light groups and what a picture tells of itself in the program's files, of parts as well."""

import numpy as np
import pytest
from cli.conftest import rppm_here, succeed
from support.floor import floor_scene

from rppm_addon.pictures import read_exr
from rppm_addon.scene import AovOutput, save_scene
from rppm_addon.scene.cryptomatte import identifiers_of, metadata


@pytest.fixture
def scene_file(tmp_path):
    scene = floor_scene()
    scene.settings = scene.settings.with_values(
        passes=("Depth", "CryptoObject00", "CryptoMaterial00", "Shadow Catcher"),
        aovs=("Mask.X", "Tint.RGBA"),
        light_groups=("key", "rim"),
    )
    scene.lights[0].light_group = "key"
    scene.materials[0].graph.aovs = [AovOutput("Mask", value=0.25), AovOutput("Tint", (0.1, 0.2, 0.3))]
    scene.stamps = {"Camera": "Above", "Frame": "007"}
    save_scene(scene, tmp_path / "scene.npz")
    return tmp_path / "scene.npz", scene


def check(picture, scene):
    """Check the contents of a picture's file."""
    assert {"Mask.X", *(f"Tint.{letter}" for letter in "RGBA"), "CryptoObject00.r"} < picture.channels.keys()
    pairs = picture.layer("CryptoObject00")[:, :7]
    assert (np.ascontiguousarray(pairs[..., 0]).view(np.uint32) == identifiers_of(["Floor"])).all()
    np.testing.assert_allclose(pairs[..., 1], 1.0, rtol=1e-6)
    tint = picture.layer("Tint")[:, :7]
    np.testing.assert_allclose(tint, np.broadcast_to((0.1, 0.2, 0.3, 1.0), tint.shape), rtol=1e-5)
    np.testing.assert_allclose(picture.layer("Mask")[:, :7], 0.25, rtol=1e-5)
    np.testing.assert_allclose(picture.layer("Combined_key"), picture.combined[..., :3], rtol=1e-5, atol=1e-6)
    assert not picture.layer("Combined_rim").any()
    assert picture.attributes.items() >= {**scene.stamps, **metadata(scene)}.items()


def test_a_file_has_its_passes_and_their_names(tmp_path, scene_file):
    file, scene = scene_file
    succeed(rppm_here, "render", file, "-o", tmp_path / "whole.exr", "--samples", 2)
    check(read_exr(tmp_path / "whole.exr"), scene)


@pytest.mark.long
def test_parts_give_the_file_of_the_whole(tmp_path, scene_file):
    file, scene = scene_file
    whole, first, second, merged = (tmp_path / f"{name}.exr" for name in ("whole", "first", "second", "merged"))
    for arguments in (
        ("render", file, "-o", whole, "--samples", 5),
        ("render", file, "-o", first, "--samples-range", "0:2"),
        ("render", file, "-o", second, "--samples-range", "2:5"),
        ("merge", first, second, "-o", merged),
    ):
        succeed(rppm_here, *arguments)
    expected, found = read_exr(whole), read_exr(merged)
    assert expected.channels.keys() == found.channels.keys()
    for name, values in expected.channels.items():
        np.testing.assert_allclose(found.channels[name], values, rtol=1e-5, atol=1e-6, err_msg=name)
    check(found, scene)

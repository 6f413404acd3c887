# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte coverage of objects, materials and assets, compared with Cycles."""

import bpy
import numpy as np
import OpenEXR
import pytest
from support.moving import animate, blur, taken_scene

from rppm_addon.scene.cryptomatte import LAYERS, identifiers_of, metadata, names_in

from ..engines import exported_scene
from ..scenes import DIFFUSE, PRINCIPLED, ball, camera, light, material, new_scene, place, plane

SAMPLES = 64
ALL_ROUND = (0.0, 0.0, 3.0)


@pytest.fixture
def things():
    """A floor, a ball, a pane that hides a quarter and belongs to the ball, a shadow catcher, and a holdout."""
    scene = new_scene(resolution=32, world=0.3)
    plane(1.5, material(DIFFUSE), place(at=(0.0, 0.0, -0.5)))
    round_one = ball(0.5, material(DIFFUSE), place())
    pane = plane(0.6, material(PRINCIPLED, Alpha=0.25), place(at=(-0.8, 0.6, 0.3)))
    catcher = plane(0.4, material(DIFFUSE), place(at=(0.9, -0.4, 0.4)))
    hole = plane(0.2, material(DIFFUSE), place(at=(-0.9, -0.9, 0.2)))
    bare = plane(0.2, material(DIFFUSE), place(at=(0.1, -0.9, -0.3)))
    bare.data.materials.clear()
    for thing in (pane, catcher, hole, bare):
        thing.rotation_euler = (1.3, 0.0, 0.3)
    pane.parent, catcher.is_shadow_catcher, hole.is_holdout = round_one, True, True
    light("POINT", 10.0, place(at=ALL_ROUND))
    camera((0.3, -3.0, 1.2), (0.0, 0.0, 0.0))
    layer = scene.view_layers[0]
    layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
    layer.use_pass_cryptomatte_asset, layer.pass_cryptomatte_depth = True, 6
    return scene


def cycles_file(scene: bpy.types.Scene, path) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """(H, W, 4) by pass of Cryptomatte, row 0 at the bottom, and the attributes of the file."""
    scene.render.engine, scene.cycles.samples = "CYCLES", SAMPLES
    scene.render.filepath = str(path / "cycles.exr")
    bpy.ops.render.render(write_still=True)
    with OpenEXR.File(scene.render.filepath, separate_channels=True) as file:
        passes = {}
        for part in file.parts:
            channels = {name.rpartition(".")[2]: channel.pixels[::-1] for name, channel in part.channels.items()}
            if "r" in channels:
                passes[part.name().partition(".")[2]] = np.stack([channels[letter] for letter in "rgba"], axis=-1)
        return passes, {name: value for name, value in file.header().items() if name.startswith("cryptomatte/")}


def coverage(passes: dict[str, np.ndarray], layer: str, name: str) -> np.ndarray:
    """(H, W) share of each pixel that something of this name covers."""
    pairs = np.stack([values for key, values in sorted(passes.items()) if key.startswith(layer)])
    pairs = np.moveaxis(pairs.reshape(*pairs.shape[:3], 2, 2), 0, 2)
    identifier = identifiers_of([name]).view(np.float32)[0]
    return np.where(pairs[..., 0] == identifier, pairs[..., 1], 0.0).sum(axis=(2, 3))


def test_coverage_and_names_are_those_of_cycles(renderer, things, tmp_path):
    theirs, attributes = cycles_file(things, tmp_path)
    scene = exported_scene()
    scene.settings = scene.settings.with_values(iterations=SAMPLES, photons=64, filter_width=1.5)
    mine = renderer.render(scene).frame.passes
    assert theirs.keys() == {name for name in mine if name.startswith("Crypto")} and len(theirs) == 9
    assert attributes.keys() == metadata(scene, "ViewLayer.").keys()
    for layer in LAYERS:
        for name in names_in(layer, scene):
            expected, found = coverage(theirs, layer, name), coverage(mine, layer, name)
            # Of all that a name covers within 1 %; in a pixel at an edge within its own noise, five times sqrt(1 / 4n),
            # twice: both have some.
            assert found.sum() == pytest.approx(expected.sum(), rel=0.01, abs=1.0), (layer, name)
            np.testing.assert_allclose(found, expected, atol=2 * 2.5 / np.sqrt(SAMPLES), err_msg=f"{layer} {name}")
            assert np.abs(found - expected).mean() < 0.01
    assert set(names_in("CryptoAsset", scene)) == {"Mesh", "Mesh.001", "Mesh.003", "Mesh.004", "Mesh.005"}


def test_coverage_of_what_is_blurred_is_that_of_cycles(renderer, tmp_path):
    scene = new_scene(resolution=32, world=0.3)
    plane(3.0, material(DIFFUSE), place(at=(0.0, 0.0, -0.5)))
    animate(ball(0.4, material(DIFFUSE), place()), "location", (-1.0, 0.0, 0.2), (0.0, 0.0, 0.2), (1.0, 0.0, 0.2))
    light("POINT", 10.0, place(at=ALL_ROUND))
    camera((0.0, -3.0, 1.2), (0.0, 0.0, 0.0))
    layer = scene.view_layers[0]
    layer.use_pass_cryptomatte_object, layer.pass_cryptomatte_depth = True, 2
    blur()
    theirs, _ = cycles_file(scene, tmp_path)
    exported = taken_scene()
    exported.settings = exported.settings.with_values(iterations=SAMPLES, photons=64, filter_width=1.5)
    mine = renderer.render(exported).frame.passes
    for name in ("Mesh", "Mesh.001"):
        expected, found = coverage(theirs, "CryptoObject", name), coverage(mine, "CryptoObject", name)
        assert found.sum() == pytest.approx(expected.sum(), rel=0.01)
        # Cycles' moments are random in each pixel.
        np.testing.assert_allclose(found, expected, atol=2 * 2.5 / np.sqrt(SAMPLES), err_msg=name)
        assert 0.2 < np.median(expected[(expected > 0.05) & (expected < 0.95)]) < 0.8

# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of the first surface beside Cycles' of the same name, pixel by pixel."""

import bpy
import numpy as np
import OpenEXR
import pytest

from rppm_addon.scene.passes import FILM_PASSES

from .scenes import (
    DIFFUSE,
    EMISSION,
    GLOSSY,
    ball,
    camera,
    exported_scene,
    light,
    material,
    new_scene,
    place,
    plane,
)  # fmt: skip

WORLD, MIRROR = 0.3, (0.9, 0.8, 0.7)
NOT_FILTERED = 0.01
"""Pixels of a filter that looks through their middles."""


@pytest.fixture
def surfaces():
    """A plane that has a UV map, a ball that has none, a ball that shines, a mirror, and a gray world beyond them."""
    world = new_scene(world=WORLD).world
    world.mist_settings.start, world.mist_settings.depth, world.mist_settings.falloff = 2.0, 3.0, "QUADRATIC"
    floor = plane(1.5, material(DIFFUSE), place(at=(0.0, 0.0, -0.5)))
    layer = floor.data.uv_layers.new(name="Map")
    layer.uv.foreach_set("vector", [0.1, 0.2, 0.9, 0.3, 1.7, 2.0, -0.4, 0.8])
    round_one = ball(0.5, material(DIFFUSE), place())
    while round_one.data.uv_layers:
        round_one.data.uv_layers.remove(round_one.data.uv_layers[0])
    shining = ball(0.2, material(EMISSION, Color=(1.0, 0.5, 0.2), Strength=0.8), place(at=(0.8, -0.4, 0.4)))
    mirror = plane(0.6, material(GLOSSY, Color=MIRROR, Roughness=0.0), place(at=(-0.8, 0.6, 0.3)))
    mirror.rotation_euler = (1.3, 0.0, 0.3)
    for number, thing in enumerate((floor, round_one, shining, mirror)):
        thing.pass_index, thing.data.materials[0].pass_index = 3 + number, 40 + 7 * number
    light("POINT", 10.0, place(at=(0.0, 0.0, 3.0)))
    camera((0.3, -3.0, 1.2), (0.0, 0.0, 0.0))
    scene = bpy.context.scene
    for entry in FILM_PASSES:
        if entry.switch:
            setattr(scene.view_layers[0], entry.switch, True)
    scene.view_layers[0].cycles.denoising_store_passes = True
    return scene


def cycles_channels(scene: bpy.types.Scene, path) -> dict[str, np.ndarray]:
    """(H, W) by the name of pass and channel, row 0 at the bottom."""
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "GAUSSIAN", NOT_FILTERED
    scene.render.filepath = str(path / "cycles.exr")
    bpy.ops.render.render(write_still=True)
    parts = OpenEXR.File(scene.render.filepath, separate_channels=True).parts
    return {name.split(".", 1)[1]: channel.pixels[::-1] for part in parts for name, channel in part.channels.items()}


def mirrored_world_once(expected: dict[str, np.ndarray]) -> list[np.ndarray]:
    """Cycles' albedo: of the light that it sees in mirrors, it counts the mirror's color twice."""
    planes = [expected[f"Denoising Albedo.{channel}"] for channel in "RGB"]
    twice = np.isclose(planes, WORLD * np.reshape(MIRROR, (3, 1, 1)) ** 2).all(axis=0)
    assert twice.sum() > 100
    return [np.where(twice, WORLD * color, plane) for color, plane in zip(MIRROR, planes, strict=True)]


def test_every_pass_of_blender_is_that_of_cycles(renderer, surfaces, tmp_path):
    expected = cycles_channels(surfaces, tmp_path)
    scene = exported_scene()
    names = tuple(entry.name for entry in FILM_PASSES)
    assert {entry.name for entry in FILM_PASSES if entry.switch} <= set(scene.settings.passes)
    scene.settings = scene.settings.with_values(filter_width=0.0, iterations=1, photons=64, passes=names)
    frame = renderer.render(scene).frame
    expected |= dict(zip(("Denoising Albedo." + c for c in "RGB"), mirrored_world_once(expected), strict=True))
    for entry in FILM_PASSES:
        mine = np.atleast_3d(frame.passes[entry.name])
        theirs = np.stack([expected[layer] for layer in entry.layers], axis=-1)
        same = np.isclose(mine, theirs, rtol=2e-3, atol=2e-3).all(axis=-1)
        assert same.mean() > 0.98, f"{entry.name}: more than edges differ"
        assert theirs.std() > 0.0, f"{entry.name}: nothing is shown"

# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of the first surface beside Cycles' of the same name, pixel by pixel."""

import bpy
import numpy as np
import OpenEXR
import pytest

from rppm_addon.scene.passes import FILM_PASSES

from .scenes import DIFFUSE, ball, camera, exported_scene, light, material, new_scene, place, plane

NOT_FILTERED = 0.01
"""Pixels of a filter that looks through their middles."""


@pytest.fixture
def surfaces():
    """A plane that has a UV map, a ball that has none, and nothing beyond them."""
    new_scene(world=0.0)
    floor = plane(1.5, material(DIFFUSE), place(at=(0.0, 0.0, -0.5)))
    layer = floor.data.uv_layers.new(name="Map")
    layer.uv.foreach_set("vector", [0.1, 0.2, 0.9, 0.3, 1.7, 2.0, -0.4, 0.8])
    round_one = ball(0.5, material(DIFFUSE), place())
    while round_one.data.uv_layers:
        round_one.data.uv_layers.remove(round_one.data.uv_layers[0])
    light("POINT", 10.0, place(at=(0.0, 0.0, 3.0)))
    camera((0.3, -3.0, 1.2), (0.0, 0.0, 0.0))
    scene = bpy.context.scene
    for entry in FILM_PASSES:
        if entry.switch:
            setattr(scene.view_layers[0], entry.switch, True)
    return scene


def cycles_channels(scene: bpy.types.Scene, path) -> dict[str, np.ndarray]:
    """(H, W) by the name of pass and channel, row 0 at the bottom."""
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "GAUSSIAN", NOT_FILTERED
    scene.render.filepath = str(path / "cycles.exr")
    bpy.ops.render.render(write_still=True)
    parts = OpenEXR.File(scene.render.filepath, separate_channels=True).parts
    return {name.split(".", 1)[1]: channel.pixels[::-1] for part in parts for name, channel in part.channels.items()}


def test_every_pass_of_blender_is_that_of_cycles(renderer, surfaces, tmp_path):
    expected = cycles_channels(surfaces, tmp_path)
    scene = exported_scene()
    scene.settings = scene.settings.with_values(filter_width=0.0, iterations=1, photons=64)
    frame = renderer.render(scene).frame
    compared = [entry for entry in FILM_PASSES if entry.switch]
    assert {entry.name for entry in compared} <= set(frame.passes)
    for entry in compared:
        mine = np.atleast_3d(frame.passes[entry.name])
        theirs = np.stack([expected[layer] for layer in entry.layers], axis=-1)
        same = np.isclose(mine, theirs, rtol=2e-3, atol=2e-3).all(axis=-1)
        assert same.mean() > 0.98, f"{entry.name}: more than edges differ"
        assert theirs.std() > 0.0, f"{entry.name}: nothing is shown"

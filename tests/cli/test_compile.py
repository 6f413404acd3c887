# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm compile: programs that are ready before the first picture."""

import dataclasses
import re

from support.floor import floor_scene

from cli.conftest import succeed
from rppm_addon.commands.compiling import small_scene
from rppm_addon.scene import Camera


def test_programs_are_counted(rppm, saved_scene):
    output, errors = succeed(rppm, "compile", saved_scene, timeout=400)
    count = int(re.match(r"(\d+) programs ready for .+ in [\d.]+ s", output)[1])
    assert count > 20
    shown = [int(percent) for percent in re.findall(r"(\d+)%.*Compiling: ", errors)]
    assert all(0 <= percent <= 100 for percent in shown) and shown == sorted(shown)


def test_a_scene_is_made_small_in_its_proportions():
    scene = floor_scene()
    scene.camera = dataclasses.replace(scene.camera, width=1920, height=1080)
    scene.settings = dataclasses.replace(scene.settings, photons=1 << 20, iterations=1000, time_limit=5.0)
    small = small_scene(scene)
    assert isinstance(small.camera, Camera) and small.camera.resolution == (64, 36)
    assert (small.settings.photons, small.settings.iterations, small.settings.time_limit) == (1024, 2, 0.0)
    assert (scene.camera.width, scene.settings.photons) == (1920, 1 << 20)
    scene.camera = dataclasses.replace(scene.camera, width=7, height=3)
    assert small_scene(scene).camera.resolution == (7, 3)

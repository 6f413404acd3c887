# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes whose faces lie in the same plane as those of others: paths cross both, in the right order."""

import fog
import numpy as np
import pytest
import scenes
from boxes import Box, passed
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import World

RED, BLUE = (0.2, 0.6, 0.9), (0.8, 0.3, 0.1)
CASES = {
    "side by side": [Box((-1.0, 0.0, 0.0), 1.0, 0.0, RED), Box((1.0, 0.0, 0.0), 1.0, 0.0, BLUE)],
    "in reverse": [Box((1.0, 0.0, 0.0), 1.0, 0.0, BLUE), Box((-1.0, 0.0, 0.0), 1.0, 0.0, RED)],
    "a row": [Box((float(x), 0.0, 0.0), 0.5, 0.0, color) for x, color in ((-1, RED), (0, BLUE), (1, RED))],
    "in one place": [Box((0.0, 0.0, 0.0), 1.0, 0.0, RED), Box((0.0, 0.0, 0.0), 1.0, 0.0, BLUE)],
    "in a corner": [Box((0.0, 0.0, 0.0), 1.0, 0.0, RED), Box((0.5, 0.5, 0.5), 0.5, 0.0, BLUE)],
}


@pytest.mark.parametrize(
    "eye", [(-6.0, 0.1, 0.2), (3.0, 4.0, 2.5), (-2.0, -5.0, 0.4)], ids=["along", "above", "beside"]
)
@pytest.mark.parametrize("media", CASES.values(), ids=CASES)
def test_what_gets_through(renderer, media, eye):
    camera = fog.camera(eye, (0.1, 0.05, 0.0), 0.3, 24)
    scene = fog.scene_of(camera, *(box.part() for box in media), world=World(np.ones(3)), iterations=1, photons=64)
    found = fog.pictures_of(renderer, scene, 1)[0]
    np.testing.assert_allclose(found, passed(media, *fog.rays(camera), np.inf), atol=2e-3)


@pytest.mark.parametrize("is_first", [True, False], ids=["floor first", "volume first"])
def test_a_volume_on_a_floor(renderer, is_first):
    """The floor shines."""
    medium = Box((0.0, 0.0, 1.0), 1.0, 0.0, RED)
    floor = scenes.square("floor", 6.0), material("glow", Lobe(LobeKind.EMISSION)), np.eye(4)
    parts = [floor, medium.part()] if is_first else [medium.part(), floor]
    camera = fog.camera((1.0, -2.0, 5.0), (0.0, 0.0, 0.0), 0.3, 24)
    scene = fog.scene_of(camera, *parts, iterations=1, photons=64)
    found = fog.pictures_of(renderer, scene, 1)[0]
    np.testing.assert_allclose(found, passed([medium], *fog.rays(camera), np.inf), atol=2e-3)

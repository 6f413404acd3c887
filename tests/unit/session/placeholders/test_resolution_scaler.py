# SPDX-License-Identifier: GPL-3.0-or-later
"""How coarse the first pictures of a view are."""

import numpy as np
import pytest

from rppm_addon.scene import Camera, Scene
from rppm_addon.session.placeholders.resolution_scaler import COARSEST, ResolutionScaler, at_level, scaled

PIXELS = 480 * 270


def test_nothing_is_known_at_first():
    assert ResolutionScaler().levels(PIXELS, 0.15)[0] == COARSEST


@pytest.mark.parametrize("seconds_per_pixel", [1e-9, 3e-7, 1e-6, 5e-6, 1e-4])
def test_levels_end_at_full_sharpness_and_grow_fourfold_at_most(seconds_per_pixel):
    sharpness = ResolutionScaler()
    sharpness.measure(1000, 1000 * seconds_per_pixel)
    levels = sharpness.levels(PIXELS, 0.1)
    assert levels[-1] == 1.0 and levels[0] >= COARSEST
    ratios = np.divide(levels[1:], levels[:-1])
    assert np.all(ratios > 1.0) and np.all(ratios <= 2.0 * 2.0**0.5)
    affordable = levels[0] ** 2 * PIXELS * seconds_per_pixel <= 0.1 * 1.001
    assert affordable or levels[0] == COARSEST


def test_a_fast_device_begins_with_the_full_picture():
    sharpness = ResolutionScaler()
    sharpness.measure(PIXELS, 0.02)
    assert sharpness.levels(PIXELS, 1 / 15) == [1.0]


def test_small_differences_change_no_resolution():
    sharpness = ResolutionScaler()
    chosen = []
    for seconds in (0.10, 0.11, 0.09, 0.105):
        sharpness.measure(PIXELS, seconds / 0.25)
        chosen.append(sharpness.levels(PIXELS, 0.1)[0])
    assert len(set(chosen)) == 1
    sharpness.measure(PIXELS, 4.0)
    assert sharpness.levels(PIXELS, 0.1)[0] == COARSEST


@pytest.mark.parametrize("level", [0.25, 0.31, 0.5, 1.0])
@pytest.mark.parametrize("crop", [None, (10, 20, 331, 197), (0, 0, 1, 1), (478, 268, 480, 270)])
def test_a_coarse_camera_sees_the_same(level, crop):
    camera = Camera(np.eye(4), (-0.5, 0.7, -0.2, 0.3), 480, 270, crop=crop)
    coarse = scaled(camera, level)
    assert coarse.window == camera.window
    assert coarse.width / 480 == pytest.approx(level, abs=0.5 / 480 + 1e-9)
    x_min, y_min, x_max, y_max = coarse.region
    assert 0 <= x_min < x_max <= coarse.width and 0 <= y_min < y_max <= coarse.height
    for edge, full, size, whole in zip(
        coarse.region, camera.region, (coarse.width, coarse.height) * 2, (480, 270) * 2, strict=True
    ):
        assert abs(edge / size - full / whole) <= 1.0 / size + 1e-9


def test_photons_thin_out_with_the_side_of_the_picture():
    scene = Scene(camera=Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 64, 64))
    coarse = at_level(scene, 0.25)
    assert coarse.settings.photons == scene.photon_count // 4
    assert at_level(scene, 1.0) is scene
    assert coarse.instances is scene.instances

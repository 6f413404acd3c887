# SPDX-License-Identifier: GPL-3.0-or-later
"""How often pictures are reprojected into a moving view."""

import numpy as np
import pytest

from rppm_addon.scene import Camera, Scene
from rppm_addon.session.viewport.reprojection_pacing import INTERVAL_SECONDS, REST_FACTOR, ReprojectionPacing

SCENE = Scene(Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 480, 270))


def reproject(pacing, clock, seconds, pixels=480 * 270):
    began = clock[0]
    clock[0] += seconds
    pacing.add(began, pixels)


@pytest.mark.parametrize(("seconds", "interval"), [(0.001, INTERVAL_SECONDS), (1.0, REST_FACTOR)])
def test_rendering_has_time_between_reprojections(clock, seconds, interval):
    pacing = ReprojectionPacing()
    assert pacing.is_due
    reproject(pacing, clock, seconds)
    clock[0] += 0.99 * interval
    assert not pacing.is_due
    clock[0] += 0.02 * interval
    assert pacing.is_due


def test_slow_reprojections_have_fewer_pixels(clock):
    pacing = ReprojectionPacing()
    assert pacing.scaled(SCENE) is SCENE
    reproject(pacing, clock, 0.1)
    assert 0.25 * 480 <= pacing.scaled(SCENE).camera.width < 0.75 * 480


def test_a_view_that_cannot_be_reprojected_says_nothing_about_pixels(clock):
    pacing = ReprojectionPacing()
    reproject(pacing, clock, 0.1, pixels=0)
    assert pacing.scaled(SCENE) is SCENE and not pacing.is_due

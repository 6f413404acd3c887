# SPDX-License-Identifier: GPL-3.0-or-later
"""Which pictures of a viewport are denoised, and which stay noisy."""

import threading

import numpy as np
import pytest

from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.scene import Camera, Scene
from rppm_addon.scene.errors import DenoiserError
from rppm_addon.scene.settings import RenderSettings
from rppm_addon.session.viewport.denoising import ViewportDenoising

NOISY = np.zeros((2, 2, 4), np.float32)


class Adding(Denoiser):
    """Adds 1 to pictures, unless it is to fail; waits until it is let."""

    def __init__(self):
        super().__init__([])
        self.fails, self.let = False, threading.Event()
        self.let.set()

    def open(self):
        if self.fails:
            raise DenoiserError("there is no library")

    def denoise(self, combined, passes, settings):
        self.let.wait(60.0)
        return combined + 1.0


@pytest.fixture
def denoiser():
    return Adding()


@pytest.fixture
def denoising(denoiser):
    found = ViewportDenoising(denoiser)
    yield found
    denoiser.let.set()
    found.release()


def scene_of(start_sample=1, use_denoising=True):
    settings = RenderSettings(use_denoising=use_denoising, denoising_start_sample=start_sample)
    return Scene(Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 2, 2), settings=settings)


def test_the_settings_say_from_which_sample_on(denoising):
    denoising.begin_series(scene_of(start_sample=3))
    assert [denoising.is_wanted(iteration) for iteration in (1, 2, 3, 4)] == [False, False, True, True]
    denoising.begin_series(scene_of(use_denoising=False))
    assert not denoising.is_wanted(5)


def test_a_series_has_a_picture_once_it_was_taken(denoising):
    denoising.begin_series(scene_of())
    assert denoising.is_idle and denoising.is_due and denoising.take() is None and not denoising.has_picture
    denoising.start(4, NOISY, {})
    assert not denoising.is_idle
    iteration, combined = denoising.take(60.0)
    assert iteration == 4 and (combined == 1.0).all() and denoising.has_picture and denoising.is_idle
    denoising.begin_series(scene_of())
    assert not denoising.has_picture


def test_a_picture_of_another_series_is_dropped(denoising, denoiser):
    denoiser.let.clear()
    denoising.begin_series(scene_of())
    denoising.start(4, NOISY, {})
    denoising.begin_series(scene_of())
    denoiser.let.set()
    assert denoising.take(60.0) is None and denoising.is_idle and not denoising.has_picture


def test_a_series_that_cannot_be_denoised_stays_noisy_with_a_warning(denoising, denoiser):
    denoiser.fails, scene = True, scene_of()
    denoising.begin_series(scene)
    denoising.start(1, NOISY, {})
    assert scene.warnings == ["the viewport is not denoised: there is no library"]
    assert not denoising.is_wanted(2) and not denoising.has_picture
    denoiser.fails = False
    denoising.begin_series(scene_of())
    assert denoising.is_wanted(2)

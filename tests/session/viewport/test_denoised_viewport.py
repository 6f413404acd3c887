# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport that is denoised: from which sample on, while iterations go on, and to its end."""

import dataclasses
import math
import threading
import time

import numpy as np
import pytest
from session.conftest import run_to_the_end, settled_picture
from session.frame_receiver import FrameReceiver
from support.floor import floor_scene

from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.denoising.places import library_places
from rppm_addon.scene.errors import DenoiserError
from rppm_addon.scene.settings import DenoisingInputPasses
from rppm_addon.session.placeholders.known_programs import KnownPrograms
from rppm_addon.session.placeholders.resolution_scaler import ResolutionScaler
from rppm_addon.session.render.background_denoising import MOST_TIME, BackgroundDenoising
from rppm_addon.session.transport.sessions import SessionKind
from rppm_addon.session.viewport import scheduler as viewport_scheduler
from rppm_addon.session.viewport.viewport_renderer import ViewportRenderer

MARK = 77.0


class AllKnown(KnownPrograms):
    """Nothing but the renderer's own pictures is shown."""

    def cover(self, scene):
        return True


class Marking(Denoiser):
    """Puts a mark in place of the picture, when it is let."""

    def __init__(self):
        super().__init__([])
        self.let, self.given = threading.Event(), []
        self.let.set()
        self.error = None

    def open(self):
        return None

    def denoise(self, combined, passes, settings):
        self.let.wait(60.0)
        self.given.append(combined)
        if self.error is not None:
            raise self.error
        return np.full_like(combined, MARK + len(self.given))


class Shown(list):
    """Pictures that a viewport sends: the iterations that are done and whether it is denoised."""

    def __init__(self):
        super().__init__()
        self.statuses = []
        self.renderer = None
        self._receiver = FrameReceiver()

    def send(self, kind, **content):
        self._receiver(kind, **content)
        self.statuses = self._receiver.statuses
        if kind == "frame":
            self.append((self.renderer.mapper.iteration, bool(self._receiver.picture[0, 0, 0] > MARK)))


@pytest.fixture
def denoiser():
    return Marking()


@pytest.fixture
def open_viewport(device, monkeypatch):
    """A function that opens a viewport, which gives out each iteration's picture in full resolution, and denoises as
    often as it can."""
    monkeypatch.setattr(viewport_scheduler, "FRAME_SECONDS", 0.0)
    for name in ("MOST_PICTURE_TIME", "LATER_PICTURE_TIME"):
        monkeypatch.setattr(viewport_scheduler, name, math.inf)
    monkeypatch.setattr(ResolutionScaler, "levels", lambda *_: [1.0])
    monkeypatch.setattr("rppm_addon.session.render.background_denoising.MOST_TIME", 1.0)
    shown = Shown()

    def open_viewport(denoiser):
        shown.renderer = ViewportRenderer(*device, denoiser, shown.send, AllKnown())
        return shown

    with device[0].moderngl:
        yield open_viewport
        shown.renderer.release()


@pytest.fixture
def viewport(open_viewport, denoiser):
    yield open_viewport(denoiser)
    denoiser.let.set()


def scene_of(iterations=6, **settings):
    scene = floor_scene()
    settings = {"use_denoising": True, "denoising_input_passes": "RGB", "passes": (), **settings}
    scene.settings = scene.settings.with_values(iterations=iterations, **settings)
    return scene


def render(viewport, scene, generation=1):
    viewport.renderer.show(scene, generation, False)
    run_to_the_end(viewport.renderer)


def test_from_the_start_sample_on(viewport, denoiser):
    render(viewport, scene_of(6, denoising_start_sample=4))
    assert viewport[:3] == [(1, False), (2, False), (3, False)]
    assert viewport[-1] == (6, True) and viewport.statuses[-1]["settled"]
    denoised = [is_denoised for _, is_denoised in viewport]
    assert denoised == sorted(denoised)  # no noisy picture after a denoised one
    assert len(denoiser.given) <= 3


def test_a_start_after_the_end_denoises_nothing(viewport, denoiser):
    render(viewport, scene_of(3, denoising_start_sample=4))
    assert viewport == [(1, False), (2, False), (3, False)] and denoiser.given == []


def test_iterations_go_on_while_a_picture_is_denoised(viewport, denoiser):
    """All of them, and noisy pictures are shown until the first denoised one is there."""
    denoiser.let.clear()
    viewport.renderer.show(scene_of(5), 1, False)
    while len(viewport) < 5:
        viewport.renderer.run_slice()
    for _ in range(3):
        viewport.renderer.run_slice()
    assert viewport == [(number, False) for number in range(1, 6)] and viewport.renderer.busy
    assert not viewport.statuses[-1]["settled"]
    denoiser.let.set()
    run_to_the_end(viewport.renderer)
    assert viewport[-1] == (5, True) and viewport.statuses[-1]["settled"]
    assert len(denoiser.given) == 2  # the first picture, and the last


def test_what_was_denoised_of_a_scene_that_is_gone_is_not_shown(viewport, denoiser):
    denoiser.let.clear()
    viewport.renderer.show(scene_of(), 1, False)
    while not viewport:
        viewport.renderer.run_slice()
    viewport.renderer.show(scene_of(2), 2, False)
    while viewport[-1] != (2, False):
        viewport.renderer.run_slice()
    count = len(viewport)
    denoiser.let.set()
    run_to_the_end(viewport.renderer)
    assert viewport[count:] == [(2, True)]  # the last of the second scene alone


def test_a_failure_is_reported_and_noisy_pictures_go_on(viewport, denoiser):
    denoiser.error = DenoiserError("out of memory")
    render(viewport, scene_of(4))
    assert [iteration for iteration, _ in viewport] == [1, 2, 3, 4] and not any(which for _, which in viewport)
    assert viewport.statuses[-1]["warnings"] == ["the viewport is not denoised: out of memory"]
    denoiser.error = None
    render(viewport, scene_of(2), 2)
    assert viewport[-1] == (2, True) and viewport.statuses[-1]["warnings"] == []


def test_without_a_library(open_viewport):
    shown = open_viewport(Denoiser([]))
    render(shown, scene_of(2))
    assert [which for _, which in shown] == [False, False]
    (warning,) = shown.statuses[-1]["warnings"]
    assert warning.startswith("the viewport is not denoised: Open Image Denoise is not there: take a Blender")


def test_denoising_leaves_time_to_the_iterations(denoiser):
    work = BackgroundDenoising(denoiser)
    settings = scene_of().settings
    assert work.is_idle and work.is_due and work.take() is None
    denoiser.let.clear()
    started = time.perf_counter()
    work.start((1, 1), np.zeros((2, 2, 4), np.float32), {}, settings)
    assert not work.is_idle and work.take(0.01) is None
    denoiser.let.set()
    key, picture = work.take(60.0)
    assert key == (1, 1) and picture[0, 0, 0] > MARK
    took = time.perf_counter() - started
    assert work.is_idle and not work.is_due
    time.sleep(took * (1.0 / MOST_TIME - 1.0))
    assert work.is_due
    work.release()


@pytest.mark.skipif(not library_places(), reason="there is no Open Image Denoise: install the bpy module or pyoidn")
@pytest.mark.parametrize("inputs", DenoisingInputPasses)
def test_in_the_renderers_process(process, inputs):
    process.launcher.denoisers = library_places()
    session = process.open(SessionKind.VIEWPORT)
    scene = scene_of(4, denoising_input_passes=inputs, direct_light="PHOTONS", photons=4096)
    scene.camera = dataclasses.replace(scene.camera, width=64, height=48)
    pictures = []
    for generation, denoising in enumerate((False, True), 1):
        settings = dataclasses.replace(scene.settings, use_denoising=denoising)
        session.show(dataclasses.replace(scene, settings=settings), generation, False)
        pictures.append(settled_picture(session, generation))
    noisy, denoised = pictures
    assert np.any(noisy != denoised) and denoised.mean() == pytest.approx(noisy.mean(), rel=0.01)

# SPDX-License-Identifier: GPL-3.0-or-later
"""A render with a time limit ends with the iteration that is nearest to it, and hardly later."""

import itertools
import time
from types import SimpleNamespace

import numpy as np
import pytest

from rppm_addon.scene import Camera, RenderSettings, Scene
from rppm_addon.scene.settings import DensityEstimation, FirstPhotonHits
from rppm_addon.session.checkpoints.continuation import Continuation
from rppm_addon.session.render.render_loop import RenderLoop

STEPS = 20


class Film:
    """A film whose pixels all have the number of times that it was read."""

    def __init__(self):
        self.reads = 0
        self.rendered_passes = ()

    def read_radiance(self):
        self.reads += 1
        return np.full((8, 8, 4), self.reads, np.float32)

    def read_passes(self):
        return {}


class Clock:
    """Stands in for the clock, and for a mapper that takes time."""

    build_seconds, triangle_count = 0.5, 0
    density_estimation, first_photon_hits = DensityEstimation.GRID, FirstPhotonHits.TRACED

    def __init__(self, seconds, photons=(8,)):
        """Seconds and photons of the first iterations; the last of each is that of all that follow."""
        self.now = 100.0
        self._seconds = itertools.chain(seconds, itertools.repeat(seconds[-1]))
        self._photons = photons
        self.timers = SimpleNamespace(reset=lambda: None, seconds={})
        self.film, self.film_iterations = Film(), 0
        self.splat_radii = (1.0, 1.0)
        self.memory_bytes = self.source_watts = self.source_photons = {}

    def perf_counter(self):
        return self.now

    def update(self, scene, center_tolerance):
        self.now += 0.5

    def photons_emitted(self, iterations):
        return sum(self._photons[min(number, len(self._photons) - 1)] for number in range(iterations))

    def flux_balance(self):
        return {"emitted": 1.0, "lost": 0.0}

    def state(self):
        return self.film_iterations

    def steps(self):
        seconds = next(self._seconds)
        self.film_iterations = None  # between iterations there is no telling
        for _ in range(STEPS):
            self.now += seconds / STEPS
            yield
        self.film_iterations = 1


@pytest.fixture
def run(monkeypatch):
    """Runs a render by a clock; returns the render, its seconds and the marks of its snapshots."""

    def run_by(clock, limit, continuation=None):
        monkeypatch.setattr(time, "perf_counter", clock.perf_counter)
        camera = Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 8, 8)
        scene = Scene(camera, settings=RenderSettings(iterations=70, time_limit=float(limit)))
        marks = []
        context = SimpleNamespace(finish=lambda: None, information=SimpleNamespace(label="a device"))
        render = RenderLoop(
            context, clock, scene, snapshots=[1.0, 9.9, 10.0, 1e6],
            on_snapshot=lambda mark, _: marks.append(mark), continuation=continuation,
        )  # fmt: skip
        for _ in render.slices():
            pass
        return render, clock.now - 100.0, marks

    return run_by


@pytest.mark.parametrize(
    ("limit", "seconds_each", "iterations"),
    [
        (10, 0.98, 10),  # 10.3 s is nearer than 9.3 s, and within 5 %
        (10, 0.96, 10),
        (10, 3, 3),
        (10, 3.4, 2),  # 10.7 s were nearer than 7.3 s, but too late
        (10, 9, 1),
        (10, 100, 1),
        (60, 1, 59),
        (0, 3, 70),
    ],
)
def test_the_iteration_nearest_to_the_limit_is_the_last(run, limit, seconds_each, iterations):
    render, seconds, marks = run(Clock([seconds_each]), limit)
    assert render.iterations == iterations
    assert seconds == pytest.approx(0.5 + iterations * seconds_each)
    assert marks == [1.0, 9.9, 10.0]  # also those of a time when the picture is done


def test_fewer_photons_to_come_make_room_for_another_iteration(run):
    assert run(Clock([6.0, 3.0]), 10.0)[0].iterations == 1
    assert run(Clock([6.0, 3.0], photons=(8, 1)), 10.0)[0].iterations == 2


def test_one_iteration_that_was_held_up_ends_no_render_early(run):
    render, seconds, _ = run(Clock([0.9, 0.9, 0.9, 4.0, 0.9]), 10.0)
    assert (render.iterations, seconds) == (7, pytest.approx(9.9))


def test_an_iteration_far_longer_than_expected_is_given_up(run):
    kept = []
    clock = Clock([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 60.0])
    render, seconds, marks = run(clock, 10.0, Continuation(keep=kept.append))
    assert render.iterations == 8
    assert 10.5 < seconds <= 10.5 + 60.0 / STEPS
    result = render.result(stopped=False)
    assert result.statistics.iterations == 8
    assert result.statistics.seconds == pytest.approx(seconds)
    assert result.frame is render.frame()  # that of eight iterations: nothing is read of the film that is unfinished
    assert marks == [1.0, 9.9, 10.0]
    render.keep()
    assert [pause.state for pause in kept] == [1]  # whole iterations, and not what was given up


def test_the_first_iteration_is_never_given_up_and_says_so(run, caplog):
    render, seconds, _ = run(Clock([30.0]), 10.0)
    assert (render.iterations, seconds) == (1, pytest.approx(30.5))
    assert "30.5 s" in caplog.text
    assert "time limit of 10 s" in caplog.text

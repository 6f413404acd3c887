# SPDX-License-Identifier: GPL-3.0-or-later
"""A render with a time limit ends with the iteration that is nearest to it."""

from types import SimpleNamespace

import pytest

from rppm_addon.scene.settings import RenderSettings
from rppm_addon.session import renderer
from rppm_addon.session.renderer import SlicedRender


class Clock:
    """Stands in for the module's time, and for a mapper that takes it."""

    def __init__(self, seconds_each):
        self.now = 100.0
        self.seconds_each = seconds_each
        self.timers = SimpleNamespace(reset=lambda: None)

    def perf_counter(self):
        return self.now

    def update(self, scene, center_tolerance):
        self.now += 0.5

    def steps(self):
        for _ in range(4):
            self.now += self.seconds_each / 4
            yield


@pytest.mark.parametrize(
    ("limit", "seconds_each", "iterations"), [(10, 3, 3), (10, 4, 2), (10, 9, 1), (10, 100, 1), (60, 1, 59), (0, 3, 70)]
)
def test_the_iteration_nearest_to_the_limit_is_the_last(monkeypatch, limit, seconds_each, iterations):
    clock = Clock(seconds_each)
    monkeypatch.setattr(renderer, "time", clock)
    scene = SimpleNamespace(settings=RenderSettings(iterations=70, time_limit=float(limit)))
    marks = []
    render = SlicedRender(
        SimpleNamespace(finish=lambda: None), clock, scene, snapshots=[1.0, 9.9, 10.0, 1e6],
        on_snapshot=lambda mark, _: marks.append(mark),
    )  # fmt: skip
    monkeypatch.setattr(SlicedRender, "frame", lambda self: None)
    for _ in render.slices():
        pass
    assert render.iterations == iterations
    assert marks == [1.0, 9.9, 10.0]  # also those of a time when the picture is done

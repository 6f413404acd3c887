# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in slices: each step is done once, and threads compute what takes long."""

import threading
from types import SimpleNamespace

import pytest

from rppm_addon.blender.export.common import slices as slices_module
from rppm_addon.blender.export.common.slices import (
    FIRST_SECONDS,
    LONGEST_FIRST_SECONDS,
    LONGEST_SECONDS,
    SHORTEST_SECONDS,
    SlicePacing,
    Slices,
    Unfinished,
)


def until_done(function, *arguments):
    """How often Unfinished was raised, and what came in the end."""
    for count in range(1000):
        try:
            return count, function(*arguments)
        except Unfinished:
            pass
    raise AssertionError("it never ends")


def test_a_step_is_done_once_and_rests_behind_it():
    slices, record, made = Slices(), {}, []
    slices.begin(0.0)
    assert until_done(slices.step, record, "one", lambda: made.append(1) or "result") == (1, "result")
    assert until_done(slices.step, record, "one", None) == (0, "result")
    assert made == [1]


def test_without_a_limit_nothing_rests_and_no_thread_computes():
    slices, record = Slices(), {}
    assert slices.step(record, "step", lambda: 1) == 1
    assert slices.computed(record, "thread", threading.current_thread) is threading.main_thread()
    slices.rest()
    assert record == {"step": 1, "thread": threading.main_thread()}


def test_a_thread_computes_between_slices_and_its_errors_come_back():
    slices, record, may_end = Slices(), {}, threading.Event()
    slices.begin(0.0)

    def compute():
        may_end.wait(60.0)
        return threading.current_thread()

    for _ in range(3):
        with pytest.raises(Unfinished):
            slices.computed(record, "slow", compute)
    may_end.set()
    slices.begin(60.0)
    assert slices.computed(record, "slow", None) is not threading.main_thread()
    with pytest.raises(ZeroDivisionError):
        slices.computed(record, "wrong", lambda: 1 / 0)
    assert slices.computed(record, "wrong", lambda: 2) == 2


def test_others_go_on_while_a_thread_computes():
    slices, record, may_end = Slices(), {}, threading.Event()
    slices.begin(0.0)
    assert slices.computed_so_far(record, "slow", lambda: may_end.wait(60.0)) is None
    may_end.set()
    while (found := slices.computed_so_far(record, "slow", None)) is None:
        pass
    assert found is True and record == {"slow": True}


@pytest.mark.parametrize(("redraw", "expected"), [(0.01, FIRST_SECONDS), (0.06, 0.09), (0.1, LONGEST_FIRST_SECONDS)])
def test_slices_of_a_first_export_are_longer(monkeypatch, redraw, expected):
    now = [100.0]
    monkeypatch.setattr(slices_module, "time", SimpleNamespace(monotonic=lambda: now[0]))
    pacing = SlicePacing()
    assert pacing.begin(is_first=True) == FIRST_SECONDS
    pacing.end(is_last=False)
    now[0] += redraw
    assert pacing.begin(is_first=True) == pytest.approx(expected)


@pytest.mark.parametrize(("redraw", "expected"), [(0.01, SHORTEST_SECONDS), (0.2, 0.12), (2.0, LONGEST_SECONDS)])
def test_slices_follow_the_time_that_blender_takes_between_them(monkeypatch, redraw, expected):
    now = [100.0]
    monkeypatch.setattr(slices_module, "time", SimpleNamespace(monotonic=lambda: now[0]))
    pacing = SlicePacing()
    for _ in range(2):
        assert pacing.begin() == SHORTEST_SECONDS  # nothing is measured yet
        pacing.end(is_last=False)
        now[0] += redraw
        assert pacing.begin() == pytest.approx(expected)
        pacing.end(is_last=True)
        now[0] += 3600.0  # until the next export

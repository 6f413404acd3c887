# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in slices: each step is done once, and threads compute what takes long."""

import threading

import pytest

from rppm_addon.blender.export.common.slices import Slices, Unfinished


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

# SPDX-License-Identifier: GPL-3.0-or-later
"""Stage timers on software and, with a stand-in for the device's kind, by GL queries."""

import time

import pytest

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.context.timers import StageTimers


def test_software_stages_are_timed_by_the_clock(context):
    if not context.is_software:
        pytest.skip("the device is no software driver")
    timers = StageTimers(context)
    with timers.stage("unasked"):
        pass
    timers.begin()
    for _ in range(2):
        with timers.stage("wait"):
            time.sleep(0.02)
    assert timers.seconds.keys() == {"wait"}
    assert 0.04 <= timers.seconds["wait"] < 1.0
    timers.reset()
    assert timers.seconds == {}


def test_software_stages_follow_the_clock_that_is_given(context):
    if not context.is_software:
        pytest.skip("the device is no software driver")
    timers = StageTimers(context)
    timers.begin(iter((1.0, 4.0, 10.0, 10.5)).__next__)
    for _ in range(2):
        with timers.stage("work"):
            pass
    assert timers.seconds == {"work": 3.5}


def test_stages_of_devices_are_timed_by_queries(context, monkeypatch):
    monkeypatch.setattr(Context, "is_software", property(lambda self: False))
    timers = StageTimers(context)
    with timers.stage("unasked"):
        pass
    timers.begin()
    for _ in range(3):
        for name in ("first", "second"):
            with timers.stage(name):
                context.moderngl.finish()
        assert set(timers.seconds) == {"first", "second"}
    assert all(seconds >= 0.0 for seconds in timers.seconds.values())

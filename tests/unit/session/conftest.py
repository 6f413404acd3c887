# SPDX-License-Identifier: GPL-3.0-or-later
"""A clock that tests of schedules advance."""

import time

import pytest


@pytest.fixture
def clock(monkeypatch):
    """The time as a list of one number."""
    now = [100.0]
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])
    return now

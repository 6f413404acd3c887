# SPDX-License-Identifier: GPL-3.0-or-later
"""When a render hands over its state and its snapshots."""

from rppm_addon.session.checkpoints.checkpoint_schedule import (
    FIRST_SAFEGUARD_SECONDS,
    SAFEGUARD_SECONDS,
    CheckpointSchedule,
)
from rppm_addon.session.checkpoints.continuation import Continuation
from rppm_addon.session.render.snapshots import SnapshotSchedule


def run_until(schedule, clock, end, step=0.125):
    while clock[0] < end:
        clock[0] += step
        schedule.run(clock[0] - 100.0)


def test_the_checkpoint_is_kept_at_its_interval_and_at_the_end(clock):
    kept = []
    schedule = CheckpointSchedule(Continuation(keep=kept.append, interval=2.0), lambda: clock[0])
    run_until(schedule, clock, 105.0)
    assert kept == [102.0, 104.0]
    schedule.keep()
    assert kept == [102.0, 104.0, 105.0]


def test_nothing_is_handed_over_during_an_iteration(clock):
    kept = []
    schedule = CheckpointSchedule(
        Continuation(keep=kept.append, interval=1.0, safeguard=lambda *state: kept.append(state)), lambda: None
    )
    run_until(schedule, clock, 110.0)
    schedule.keep()
    assert kept == []


def test_safeguards_come_early_and_then_seldom(clock):
    seconds = []
    schedule = CheckpointSchedule(Continuation(safeguard=lambda _, elapsed: seconds.append(elapsed)), lambda: "state")
    run_until(schedule, clock, 112.0)
    first = FIRST_SAFEGUARD_SECONDS
    assert seconds == [first, first + SAFEGUARD_SECONDS, first + 2 * SAFEGUARD_SECONDS]


def test_safeguards_that_take_long_come_more_seldom(clock):
    seconds = []

    def read_pause():
        clock[0] += 1.0
        return "state"

    schedule = CheckpointSchedule(Continuation(safeguard=lambda _, elapsed: seconds.append(elapsed)), read_pause)
    run_until(schedule, clock, 140.0)
    assert len(seconds) == 1


def test_snapshots_are_handed_out_once_and_counted():
    taken, continuation = [], Continuation(snapshots_taken=1)
    schedule = SnapshotSchedule((1.0, 2.0, 3.0, 9.0), lambda mark, frame: taken.append((mark, frame)), continuation)
    frames = iter("abc")
    for seconds in (0.5, 2.5, 3.0, 3.5):
        schedule.take(seconds, lambda: next(frames))
    assert taken == [(2.0, "a"), (3.0, "b")] and continuation.snapshots_taken == 3

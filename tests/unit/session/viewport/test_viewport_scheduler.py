# SPDX-License-Identifier: GPL-3.0-or-later
"""When a viewport renders which scene, at which resolution, and presents a picture."""

import numpy as np
import pytest

from rppm_addon.scene import Camera, Scene
from rppm_addon.session.placeholders.resolution_scaler import COARSEST
from rppm_addon.session.viewport.scheduler import (
    FRAME_SECONDS,
    REST_SECONDS,
    ViewportScheduler,
    ViewRequest,
)

WIDTH, HEIGHT = 480, 270


def request(generation, navigating=False):
    scene = Scene(Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), WIDTH, HEIGHT))
    return ViewRequest(scene, generation, navigating)


def scheduler_of(first):
    """A scheduler that has begun with a request."""
    scheduler = ViewportScheduler()
    scheduler.request(first)
    scheduler.take()
    return scheduler


def present(scheduler, clock, rendering_seconds=0.1, picture_seconds=0.0):
    began = clock[0]
    clock[0] += picture_seconds
    scheduler.add_picture(began, WIDTH * HEIGHT, rendering_seconds)


def test_the_newest_request_replaces_the_others(clock):
    scheduler = ViewportScheduler()
    assert scheduler.take() is None
    for generation in (1, 2):
        scheduler.request(request(generation))
    assert scheduler.take().generation == 2 and scheduler.pending is None and scheduler.take() is None


def test_a_scene_gets_its_first_picture_before_the_next_one_begins(clock):
    scheduler = scheduler_of(request(1))
    scheduler.request(request(2))
    assert scheduler.take() is None and scheduler.pending.generation == 2
    present(scheduler, clock)
    assert scheduler.take().generation == 2


def test_a_scene_that_failed_does_not_keep_the_next_one_waiting(clock):
    scheduler = scheduler_of(request(1))
    scheduler.cancel()
    scheduler.request(request(2))
    assert scheduler.take().generation == 2


def test_nobody_sees_more_pictures_than_the_screen_shows(clock):
    scheduler = scheduler_of(request(1))
    assert scheduler.is_picture_due(1, 1) and scheduler.is_picture_due(4, 4) and not scheduler.is_picture_due(3, 4)
    present(scheduler, clock)
    assert not scheduler.is_picture_due(2, 1)
    clock[0] += FRAME_SECONDS
    assert scheduler.is_picture_due(3, 1)


def test_early_pictures_come_whatever_they_cost(clock):
    scheduler = scheduler_of(request(1))
    present(scheduler, clock, picture_seconds=0.5)
    assert [iteration for iteration in range(2, 40) if scheduler.is_picture_due(iteration, 1)] == [2, 4, 8, 16, 32]
    assert [iteration for iteration in range(2, 40) if scheduler.is_picture_due(iteration, 3)] == [3, 6, 12, 24]


@pytest.mark.parametrize(
    ("rendering_seconds", "picture_seconds", "expected"),
    [(2.0, 0.5, 1.0), (20.0, 0.5, 2.0), (200.0, 0.5, 5.0)],
    ids=["half of the time", "a tenth more samples", "a tenth of the time"],
)
def test_later_pictures_leave_time_to_the_iterations(clock, rendering_seconds, picture_seconds, expected):
    scheduler = scheduler_of(request(1))
    present(scheduler, clock, rendering_seconds, picture_seconds)
    clock[0] += 0.99 * (expected - picture_seconds)
    assert not scheduler.is_picture_due(5, 1)
    clock[0] += 0.02 * expected
    assert scheduler.is_picture_due(5, 1)


def test_a_moving_view_stays_at_its_resolution_until_it_rests(clock):
    scheduler = scheduler_of(request(1, navigating=True))
    assert not scheduler.is_higher_level_due(0.5, navigating=False)  # it has no picture
    present(scheduler, clock)
    assert scheduler.is_higher_level_due(0.5, navigating=False)
    assert not scheduler.is_higher_level_due(0.5, navigating=True)
    clock[0] += REST_SECONDS
    assert scheduler.is_higher_level_due(0.5, navigating=True)
    assert not scheduler.is_higher_level_due(1.0, navigating=True)


def test_the_first_resolution_follows_the_measured_time(clock):
    scheduler = ViewportScheduler()
    assert scheduler.resolution_levels(request(1))[0] == COARSEST
    scheduler.request(request(1))
    scheduler.take()
    present(scheduler, clock, rendering_seconds=0.2)
    still, moving = (scheduler.resolution_levels(request(2, navigating))[0] for navigating in (False, True))
    assert COARSEST < moving < still < 1.0
    present(scheduler, clock, rendering_seconds=1e-3)  # a later picture of the same scene says nothing of the first
    assert scheduler.resolution_levels(request(2, True))[0] == moving

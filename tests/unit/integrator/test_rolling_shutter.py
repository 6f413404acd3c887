# SPDX-License-Identifier: GPL-3.0-or-later
"""Which rows a rolling shutter exposes in which iterations."""

import dataclasses

import numpy as np
import pytest

from rppm_addon.integrator.common.band import bands_of
from rppm_addon.integrator.common.iteration import Iteration
from rppm_addon.integrator.device_scene.moments import moment
from rppm_addon.integrator.device_scene.rolling_shutter import RollingShutter
from rppm_addon.integrator.device_scene.shutter import SceneMotion
from rppm_addon.scene import Camera, Scene, Shutter

HEIGHT, ITERATIONS = 32, 256
CAMERA = Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 8, HEIGHT)
BANDS = bands_of(8, HEIGHT, is_rolling=True)


def taken(shutter: Shutter, iterations: int = ITERATIONS, skipped: int = 0, camera: Camera = CAMERA) -> np.ndarray:
    """(iterations, bands) numbers in the film; -1 where a band takes no part."""
    rolling, found = RollingShutter(shutter, camera, BANDS), []
    for number in range(1, iterations + 1):
        numbers = {
            band: part.number_in_film for band, part in rolling.iterations(Iteration(number, 0, skipped=skipped))
        }
        found.append([numbers.get(band, -1) for band in BANDS])
    return np.array(found)


def shutter(duration: float, curve: np.ndarray | None = None) -> Shutter:
    return Shutter(np.ones(4) if curve is None else curve, rolling_duration=duration)


def test_bands_are_single_rows_of_small_pictures_and_few_of_large_ones():
    assert [band.rows for band in BANDS] == [1] * HEIGHT
    rows = [band.rows for band in bands_of(1920, 1080, is_rolling=True)]
    assert sum(rows) == 1080 and max(rows) == 9 and len(rows) <= 128


@pytest.mark.parametrize("duration", [0.0, 0.1, 0.5])
def test_rows_are_exposed_from_the_top_down(duration):
    """As in Cycles: a row's middle lies at 1 - row / height, drawn toward the middle by the duration."""
    numbers = taken(shutter(duration))
    times = np.array([moment(number, 0) for number in range(1, ITERATIONS + 1)])
    for row in range(HEIGHT):
        middle = 0.5 + (0.5 - row / HEIGHT) * (1.0 - duration)
        half = 0.5 * max(duration, 1.0 / HEIGHT)
        exposed = times[1:][numbers[1:, row] > 0]
        assert (abs(exposed - middle) <= half + 1e-9).all()
        expected = np.clip(middle + half, 0.0, 1.0) - np.clip(middle - half, 0.0, 1.0)
        assert len(exposed) == pytest.approx(expected * ITERATIONS, abs=3)


def test_each_row_counts_its_own_iterations():
    """From the first in which it is exposed, which takes the place of what the first of all gave it."""
    numbers = taken(shutter(0.2))
    assert (numbers[0] == 1).all()
    for row in range(HEIGHT):
        counted = numbers[1:, row][numbers[1:, row] > 0]
        np.testing.assert_array_equal(counted, counted[0] + np.arange(len(counted)))
        assert counted[0] in (1, 2)


def test_all_rows_are_learned_from():
    numbers = taken(shutter(0.1))
    learning = [number - 1 for number in (1, 2, 4, 8, 16)]
    assert (numbers[learning] >= 0).all()
    assert (numbers[[4, 5, 6, 20, 100]] != 0).all() and (numbers[[4, 5, 6, 20, 100]] < 0).any(axis=1).all()


def test_a_film_that_begins_later_counts_from_there():
    numbers = taken(shutter(0.2), iterations=64, skipped=20)
    assert (numbers[:20] <= 0).all() and (numbers[20] == 1).all()
    rolling = RollingShutter(shutter(0.2), CAMERA, BANDS)
    least = rolling.least_count(Iteration(64, 0, skipped=20))
    assert 0 < least == min(row[row > 0].max() for row in numbers[20:].T)


def test_the_curve_chooses_among_the_iterations_of_a_row():
    """A curve that is half open in the second half: it takes half of the iterations there."""
    plain, dimmed = taken(shutter(0.5)), taken(shutter(0.5, np.array([1.0, 0.5])))
    row = HEIGHT // 2
    times = np.array([moment(number, 0) for number in range(1, ITERATIONS + 1)])
    late = times > 0.5 + (0.5 - row / HEIGHT) * 0.5
    assert ((dimmed[1:, row] > 0) == (plain[1:, row] > 0))[~late[1:]].all()
    share = (dimmed[1:, row] > 0)[late[1:]].sum() / (plain[1:, row] > 0)[late[1:]].sum()
    assert share == pytest.approx(0.5, abs=0.1)


def test_a_border_keeps_the_times_of_the_whole_picture():
    cropped = dataclasses.replace(CAMERA, height=2 * HEIGHT, crop=(0, HEIGHT, 8, 2 * HEIGHT))
    times = np.array([moment(number, 0) for number in range(1, ITERATIONS + 1)])
    numbers = taken(shutter(0.1), camera=cropped)
    assert times[1:][(numbers[1:] > 0).any(axis=1) & (numbers[1:] >= -1).all(axis=1)].max() < 0.51 + 0.05


def test_other_shutters_expose_all_rows_together():
    motion, iteration = SceneMotion(), Iteration(3, 0)
    for each in (None, shutter(1.0)):
        motion.take(Scene(CAMERA, shutter=each))
        assert motion.iterations_of_bands(BANDS, iteration) == [(band, iteration) for band in BANDS]
        assert motion.least_exposed(BANDS, iteration) is iteration

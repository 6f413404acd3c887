# SPDX-License-Identifier: GPL-3.0-or-later
"""When a render ends by its noise, and when it is expected to."""

import numpy as np
import pytest

from rppm_addon.integrator.common.low_discrepancy import van_der_corput
from rppm_addon.integrator.film.noise_estimate import LEAST_MEASURED, count_in_half, is_in_half
from rppm_addon.scene import RenderSettings
from rppm_addon.session.limits.noise_threshold import NoiseThreshold
from rppm_addon.session.limits.remaining_time import RemainingTime


def threshold_of(value=0.1, least=8, **settings):
    return NoiseThreshold(
        RenderSettings(use_adaptive_sampling=True, adaptive_threshold=value, adaptive_min_samples=least, **settings)
    )


def test_half_of_the_iterations_are_in_the_half():
    members = [is_in_half(number) for number in range(1, 1025)]
    counts = [count_in_half(count) for count in range(1025)]
    assert counts == [0, *np.cumsum(members).tolist()]
    assert all(2 * counts[1 << power] == 1 << power for power in range(5, 11))
    assert all(1 / 3 <= counts[count] / count <= 2 / 3 for count in range(LEAST_MEASURED, 1025))


@pytest.mark.parametrize("half", [True, False])
def test_either_half_fills_the_interval_evenly(half):
    """If a half were every other point, all of its points would lie in one half of the interval."""
    points = np.array([van_der_corput(number - 1, 77) for number in range(1, 257) if is_in_half(number) == half])
    for parts in (2, 8, 16):
        counts = np.bincount((parts * points).astype(int), minlength=parts)
        assert (counts == len(points) // parts).all()


def test_noise_ends_a_render_after_the_least_iterations():
    threshold = threshold_of(0.1, 33)
    assert [count for count in range(60) if threshold.is_due(count)] == [32, 40, 48, 56]
    threshold.add(32, 0.01)
    assert not threshold.is_reached
    threshold.add(40, 0.1)
    assert not threshold.is_reached
    threshold.add(48, 0.0999)
    assert threshold.is_reached and threshold.noise == 0.0999


def test_without_a_threshold_nothing_is_measured():
    threshold = NoiseThreshold(RenderSettings(adaptive_threshold=0.5))
    assert not any(map(threshold.is_due, range(100)))
    assert (threshold.threshold, threshold.expected_iterations, threshold.is_reached) == (0.0, 0, False)


@pytest.mark.parametrize(("value", "least"), [(0.1, 32), (0.01, 64), (0.001, 128)])
def test_the_least_iterations_are_those_of_cycles(value, least):
    """As the documentation of Cycles has them, by about."""
    settings = RenderSettings(adaptive_threshold=value)
    assert settings.least_iterations == pytest.approx(least, abs=1)
    settings.adaptive_min_samples = 5
    assert settings.least_iterations == 5


@pytest.mark.parametrize("exponent", [0.35, 0.5, 0.65])
def test_the_end_is_seen_from_a_tenth(exponent):
    """Noise that falls with a power of the iterations, measured within 3 %."""
    random = np.random.default_rng(5)
    threshold, end = threshold_of(0.1, 4), 800
    for iterations in range(4, end // 10 + 1, 4):
        noise = 0.1 * (iterations / end) ** -exponent * random.normal(1.0, 0.03)
        threshold.add(iterations, noise)
    assert threshold.expected_iterations == pytest.approx(end, rel=0.2)
    threshold.add(end, 0.1)
    assert threshold.expected_iterations == pytest.approx(end, rel=0.05)


def test_what_no_end_can_be_told_of():
    threshold = threshold_of(0.1, 8)
    assert threshold.expected_iterations == 0
    threshold.add(4, float("inf"))
    assert threshold.expected_iterations == 0
    black = threshold_of(0.1, 8)
    black.add(4, 0.0)
    assert black.expected_iterations == LEAST_MEASURED
    steady = threshold_of(1e-4, 8)
    for iterations in range(4, 100, 4):
        steady.add(iterations, 1.0)
    assert steady.expected_iterations > 1 << 30


def test_the_remaining_time_is_that_of_later_iterations():
    """Programs are compiled in the first one, which has more photons as well."""
    times = [30.0, 3.0] + [1.0] * 98
    remaining = RemainingTime()
    assert remaining.seconds(100, 0.0, 0.0) is None
    assert remaining.seconds(100, 2.0, 60.0) == 58.0
    now = 0.0
    for number, seconds in enumerate(times, 1):
        now += seconds
        remaining.add(now)
        if number >= 10:
            left = sum(times[number:])
            assert remaining.seconds(100 - number, now, 0.0) == pytest.approx(left, rel=0.2)
            assert remaining.seconds(100 - number, now, 50.0) == pytest.approx(max(0.0, min(left, 50.0 - now)))
    assert remaining.seconds(-3, now, 0.0) == 0.0

# SPDX-License-Identifier: GPL-3.0-or-later
"""How many photons later iterations have."""

import numpy as np
import pytest

from rppm_addon.integrator.common.iteration import learns_after
from rppm_addon.integrator.common.photon_counts import (
    EVENNESS,
    NoiseSamples,
    NoiseVariances,
    PhotonCounts,
    camera_cost,
    photon_cost,
)

SIDE = 128
FIRST = 16384


@pytest.mark.parametrize("known", range(1, 7))
def test_photons_of_iterations_add_up(known):
    counts = PhotonCounts((100, 90, 30, 40, 50, 60)[:known])
    numbers, latest = [], 0
    for iteration in range(1, 40):
        numbers.append(counts.numbers[min(latest, known - 1)])
        assert counts.of(iteration) == numbers[-1]
        latest += learns_after(iteration)
    for skipped in (0, 1, 2, 3, 16, 20):
        for iterations in (0, 1, 2, 5, 15):
            assert counts.emitted(skipped, iterations) == sum(numbers[skipped : skipped + iterations])
    assert counts.followed_by(7).latest == 7


@pytest.mark.parametrize(("photon_variance", "rest_variance"), [(20.0, 0.02), (60.0, 0.3), (400.0, 0.1)])
@pytest.mark.parametrize("each", [1.2, 4.0])
def test_the_variance_after_a_given_time_is_least(photon_variance, rest_variance, each):
    noise = NoiseVariances(100.0, 100.0 * photon_variance, 2.0 * rest_variance, 2)
    paths = 50_000.0
    numbers = np.arange(1024, FIRST + 1)

    def product(photons: np.ndarray | int) -> np.ndarray:
        return (photon_variance / photons + rest_variance / EVENNESS) * (photons * each + paths)

    least = product(numbers).min()
    found = [noise.best_photons(FIRST, each, paths * factor) for factor in (1.0, 1.01)]
    assert product(found[0]) <= 1.01 * least
    assert 1024 <= found[0] == found[1], "what hardly differs has other photons"


@pytest.mark.parametrize(
    ("noise", "first", "photons"),
    [
        (NoiseVariances(), 16384, 16384),  # nothing is known yet
        (NoiseVariances(100.0, 0.0, 1.0, 2), 16384, 1024),  # photons make no noise: some go on looking
        (NoiseVariances(100.0, 0.0, 1.0, 2), 4096, 512),
        (NoiseVariances(100.0, 0.0, 1.0, 2), 100, 100),
        (NoiseVariances(100.0, 1e6, 0.0, 2), 16384, 16384),  # all noise is theirs
        (NoiseVariances(100.0, 0.0, 0.0, 2), 16384, 1024),  # there is no noise
    ],
)
def test_photons_have_limits(noise, first, photons):
    assert noise.best_photons(first, 1.0, 50_000.0) == photons


def test_variances_are_those_of_the_samples():
    """Pixels of Poisson counts of photons and of a rest of known spread, both relative to what is there."""
    random = np.random.default_rng(5)
    mean, spread, photons_in_disk = 2.0, 0.5, 20.0
    photons = 5000

    def samples() -> NoiseSamples:
        rest = random.normal(mean, spread, (SIDE, SIDE))
        counts = random.poisson(photons_in_disk, rest.shape)
        positive = random.binomial(counts, 0.5)
        brings = 1.0 / photons_in_disk
        return NoiseSamples(rest, rest + brings * counts, brings * (2.0 * positive - counts), np.zeros_like(rest))

    noise, before = NoiseVariances().with_first(samples()), samples()
    for _ in range(4):
        found = samples()
        noise = noise.with_next(photons, found, before.rest, 3.0)
        before = found
    luminance = (mean + 1.0) ** 2 + 0.01
    # Of squares of n normal numbers the mean has a relative deviation of sqrt(2 / n); besides, the worst thousandth,
    # each ten times the mean or more, is left out, and the luminance is that of 25 pixels, each with a spread of .11.
    tolerance = 4.0 * np.sqrt(2.0 / (4 * SIDE**2)) + 0.015
    assert noise.pairs == 4
    assert noise.photon_sum / noise.photons == pytest.approx(3.0 * photons / photons_in_disk / luminance, rel=tolerance)
    assert noise.rest_sum / noise.pairs == pytest.approx(spread**2 / luminance, rel=1.5 * tolerance)


def test_what_photons_add_to_the_rest_is_theirs():
    """At the ends of gathering rays."""
    random = np.random.default_rng(6)
    spread = 0.4

    def samples() -> NoiseSamples:
        final_gather, signed = random.normal(0.0, spread, (2, SIDE, SIDE))
        rest = 2.0 + final_gather
        return NoiseSamples(rest, rest, signed, signed)

    first = samples()
    noise = NoiseVariances().with_first(first).with_next(1000, samples(), first.rest, 1.0)
    assert noise.photon_sum / noise.photons == pytest.approx(1000 * spread**2 / 4.01, rel=0.1)
    assert noise.rest_sum < 0.05 * spread**2 / 4.01


def test_pixels_that_are_not_finite_tell_nothing():
    values = np.ones((8, 8, 4), np.float32)
    values[3, 4] = np.nan, np.inf, -np.inf, 1.0
    samples = NoiseSamples.of(values)
    noise = NoiseVariances().with_first(samples).with_next(100, samples, samples.rest, 1.0)
    assert np.isfinite([noise.photon_sum, noise.rest_sum, noise.rest_photon_variance]).all()
    assert (samples.signed[0, 0], samples.signed[3, 4]) == (2.0, 1.0)


def test_costs_are_counts():
    assert photon_cost(100, 250, 0) == 2.5
    assert photon_cost(100, 250, 1000) > 2.5
    assert photon_cost(100, 250, 0, 1000) > photon_cost(100, 250, 1000)
    assert camera_cost(100, 4) - camera_cost(100, 2) == camera_cost(100, 2) - camera_cost(100, 0) > 0.0

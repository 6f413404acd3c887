# SPDX-License-Identifier: GPL-3.0-or-later
"""How many photons later iterations have."""

import numpy as np
import pytest

from rppm_addon.integrator.common.photon_counts import PhotonCounts, later_photons, photons_of_use


@pytest.mark.parametrize(
    ("first", "pixels", "by_photons", "listed", "later"),
    [
        (100_000, 100_000, 0, 5000, 25_000),  # nothing makes caustics
        (100_000, 100_000, 0, 0, 25_000),  # nothing is stored
        (100_000, 100_000, 400, 5000, 25_000),
        (100_000, 100_000, 1000, 5000, 40_000),
        (100_000, 100_000, 2000, 5000, 80_000),
        (100_000, 100_000, 3000, 5000, 100_000),  # never more than in the first iteration
        (262_144, 4_000_000, 0, 5000, 262_144),  # large pictures have few for a pixel as it is
        (262_144, 500_000, 0, 5000, 125_000),
        (8192, 100, 0, 5000, 2048),  # small ones need some for any picture at all
        (8192, 6000, 2500, 5000, 6000),
        (1000, 100, 0, 5000, 1000),
    ],
)
def test_later_iterations_follow_the_share_of_caustics(first, pixels, by_photons, listed, later):
    assert later_photons(first, pixels, by_photons, listed) == later


@pytest.mark.parametrize(
    ("by_light", "expected"),
    [
        ([(1000, 400, 30)], (1000, 600)),
        ([(1000, 400, 30), (50_000, 50_000, 0)], (1000, 600)),  # lamps in another room
        ([(1000, 400, 30), (50_000, 50_000, 50)], (51_000, 600)),
        ([(1000, 400, 30), (50_000, 50_000, 5)], (6000, 600)),  # of which hardly any light comes here
        ([(1000, 400, 30), (20, 0, 1)], (1020, 620)),
        ([(1000, 400, 0), (3000, 1000, 0)], (4000, 2600)),  # nothing is known of either
        ([(0, 0, 0)], (0, 0)),
    ],
)
def test_lights_count_as_far_as_their_photons_contribute(by_light, expected):
    assert photons_of_use(np.array(by_light, np.uint32)) == expected


def test_photons_of_iterations_add_up():
    counts = PhotonCounts(100, 30)
    numbers = [counts.of(iteration) for iteration in range(1, 8)]
    for left_out in range(3):
        for iterations in range(4):
            assert counts.emitted(left_out, iterations) == sum(numbers[left_out : left_out + iterations])

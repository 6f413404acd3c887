# SPDX-License-Identifier: GPL-3.0-or-later
"""Allocation of photons to lights."""

import numpy as np
import pytest

from rppm_addon.integrator.lights.photon_allocation import PhotonAllocation
from rppm_addon.integrator.lights.portals import FIRST_PHOTON_FRACTION


def test_brighter_lights_and_those_that_contribute_have_more_photons():
    allocation = PhotonAllocation(np.array([3.0, 1.0, 0.0]), np.array([1.0, 1.0, 1.0]), has_portals=False)
    first = allocation.allocate(8000)
    assert first.sum() == allocation.photon_count == 8000
    assert first[0] > 2 * first[1] > 4 * first[2] > 0
    learned = allocation.allocate(4000, np.array([0.1, 1.0, 1.0]))
    assert learned.sum() == allocation.photon_count == 4000 and learned[1] > learned[0]


def test_the_world_s_photons_are_divided_between_portals_and_the_rest():
    allocation = PhotonAllocation(np.array([1.0, 4.0, 2.0]), np.ones(3), has_portals=True)
    lamp, everywhere, through = allocation.allocate(10000)
    assert through / (everywhere + through) == pytest.approx(FIRST_PHOTON_FRACTION, abs=1e-3)
    assert 0 < lamp < everywhere
    fraction = allocation.portal_fraction(np.array([1.0, 1.0, 1.5]))
    assert fraction == pytest.approx(2.0 * 1.5 / 4.0)
    _, everywhere, through = allocation.allocate(10000, np.ones(3), fraction)
    assert through / (everywhere + through) == pytest.approx(fraction, abs=1e-3)


def test_without_portals_no_photon_leaves_through_them():
    assert PhotonAllocation(np.ones(2), np.ones(2), has_portals=False).portal_fraction(np.ones(2)) == 0.0

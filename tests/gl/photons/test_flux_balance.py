# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the flux of the photons went, summed on the device."""

import numpy as np
import pytest

from rppm_addon.integrator.common.records.photon_paths import PHOTON_PATH
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.photons.photons import FLUX_GROUP, FLUX_NAMES, Photons

PATHS = 3 * FLUX_GROUP + 7


@pytest.fixture
def made(context, library):
    photons = Photons(context, library, StageSizes(1, 1, PATHS, 4))
    yield photons
    photons.release()


def balance(photons, emitted, paths):
    photons._emitted.upload(emitted)
    photons._paths.upload(paths)
    return photons.flux_balance()


def test_every_path_counts_once(made):
    """Random paths against sums in double precision."""
    random = np.random.default_rng(1)
    emitted, paths = PHOTON_PATH.zeros(PATHS), PHOTON_PATH.zeros(PATHS)
    emitted["flux"] = random.random((PATHS, 3))
    left = 0.7 * random.random(PATHS) * emitted["flux"].sum(axis=1)
    fate = random.integers(0, 4, PATHS)
    paths["escaped"][fate == 0], paths["deposited"][fate == 1] = left[fate == 0], left[fate == 1]
    paths["flux"][fate == 2, 1] = left[fate == 2]
    expected = [*(left[fate == kind].sum(dtype=float) for kind in range(3))]
    total = emitted["flux"].sum(dtype=float)
    expected = dict(zip(FLUX_NAMES, [total, total - sum(expected), expected[1], expected[0], expected[2]], strict=True))
    found = balance(made, emitted, paths)
    assert found == pytest.approx(expected, rel=1e-5)
    assert min(found.values()) > 0.0


def test_nothing_is_lost_to_rounding(made):
    """Where nothing is left on a ray, what is lost is none at all."""
    emitted, paths = PHOTON_PATH.zeros(PATHS), PHOTON_PATH.zeros(PATHS)
    emitted["flux"], paths["deposited"] = 0.1, 0.03
    found = balance(made, emitted, paths)
    assert found["lost"] == 0.0 and found["escaped"] == 0.0
    assert found["absorbed"] + found["deposited"] == pytest.approx(found["emitted"], rel=1e-6)

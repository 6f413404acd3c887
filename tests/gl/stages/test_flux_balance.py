# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the flux of the photons went, summed on the device."""

import numpy as np
import pytest

from rppm_addon.integrator.common.records import FLUX_GROUP, FLUX_NAMES, PHOTON, PHOTON_PATH, PhotonFlag
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.stages.photons import Photons

PATHS, SEGMENTS = 3 * FLUX_GROUP + 7, 4


@pytest.fixture
def made(context, library):
    photons = Photons(context, library, StageSizes(1, 1, PATHS, SEGMENTS))
    yield photons
    photons.release()


def balance(photons, emitted, records):
    photons._emitted.upload(emitted)
    photons.photons.upload(records)
    return photons.flux_balance()


def test_every_path_counts_once(made):
    """Random paths against sums in double precision."""
    random = np.random.default_rng(1)
    emitted, records = PHOTON_PATH.zeros(PATHS), PHOTON.zeros(PATHS * SEGMENTS).reshape(SEGMENTS, PATHS)
    emitted["flux"] = random.random((PATHS, 3))
    expected = dict.fromkeys(FLUX_NAMES, 0.0) | {"emitted": emitted["flux"].sum(dtype=float)}
    for path in range(PATHS):
        carried = emitted["flux"][path].sum(dtype=float)
        for segment in range(SEGMENTS):
            if carried == 0.0:
                break
            record, last = records[segment, path], segment == SEGMENTS - 1
            fate = random.choice(["escaped", "lost", "hit", "hit", "hit"])
            if fate == "hit":
                record["flags"] = PhotonFlag.ACTIVE
                scattered = 0.0
                if not last:
                    record["scattered_flux"] = 0.7 * random.random(3) * (random.random() < 0.8)
                    scattered = record["scattered_flux"].sum(dtype=float)
                expected["deposited" if last else "absorbed"] += carried - scattered
                carried = scattered
            else:
                record["flags"] = PhotonFlag.ACTIVE | PhotonFlag.ESCAPED if fate == "escaped" else 0
                expected[fate] += carried
                carried = 0.0
    found = balance(made, emitted, records.reshape(-1))
    assert found == pytest.approx(expected, rel=1e-5)
    assert min(found.values()) > 0.0


def test_nothing_is_lost_to_rounding(made):
    """Where every segment tells of its path, what is lost is none at all."""
    emitted, records = PHOTON_PATH.zeros(PATHS), PHOTON.zeros(PATHS * SEGMENTS)
    emitted["flux"] = 0.1
    records["flags"] = PhotonFlag.ACTIVE
    records["scattered_flux"] = 0.03
    found = balance(made, emitted, records)
    assert found["lost"] == 0.0 and found["escaped"] == 0.0
    assert found["absorbed"] + found["deposited"] == pytest.approx(found["emitted"], rel=1e-6)

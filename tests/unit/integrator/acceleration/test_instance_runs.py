# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of rows that are written together."""

import numpy as np
import pytest

from rppm_addon.integrator.acceleration.instance_records import runs


@pytest.mark.parametrize("most", [1, 100, 1 << 16])
@pytest.mark.parametrize("step", [1, 2, 200, 257, 5000])
def test_runs_hold_all_rows_in_their_order(step, most):
    rows = np.arange(7, 30_000, step)
    found = runs(rows, most)
    assert all(0 < len(run) <= most and (np.diff(run) == 1).all() for run in found)
    together = np.concatenate(found)
    assert (np.diff(together) > 0).all() and np.isin(rows, together).all()
    assert together[0] == rows[0] and together[-1] == rows[-1]


def test_rows_far_apart_are_written_alone():
    assert [run.tolist() for run in runs(np.array([3, 4, 6, 1000, 5000]), 64)] == [[3, 4, 5, 6], [1000], [5000]]
    assert runs(np.zeros(0, np.int64), 64) == []


def test_there_are_few_runs_however_rows_are_scattered():
    rows = np.flatnonzero(np.random.default_rng(1).random(100_000) < 0.2)
    assert len(runs(rows, 1 << 16)) == 2

# SPDX-License-Identifier: GPL-3.0-or-later
"""Owen-scrambled points: every elementary interval of 2^k points holds one."""

import numpy as np
import pytest

from rppm_addon.integrator.common.low_discrepancy import scrambled_sobol, van_der_corput


@pytest.mark.parametrize("start", [0, 64, 4096])
@pytest.mark.parametrize("seeds", [(1, 2, 3), (0xFFFFFFFF, 0x12345678, 0)])
def test_elementary_intervals_hold_one_point_each(start, seeds):
    points = np.array([scrambled_sobol(start + index, seeds) for index in range(64)])
    for power in range(7):
        columns, rows = 1 << power, 64 >> power
        cells = (points * [columns, rows]).astype(int)
        assert len(np.unique(cells[:, 0] * rows + cells[:, 1])) == 64, power


def test_one_dimension():
    points = np.array([van_der_corput(index, 99) for index in range(256)])
    assert sorted((points * 256).astype(int)) == list(range(256))


def test_seeds_shuffle_and_scramble():
    sets = [[scrambled_sobol(index, (seed, seed + 1, seed + 2)) for index in range(4)] for seed in (0, 10, 20)]
    assert len({tuple(points) for points in sets}) == 3

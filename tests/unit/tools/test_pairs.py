# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of tools/pairs.py."""

import numpy as np
import pytest

from tools.pairs import median_ratio


def test_median_of_blocks_is_not_moved_by_bright_spots():
    theirs = np.random.default_rng(1).random((32, 40, 4)) + 0.5
    ours = theirs * 1.02
    ours[3, 5] = 1e4
    assert median_ratio(ours, theirs) == pytest.approx(1.02)


def test_blocks_that_are_black_do_not_count():
    theirs = np.ones((16, 16, 4))
    theirs[:8] = 0.0
    ours = np.where(theirs > 0.0, 0.9, 0.0)
    assert median_ratio(ours, theirs) == pytest.approx(0.9)
    assert np.isnan(median_ratio(ours, np.zeros_like(ours)))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of fibers against Cycles; but for one, with the long tests."""

import pytest

from .fibers import GROUPS
from .measure import measure, shortcomings
from .suite import ROWS
from .test_features import PART


def parameters():
    for row in (row for row in ROWS if row.group in GROUPS):
        yield pytest.param(row, id=row.id, marks=[pytest.mark.long] if row.effort > 1 else [])


@pytest.mark.parametrize("row", parameters())
def test_fibers(renderer, row):
    found = measure(row, renderer, PART)
    print(f"{row.id}: mean {found.mean:.2%} +- {found.mean_error:.2%}, block {found.block:.2%}")
    assert not shortcomings(row, found)

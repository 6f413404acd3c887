# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves, hair of particle systems and point clouds against Cycles; but for a few, with the long tests."""

import pytest

from .measure import measure, shortcomings
from .strands import GROUPS
from .suite import ROWS
from .test_features import PART

SHORT = ("Hair Curves: curly", "Point Cloud: of geometry nodes", "Particle Hair: Intercept", "Hair Info: Thickness")


def parameters():
    for row in (row for row in ROWS if row.group in GROUPS):
        yield pytest.param(row, id=row.id, marks=[] if row.id in SHORT else [pytest.mark.long])


@pytest.mark.parametrize("row", list(parameters()))
def test_strands(renderer, row):
    found = measure(row, renderer, PART)
    print(f"{row.id}: mean {found.mean:.2%} +- {found.mean_error:.2%}, block {found.block:.2%}")
    assert not shortcomings(row, found)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The Metallic BSDF against Cycles; films over conductors with the long tests."""

import pytest

from .measure import measure, shortcomings
from .metallic import GROUP
from .suite import ROWS
from .test_features import PART

OWN = [row for row in ROWS if row.group == GROUP]


@pytest.mark.parametrize(
    "row", [pytest.param(row, id=row.name, marks=[] if row is OWN[-1] else [pytest.mark.long]) for row in OWN]
)
def test_metallic(renderer, row):
    found = measure(row, renderer, PART)
    print(f"{row.id}: mean {found.mean:.2%} +- {found.mean_error:.2%}, block {found.block:.2%}")
    assert not shortcomings(row, found)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Displacement against Cycles. Rows that are one more of their kind run with the long tests."""

import pytest

from .displacement import GROUP
from .measure import measure, shortcomings
from .suite import ROWS
from .test_features import PART

SHORT = {
    "only, noise",
    "and bump, flat faces",
    "along the seam of a UV map",
    "two objects of a mesh",
    "by a vector, TANGENT",
}


ROWS_OF_GROUP = [
    pytest.param(row, id=row.name, marks=[] if row.name in SHORT else [pytest.mark.long])
    for row in ROWS
    if row.group == GROUP
]


@pytest.mark.parametrize("row", ROWS_OF_GROUP)
def test_displacement(renderer, row):
    found = measure(row, renderer, PART)
    print(f"{row.id}: mean {found.mean:.2%} +- {found.mean_error:.2%}, block {found.block:.2%}")
    assert not shortcomings(row, found)

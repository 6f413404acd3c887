# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that trace rays against Cycles; all but a few with the long tests."""

import pytest

from .measure import measure, shortcomings
from .ray_nodes import GROUPS
from .suite import ROWS
from .test_features import PART

SHORT = ("Ambient Occlusion: value", "Ambient Occlusion: only local", "Bevel: diffuse")


def parameters():
    for row in (row for row in ROWS if row.group in GROUPS):
        yield pytest.param(row, id=row.id, marks=[] if row.id in SHORT else [pytest.mark.long])


@pytest.mark.parametrize("row", list(parameters()))
def test_ray_nodes(renderer, row):
    found = measure(row, renderer, PART)
    print(f"{row.id}: mean {found.mean:.2%} +- {found.mean_error:.2%}, block {found.block:.2%}")
    assert not shortcomings(row, found)

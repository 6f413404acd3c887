# SPDX-License-Identifier: GPL-3.0-or-later
"""Zones, closures, bundles and menu switches against Cycles."""

import bpy
import pytest

from .measure import measure, shortcomings
from .suite import ROWS
from .test_features import PART
from .zones_and_closures import GROUP

OWN = [row for row in ROWS if row.group == GROUP]


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="Blender 5 is the first that has such nodes")
@pytest.mark.parametrize("row", OWN, ids=[row.name for row in OWN])
def test_zones_and_closures(renderer, row):
    found = measure(row, renderer, PART)
    print(f"{row.id}: mean {found.mean:.2%} +- {found.mean_error:.2%}, pixels that differ {found.wrong:.2%}")
    assert not shortcomings(row, found)

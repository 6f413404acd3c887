# SPDX-License-Identifier: GPL-3.0-or-later
"""Zones, closures, bundles and menu switches against Cycles."""

import bpy
import pytest

from ..row_tests import assert_near_cycles
from ..suite import ROWS
from .zones_and_closures import GROUP

OWN = [row for row in ROWS if row.group == GROUP]


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="Blender 5 is the first that has such nodes")
@pytest.mark.parametrize("row", OWN, ids=[row.name for row in OWN])
def test_zones_and_closures(renderer, row):
    assert_near_cycles(row, renderer)

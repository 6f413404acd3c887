# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves, hair of particle systems and point clouds against Cycles; but for a few, with the long tests."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .strands import GROUPS

SHORT = ("Hair Curves: curly", "Point Cloud: of geometry nodes", "Particle Hair: Intercept", "Hair Info: Thickness")


@pytest.mark.parametrize("row", parameters(GROUPS, SHORT))
def test_strands(renderer, row):
    assert_near_cycles(row, renderer)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The distribution of Ashikhmin and Shirley against Cycles; but for one row, with the long tests."""

import pytest

from .ashikhmin_shirley import GROUP
from .row_tests import assert_near_cycles, parameters

SHORT = ("Ashikhmin-Shirley: roughness 0.8",)


@pytest.mark.parametrize("row", parameters([GROUP], SHORT))
def test_ashikhmin_shirley(renderer, row):
    assert_near_cycles(row, renderer)

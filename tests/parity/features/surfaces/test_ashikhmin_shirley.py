# SPDX-License-Identifier: GPL-3.0-or-later
"""The distribution of Ashikhmin and Shirley against Cycles; but for one row, with the long tests."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .ashikhmin_shirley import GROUP

SHORT = ("Ashikhmin-Shirley: roughness 0.8",)


@pytest.mark.parametrize("row", parameters([GROUP], SHORT))
def test_ashikhmin_shirley(renderer, row):
    assert_near_cycles(row, renderer)

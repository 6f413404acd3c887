# SPDX-License-Identifier: GPL-3.0-or-later
"""Portals against Cycles."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .portals import GROUP


@pytest.mark.parametrize("row", parameters([GROUP], ()))
def test_portals(renderer, row):
    assert_near_cycles(row, renderer)

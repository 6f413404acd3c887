# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders of fibers against Cycles; but for one, with the long tests."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .fibers import GROUPS

SHORT = ("Hair: Reflection, on strands",)


@pytest.mark.parametrize("row", parameters(GROUPS, SHORT))
def test_fibers(renderer, row):
    assert_near_cycles(row, renderer)

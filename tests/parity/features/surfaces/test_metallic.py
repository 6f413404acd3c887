# SPDX-License-Identifier: GPL-3.0-or-later
"""The Metallic BSDF against Cycles; but for one row, with the long tests."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .metallic import GROUP

SHORT = ("Metallic: thin film, F82",)


@pytest.mark.parametrize("row", parameters([GROUP], SHORT))
def test_metallic(renderer, row):
    assert_near_cycles(row, renderer)

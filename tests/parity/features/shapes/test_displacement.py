# SPDX-License-Identifier: GPL-3.0-or-later
"""Displacement against Cycles; rows that are one more of their kind run with the long tests."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .displacement import GROUP

SHORT = (
    "Displacement: and bump, flat faces",
    "Displacement: along the seam of a UV map",
    "Displacement: by a vector, TANGENT",
)


@pytest.mark.parametrize("row", parameters([GROUP], SHORT))
def test_displacement(renderer, row):
    assert_near_cycles(row, renderer)

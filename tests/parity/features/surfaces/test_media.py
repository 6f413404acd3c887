# SPDX-License-Identifier: GPL-3.0-or-later
"""Media inside closed surfaces against Cycles."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .media import GROUP

SHORT = ("Media: camera in a body", "Media: nested", "Media: body that shines")


@pytest.mark.parametrize("row", parameters([GROUP], SHORT))
def test_media(renderer, row):
    assert_near_cycles(row, renderer)

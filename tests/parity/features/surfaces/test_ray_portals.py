# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray portals against Cycles; all but a few with the long tests."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .ray_portals import GROUP

SHORT = ("to another place", "turned", "the world through it", "lengths and depths behind two")


@pytest.mark.parametrize("row", parameters((GROUP,), [f"{GROUP}: {name}" for name in SHORT]))
def test_ray_portals(renderer, row):
    assert_near_cycles(row, renderer)

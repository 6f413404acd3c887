# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that trace rays against Cycles; all but a few with the long tests."""

import pytest

from .ray_nodes import GROUPS
from .row_tests import assert_near_cycles, parameters

SHORT = ("Ambient Occlusion: value", "Ambient Occlusion: only local", "Bevel: diffuse")


@pytest.mark.parametrize("row", parameters(GROUPS, SHORT))
def test_ray_nodes(renderer, row):
    assert_near_cycles(row, renderer)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that trace rays against Cycles; all but a few with the long tests."""

import pytest

from ..row_tests import assert_near_cycles, parameters
from .ray_nodes import GROUPS

SHORT = ("Ambient Occlusion: value", "Ambient Occlusion: only local", "Bevel: diffuse")


@pytest.mark.parametrize("row", parameters(GROUPS, SHORT))
def test_ray_nodes(renderer, row):
    assert_near_cycles(row, renderer)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects in Edit Mode and the modes beside it, which files are often saved in, against Cycles."""

import bpy
import pytest

from rppm_addon.blender.reports import reports_of

from ..comparison import CONVERGED, compare
from ..engines import render_cycles, render_final
from .edited import CASES, WARNINGS

FEW = {"plain", "subdivided", "box of nodes", "several", "under edit", "combed hair"}
"""Scenes that run with the other tests of each day."""


@pytest.fixture(autouse=True)
def object_mode():
    """Left as tests end: Blender does not survive every file that is opened amid an edit."""
    yield
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("case", [pytest.param(case, marks=() if case in FEW else pytest.mark.long) for case in CASES])
def test_objects_that_are_edited(renderer, case):
    """Objects that glow by their normals show shape and modifiers."""
    CASES[case](case)
    reference = render_cycles(samples=64)
    pictures = render_final(samples=32)
    compare(f"edited_{case}", pictures, reference, CONVERGED)
    warnings = reports_of(bpy.context.scene.session_uid).latest.warnings
    assert [WARNINGS.get(case, "nothing") in text for text in warnings] == [True] * (case in WARNINGS)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Freestyle's strokes over RPPM's picture beside those over Cycles'.

Blender draws them in a scene of their own, with EEVEE for all engines but Cycles.
"""

import bpy
import numpy as np
import pytest

from ..engines import cycles_pass, render_final
from ..scenes import box, camera, material, new_scene, place


@pytest.mark.long
@pytest.mark.skipif(bpy.app.version < (5, 0), reason="files of older versions name passes otherwise")
def test_strokes_are_as_wide_as_with_cycles(registered):
    scene = new_scene(64, world=0.5)
    box((1.0, 0.8, 0.6), material("ShaderNodeEmission", Color=(0.9, 0.7, 0.2), Strength=1.0), place(turn=(0, 0, 30)))
    camera((1.0, -6.0, 2.5), (0.0, 0.0, 0.0), 30.0)
    scene.render.use_freestyle, scene.render.line_thickness = True, 3.0
    scene.view_layers[0].use_freestyle = True
    line_sets = scene.view_layers[0].freestyle_settings.linesets
    lines = line_sets[0] if len(line_sets) else line_sets.new("Lines")
    lines.linestyle = bpy.data.linestyles.new("Lines")
    theirs = cycles_pass(samples=64)
    (mine,) = render_final(16, seeds=1)
    is_stroke = theirs.max(axis=-1) < 0.02
    assert is_stroke.mean() > 0.05
    assert (mine.max(axis=-1) < 0.02).sum() == pytest.approx(is_stroke.sum(), rel=0.05)
    assert np.isclose(mine, theirs, atol=0.1).all(axis=-1).mean() > 0.97, "more than noise at edges differs"
    assert mine.mean() == pytest.approx(theirs.mean(), rel=0.01)

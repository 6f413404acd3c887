# SPDX-License-Identifier: GPL-3.0-or-later
"""Filters of view layers beside Cycles'."""

import bpy
import numpy as np
import pytest

from ..engines import render_cycles, render_frame
from ..scenes import DIFFUSE, camera, light, material, new_scene, place, plane


@pytest.mark.parametrize("filtered", ["use_sky", "use_solid"])
def test_what_is_left_out_gives_no_light(renderer, filtered):
    """A floor that fills the picture, under a lamp, a sky and a card that shines outside the picture."""
    scene = new_scene(16, world=1.0)
    plane(6.0, material(DIFFUSE, Color=(0.7, 0.5, 0.3)))
    plane(1.0, material("ShaderNodeEmission", Color=(1.0, 1.0, 1.0), Strength=3.0), place(at=(0.0, 0.0, 4.0)))
    light("POINT", 50.0, place(at=(0.0, 0.5, 2.0)), shadow_soft_size=0.0)
    camera((0.0, -2.0, 2.0), (0.0, 0.0, 0.0), 40.0)
    setattr(bpy.context.view_layer, filtered, False)
    expected = render_cycles(64, seeds=1)[0]
    mine = render_frame(renderer, iterations=16, photons=1024).combined[..., :3]
    assert scene.view_layers[0].name == bpy.context.view_layer.name
    np.testing.assert_allclose(mine.mean(axis=(0, 1)), expected.mean(axis=(0, 1)), rtol=0.02)
    assert mine.mean() > 0.1

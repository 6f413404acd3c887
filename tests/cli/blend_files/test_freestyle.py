# SPDX-License-Identifier: GPL-3.0-or-later
"""Freestyle's strokes in the files of rppm."""

import subprocess
import sys

import numpy as np
import PIL.Image
import pytest
from cli.conftest import succeed

from rppm_addon.pictures import read_exr

pytest.importorskip("bpy", reason="needs the bpy wheel")

WRITE = """
import os, sys, bpy
bpy.ops.wm.read_factory_settings()
scene = bpy.context.scene
scene.render.use_freestyle, scene.render.line_thickness = True, 4.0
background = scene.world.node_tree.nodes["Background"]
background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (1, 1, 1, 1), 1
scene.view_layers[0].freestyle_settings.as_render_pass = sys.argv[2] == "pass"
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[1])
os._exit(0)
"""
"""A gray cube before a white world, with black strokes along its edges."""


@pytest.mark.long
@pytest.mark.parametrize("where", ["combined", "pass"])
def test_strokes_are_in_the_exr_as_in_the_png(tmp_path, rppm, where):
    blend, exr, png = tmp_path / "strokes.blend", tmp_path / "strokes.exr", tmp_path / "strokes.png"
    subprocess.run([sys.executable, "-c", WRITE, blend, where], check=True, capture_output=True, timeout=60)
    _, errors = succeed(rppm, "render", blend, "-o", exr, "-o", png, "--samples", "4", "--resolution", "96x72")
    black = read_exr(exr).combined[::-1, :, :3].max(axis=-1) < 0.05
    assert ("As Render Pass" in errors) == (where == "pass")
    assert np.count_nonzero(black) > 50 if where == "combined" else not black.any()
    if where == "combined":
        with PIL.Image.open(png) as image:
            shown = np.asarray(image)[..., :3].max(axis=-1)
        assert shown[black].max() < shown[~black].max() / 2 and (shown < 40).sum() > 50

# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing grows from frame to frame of a long animation."""

import bpy
import pytest
from blender_scenes import add_light, add_mesh, set_world
from support.held import HeldByFrame

FRAMES = 60
GRACE = 20
"""Frames after which all programs have been made and buffers have grown."""


@pytest.mark.parametrize("persistent", [pytest.param(False, marks=pytest.mark.long), True])
def test_sixty_frames_hold_no_more_than_twenty(lit, tmp_path, persistent):
    """Geometry, its amount, objects, a material and a light change all the time."""
    lit.render.resolution_x = lit.render.resolution_y = 16
    lit.rppm.samples, lit.rppm.photons = 1, 256
    lit.render.use_persistent_data = persistent
    row = add_mesh(lit, "Row", location=(0.0, 0.0, 0.5), scale=(0.1, 0.1, 1.0))
    row.modifiers.new("Array", "ARRAY")
    row.driver_add("modifiers[0].count").driver.expression = "1 + frame % 5"
    row.driver_add("location", 0).driver.expression = "0.01 * frame"
    add_mesh(lit, "Guest", location=(0.0, 1.0, 0.5)).driver_add("hide_render").driver.expression = "frame % 3 == 0"
    add_light(lit, "POINT", "Light").data.driver_add("energy").driver.expression = "20 + frame % 7"
    tree = bpy.data.objects["Quad"].active_material.node_tree
    tree.nodes["Diffuse BSDF"].inputs["Roughness"].driver_add("default_value").driver.expression = "(frame % 4) / 4"
    set_world(lit, (0.1, 0.1, 0.1))
    lit.frame_start, lit.frame_end = 1, FRAMES
    lit.render.filepath = str(tmp_path / "####")
    with HeldByFrame(every=5) as held:
        bpy.ops.render.render(animation=True)
    lit.render.use_persistent_data = False
    assert len(held.frames) == FRAMES // 5
    settled = [entry for entry in held.frames if entry["frame"] >= GRACE]
    for what in ("files", "threads", "textures", "buffers", "framebuffers"):
        assert len({entry[what] for entry in settled}) == 1, [entry[what] for entry in held.frames]
    # A picture, its passes and the photons of one frame take 0.2 MiB: forty frames that were kept would show.
    grown = settled[-1]["bytes"] - settled[0]["bytes"]
    assert grown < 2 << 20, [entry["bytes"] >> 10 for entry in held.frames]

# SPDX-License-Identifier: GPL-3.0-or-later
"""Light groups of view layers: what is exported of them, and their passes in Blender's files and compositor."""

import bpy
import numpy as np
import pytest
from blender_scenes import depsgraph, export, set_world
from drawing import context_of, drawn
from exr import read_channels, write_exr

from rppm_addon.blender.export import SceneSync
from rppm_addon.blender.export.camera.camera import export_camera


@pytest.fixture
def grouped(lit):
    """``lit`` with the groups key, of its lights, and world, of the world, and an object in a group that there is
    not."""
    for name in ("key", "world"):
        lit.view_layers[0].lightgroups.add(name=name)
    for member in lit.objects:
        if member.type == "LIGHT":
            member.lightgroup = "key"
    set_world(lit, (0.5, 0.5, 0.5)).lightgroup = "world"
    bpy.data.objects["Quad"].lightgroup = "nobody"
    return lit


def test_groups_are_exported(grouped):
    scene = export(grouped)
    assert scene.settings.light_groups == ("key", "world")
    assert {light.light_group for light in scene.lights} == {"key"}
    assert scene.world.light_group == "world"
    assert [instance.light_group for instance in scene.instances] == ["nobody"]


def test_a_scene_that_lives_on_follows_its_groups(grouped):
    """Blender tells nothing of changes of light groups."""
    sync = SceneSync(viewport=False)

    def follow():
        return sync.update(depsgraph(), export_camera(grouped, depsgraph()))

    assert {light.light_group for light in follow().lights} == {"key"}
    next(member for member in grouped.objects if member.type == "LIGHT").lightgroup = "world"
    assert {light.light_group for light in follow().lights} == {"world"}
    grouped.view_layers[0].lightgroups.add(name="rim")
    assert follow().settings.light_groups == ("key", "world", "rim")


def test_files_have_the_passes(grouped, tmp_path):
    write_exr(grouped, tmp_path / "picture.exr")
    bpy.ops.render.render(write_still=True)
    planes, _ = read_channels(tmp_path / "picture.exr")
    for channel in "RGB":
        key, world = (planes[f"ViewLayer.Combined_{group}.{channel}"] for group in ("key", "world"))
        np.testing.assert_allclose(key + world, planes[f"ViewLayer.Combined.{channel}"], rtol=1e-5, atol=1e-6)
        assert key.max() > 0.0 and world.max() > 0.0


def test_panels_show_them(grouped):
    context = context_of(grouped, object=bpy.data.objects["Quad"], world=grouped.world)
    for name in ("RPPM_PT_object_light_group", "RPPM_PT_world_light_group"):
        assert drawn(getattr(bpy.types, name), context).properties == ["lightgroup"], name
    view_layer = drawn(bpy.types.RPPM_PT_passes_light_groups, context)
    assert view_layer.properties == ["lightgroups"]

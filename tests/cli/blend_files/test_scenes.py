# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of several scenes in the program."""

import argparse

import pytest
from cli.conftest import run_in_blender, succeed

from rppm_addon.commands.options.options import refuse_blend_options
from rppm_addon.pictures import read_exr
from rppm_addon.scene.errors import SettingsError

_MAKE_SCENES = """
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
first = bpy.context.scene
first.rppm.samples, first.rppm.photons = 1, 256
first.render.resolution_x, first.render.resolution_y = 24, 12
other = first.copy()
other.use_fake_user = True
first.name, other.name = "Open", "Closed"
other.render.resolution_x = 20
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[2])
"""


@pytest.fixture(scope="module")
def scenes_file(tmp_path_factory, blend_files):
    """The floor in a scene of 24 pixels across, which is open, and in one of 20."""
    path = tmp_path_factory.mktemp("scenes") / "scenes.blend"
    run_in_blender(_MAKE_SCENES, blend_files[0], path)
    return path


def test_a_scene_that_is_named(tmp_path, rppm, scenes_file):
    path = tmp_path / "out.exr"
    succeed(rppm, "render", scenes_file, "--scene-name", "Closed", "--frame", "1", "-o", path)
    picture = read_exr(path).combined
    assert picture.shape[:2] == (12, 20) and picture[..., :3].max() > 0.0


def test_a_scene_that_is_not_there(tmp_path, rppm, scenes_file):
    status, _, errors = rppm("render", scenes_file, "--scene-name", "Nowhere", "-o", tmp_path / "out.exr")
    assert (status, errors.count("\n")) == (1, 1)
    assert 'there is no scene "Nowhere"; there are Closed, Open' in errors


def test_saved_scenes_have_no_others():
    options = argparse.Namespace(frame=None, scene_name="Other", view_layers=[])
    with pytest.raises(SettingsError, match="--scene-name needs a .blend file"):
        refuse_blend_options(options, [])

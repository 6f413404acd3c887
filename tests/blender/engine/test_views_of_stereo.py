# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of stereo and multiview: what each is exported with, and where its picture goes."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_object
from recorder import Recorder, record

from rppm_addon.pictures import PictureName
from rppm_addon.session.checkpoints.checkpoint_file import read_summary

DISTANCE = 0.2


@pytest.fixture
def stereo(lit):
    """``lit`` seen in perspective by both eyes around the camera."""
    data = lit.camera.data
    data.type, data.stereo.interocular_distance, data.stereo.pivot = "PERSP", DISTANCE, "CENTER"
    lit.render.use_multiview = True
    return lit


def taken():
    recorder = record(Recorder(renders=False))
    assert recorder.pictures == [PictureName("ViewLayer", eye) for eye in ("left", "right")]
    return recorder.scenes


@pytest.mark.parametrize("persistent", [False, True])
def test_each_view_has_the_camera_that_blender_gives(stereo, persistent):
    stereo.render.use_persistent_data = persistent
    left, right = (scene.camera for scene in taken())
    np.testing.assert_allclose(left.matrix[:3, 3], (-0.5 * DISTANCE, 0.0, 5.0), atol=1e-6)
    np.testing.assert_allclose(right.matrix[:3, 3], (0.5 * DISTANCE, 0.0, 5.0), atol=1e-6)
    assert left.window[0] + left.window[1] == pytest.approx(-right.window[0] - right.window[1])
    assert left.window[0] + left.window[1] > 0.0  # toward the middle


@pytest.mark.parametrize("views", ["STEREO_3D", "MULTIVIEW"])
def test_both_eyes_of_what_is_no_camera_are_where_it_is(stereo, views):
    """An object without data, which Blender would crash on if asked for its eyes."""
    empty = add_object(stereo, "Empty", None, location=(0.0, 0.0, 5.0))
    stereo.camera, stereo.render.views_format = empty, views
    for scene in taken():
        np.testing.assert_allclose(scene.camera.matrix[:3, 3], (0.0, 0.0, 5.0), atol=1e-6)
        assert scene.camera.window[0] == pytest.approx(-scene.camera.window[1])


def test_views_move_as_the_camera_does(stereo):
    camera = stereo.camera
    for frame, x in ((1, 0.0), (3, 2.0)):
        camera.location.x = x
        camera.keyframe_insert("location", frame=frame)
    stereo.render.use_motion_blur, stereo.render.motion_blur_position = True, "CENTER"
    stereo.frame_set(2)
    for scene, aside in zip(taken(), (-0.5 * DISTANCE, 0.5 * DISTANCE), strict=True):
        movement = scene.shutter.camera
        assert scene.camera.matrix[0, 3] == pytest.approx(1.0 + aside, abs=1e-5)
        np.testing.assert_allclose(movement.matrices[:, 0, 3].mean(), 1.0 + aside, atol=1e-3)
        assert np.ptp(movement.matrices[:, 0, 3]) > 0.1


def test_checkpoints_are_of_each_view(stereo, tmp_path):
    stereo.rppm.samples, stereo.rppm.checkpoint_path = 1, str(tmp_path / "kept.exr")
    bpy.ops.render.render()
    for eye in ("left", "right"):
        assert read_summary(tmp_path / f"kept_{eye}.exr").iteration == 1


def test_one_view_is_left_alone(stereo):
    stereo.render.views["right"].use = False
    assert record(Recorder(renders=False)).pictures == [PictureName("ViewLayer", "left")]

# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of viewports, from the matrices that Blender draws them with."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import depsgraph
from mathutils import Matrix

from rppm_addon.blender.export.camera.camera import export_camera
from rppm_addon.blender.export.camera.view import export_view
from rppm_addon.scene.errors import SceneError

WIDTH, HEIGHT = 480, 270


@pytest.fixture
def camera(scene):
    """The scene's camera, looking askew, whose frame is as large as the region."""
    camera = scene.camera
    camera.matrix_world = Matrix.Translation((1.0, -4.0, 2.0)) @ Matrix.Rotation(1.1, 4, "X")
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    return camera


def context_of(camera, view_perspective="CAMERA", projection=None, **space):
    """Return the context that view_draw is given."""
    bpy.context.view_layer.update()
    if projection is None:
        projection = camera.calc_matrix_camera(depsgraph(), x=WIDTH, y=HEIGHT)
    region_data = SimpleNamespace(
        view_matrix=camera.matrix_world.inverted(),
        window_matrix=projection,
        view_perspective=view_perspective,
        is_perspective=abs(projection[3][3]) < 0.5,
    )
    members = {"camera": camera, "clip_start": 0.02, "clip_end": 300.0, "use_render_border": False} | space
    return SimpleNamespace(
        region=SimpleNamespace(width=WIDTH, height=HEIGHT),
        region_data=region_data,
        space_data=SimpleNamespace(**members),
        scene=bpy.context.scene,
    )


def view_of(camera, *arguments, **space):
    return export_view(context_of(camera, *arguments, **space), depsgraph())


def assert_final(camera):
    """The camera's view is that of a final picture."""
    view = view_of(camera)
    final = export_camera(bpy.context.scene, depsgraph())
    np.testing.assert_allclose(view.matrix, final.matrix, atol=1e-6)
    np.testing.assert_allclose(view.window, final.window, rtol=2e-5, atol=1e-6)
    names = ("width", "height", "orthographic", "clip_start", "clip_end", "crop", "panorama", "aperture")
    for name in names:
        assert getattr(view, name) == pytest.approx(getattr(final, name)), name


@pytest.mark.parametrize(
    "members",
    [
        {},
        {"lens": 85.0, "shift_x": 0.2, "shift_y": -0.1},
        {"sensor_fit": "VERTICAL", "sensor_height": 18.0},
        {"type": "ORTHO", "ortho_scale": 3.0, "shift_x": 0.1},
        {"dof.use_dof": True, "dof.aperture_fstop": 1.4, "dof.focus_distance": 3.0, "dof.aperture_blades": 5},
        {"clip_start": 0.5, "clip_end": 20.0},
    ],
)
def test_the_camera_s_view_is_the_final_picture(camera, members):
    for name, value in members.items():
        owner, _, last = name.rpartition(".")
        setattr(camera.data.dof if owner else camera.data, last, value)
    assert_final(camera)


@pytest.mark.parametrize("kind", ["PERSP", "PANO"])
def test_the_scene_s_border_is_that_of_the_camera_s_frame(camera, scene, kind):
    camera.data.type = kind
    scene.render.use_border = True
    edges = {"min_x": 0.25, "max_x": 0.75, "min_y": 0.1, "max_y": 0.6}
    for name, value in edges.items():
        setattr(scene.render, f"border_{name}", value)
    # To a pixel: final renders cut borders down, the view shows the pixels that are touched.
    np.testing.assert_allclose(view_of(camera).crop, export_camera(scene, depsgraph()).crop, atol=1)


def test_a_view_without_a_direction_is_an_error(camera):
    context = context_of(camera)
    context.region_data.view_matrix = Matrix.Diagonal((1.0, 1.0, 0.0, 1.0))
    with pytest.raises(SceneError, match="scale of 0"):
        export_view(context, depsgraph())


def test_a_border_outside_of_the_view_is_an_error(camera, scene):
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.0, 0.1
    # Zoomed in on the middle of the frame.
    projection = context_of(camera).region_data.window_matrix.copy()
    projection[0][0] *= 4.0
    projection[1][1] *= 4.0
    with pytest.raises(SceneError, match="border"):
        view_of(camera, "CAMERA", projection)


def test_a_free_view_has_a_border_and_clips_of_its_own(camera, scene):
    scene.render.use_border = True  # the camera's
    borders = {"render_border_min_x": 0.5, "render_border_max_x": 1.0, "render_border_min_y": 0.0}
    view = view_of(camera, "PERSP", use_render_border=True, render_border_max_y=0.5, **borders)
    assert view.crop == (WIDTH // 2, 0, WIDTH, HEIGHT // 2)
    assert (view.clip_start, view.clip_end) == (0.02, 300.0)


def test_an_orthographic_view_sees_what_lies_behind_the_point_of_view(camera):
    near, far, half_width, half_height = -100.0, 100.0, 4.0, 2.25
    projection = Matrix.Diagonal((1 / half_width, 1 / half_height, -2 / (far - near), 1.0))
    projection[2][3] = -(far + near) / (far - near)
    view = view_of(camera, "ORTHO", projection)
    assert view.orthographic and view.clip_start == 0.0 and view.clip_end == pytest.approx(far - near)
    assert view.window == pytest.approx((-half_width, half_width, -half_height, half_height))
    ahead = -view.matrix[:3, 2]
    np.testing.assert_allclose(view.matrix[:3, 3], np.array(camera.matrix_world.translation) + near * ahead, atol=1e-4)


def test_a_panorama_fills_the_camera_s_frame(camera):
    if not hasattr(camera.data, "panorama_type"):
        pytest.skip("Cycles has the property in this version of Blender")
    camera.data.type, camera.data.panorama_type = "PANO", "EQUIRECTANGULAR"
    assert_final(camera)


def test_the_preview_s_pixel_size_makes_pixels_larger(camera, scene):
    scene.render.preview_pixel_size = "4"
    view = view_of(camera)
    assert (view.width, view.height) == (WIDTH // 4, HEIGHT // 4)

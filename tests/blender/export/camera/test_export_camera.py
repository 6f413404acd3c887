# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera's window against Blender's own projection."""

import math

import bpy
import numpy as np
import pytest
from blender_scenes import add_object, depsgraph, export, set_world
from bpy_extras.object_utils import world_to_camera_view
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mathutils import Vector

from rppm_addon.scene.errors import SceneError


def project(camera, point):
    """Where a world point lands in the frame, 0 to 1 from the lower left, by the exported camera alone."""
    x, y, z, _ = np.linalg.inv(camera.matrix) @ (*point, 1.0)
    if not camera.orthographic:
        x, y = x / -z, y / -z
    left, right, bottom, top = camera.window
    return (x - left) / (right - left), (y - bottom) / (top - bottom)


def blender_projection(scene, camera_object, point):
    """The same by Blender's projection matrix for the frame's size in pixels."""
    render = scene.render
    matrix = camera_object.calc_matrix_camera(
        depsgraph(),
        x=max(1, render.resolution_x * render.resolution_percentage // 100),
        y=max(1, render.resolution_y * render.resolution_percentage // 100),
        scale_x=render.pixel_aspect_x,
        scale_y=render.pixel_aspect_y,
    )
    clip = matrix @ camera_object.matrix_world.normalized().inverted() @ Vector((*point, 1.0))
    return 0.5 * (clip.x / clip.w + 1.0), 0.5 * (clip.y / clip.w + 1.0)


POINTS = [(0.3, -0.2, 0.0), (-1.0, 0.7, 1.0), (0.0, 0.0, -3.0), (2.0, 1.0, 2.0)]


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    kind=st.sampled_from(["PERSP", "ORTHO"]),
    fit=st.sampled_from(["AUTO", "HORIZONTAL", "VERTICAL"]),
    lens=st.floats(10.0, 200.0),
    sensor=st.tuples(st.floats(10.0, 50.0), st.floats(10.0, 50.0)),
    shift=st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)),
    size=st.tuples(st.integers(4, 2000), st.integers(4, 2000)),
    percentage=st.integers(10, 200),
    aspect=st.tuples(st.floats(1.0, 3.0), st.floats(1.0, 3.0)),
    rotation=st.tuples(*[st.floats(-0.3, 0.3)] * 3),
    scale=st.tuples(*[st.floats(0.2, 5.0)] * 3),
)
def test_window_agrees_with_blender(scene, kind, fit, lens, sensor, shift, size, percentage, aspect, rotation, scale):
    camera_object, data = scene.camera, scene.camera.data
    data.type, data.sensor_fit, data.lens = kind, fit, lens
    data.sensor_width, data.sensor_height = sensor
    data.ortho_scale = sensor[0] / 5.0
    data.shift_x, data.shift_y = shift
    camera_object.rotation_euler, camera_object.scale = rotation, scale
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = percentage
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect
    camera = export(scene).camera
    assert camera.orthographic == (kind == "ORTHO")
    assert camera.width == max(1, size[0] * percentage // 100) and camera.height == max(1, size[1] * percentage // 100)
    np.testing.assert_allclose(camera.matrix[:3, :3].T @ camera.matrix[:3, :3], np.eye(3), atol=1e-12)
    for point in POINTS:
        expected = blender_projection(scene, camera_object, point)
        np.testing.assert_allclose(project(camera, point), expected, rtol=2e-4, atol=2e-4)


def test_window_agrees_with_the_view_helper_of_blender(scene):
    scene.render.resolution_x, scene.render.resolution_y = 300, 200
    scene.camera.data.shift_x = 0.1
    camera = export(scene).camera
    for point in POINTS:
        seen = world_to_camera_view(scene, scene.camera, Vector(point))
        np.testing.assert_allclose(project(camera, point), seen[:2], atol=1e-5)


def test_size_and_clip_range(scene):
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 101, 55, 50
    scene.camera.data.clip_start, scene.camera.data.clip_end = 0.25, 17.0
    camera = export(scene).camera
    assert (camera.width, camera.height) == (50, 27) and camera.crop is None and camera.resolution == (50, 27)
    assert (camera.clip_start, camera.clip_end) == (0.25, 17.0)


def test_one_pixel(scene):
    scene.render.resolution_x = scene.render.resolution_y = 4  # the least that Blender takes
    scene.render.resolution_percentage = 1
    assert export(scene).camera.resolution == (1, 1)


@pytest.mark.parametrize("cropped", [False, True])
def test_border(scene, cropped):
    render = scene.render
    render.resolution_x, render.resolution_y = 100, 50
    whole = export(scene).camera
    render.use_border, render.use_crop_to_border = True, cropped
    render.border_min_x, render.border_max_x = 0.251, 0.758
    render.border_min_y, render.border_max_y = 0.1, 0.9
    camera = export(scene).camera
    assert camera.crop == (25, 5, 75, 45) and camera.resolution == (50, 40)
    assert camera.window == whole.window and (camera.width, camera.height) == (100, 50)


def test_border_without_a_pixel(scene):
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.5, 0.501
    with pytest.raises(SceneError, match="border"):
        export(scene)


def test_mirrored_and_sheared_cameras_stay_so(scene):
    scene.camera.scale = (-2.0, 1.0, 1.0)
    exported = export(scene)
    assert np.linalg.det(exported.camera.matrix) == pytest.approx(-1.0)
    assert not exported.camera.is_sheared
    parent = add_object(scene, "Parent", None, scale=(1.0, 1.0, 2.0))
    scene.camera.scale, scene.camera.rotation_euler = (1.0, 1.0, 1.0), (0.8, 0.0, 0.0)
    scene.camera.parent = parent
    exported = export(scene)
    assert exported.warnings == []
    assert exported.camera.is_sheared
    np.testing.assert_allclose(np.linalg.norm(exported.camera.matrix[:3, :3], axis=0), 1.0, atol=1e-12)


def test_no_camera(scene):
    scene.camera = None
    with pytest.raises(SceneError, match="no camera.*add one"):
        export(scene)


@pytest.mark.parametrize(
    ("kind", "lens"), [(None, 50.0), ("POINT", 16.0 / np.tan(np.pi / 8)), ("SPOT", 16.0 / np.tan(0.3))]
)
def test_a_camera_that_is_no_camera(scene, kind, lens):
    """Any object can be looked through; a spot shows what lies in its cone."""
    data = kind and bpy.data.lights.new("Light", kind)
    if kind == "SPOT":
        data.spot_size = 0.6
    scene.camera = add_object(scene, "Other", data)
    exported = export(scene)
    assert exported.warnings == []
    left, right, _, _ = exported.camera.window
    assert right - left == pytest.approx(36.0 / lens)
    assert exported.camera.clip_end == 1e5


def test_a_camera_by_shader_is_rendered_in_perspective(scene):
    if "CUSTOM" not in scene.camera.data.bl_rna.properties["type"].enum_items:
        pytest.skip("this Blender has no custom cameras")
    scene.camera.data.type = "CUSTOM"
    exported = export(scene)
    (warning,) = exported.warnings
    assert '"Camera"' in warning and "in perspective" in warning and "Open Shading Language" in warning
    scene.camera.data.type = "PERSP"
    assert exported.camera.window == export(scene).camera.window


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO", "PANO"])
@pytest.mark.parametrize("scale", [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 1.0)])
def test_a_camera_without_scale_sees_the_world_only(renderer, lit, scale, kind):
    """As in Cycles, where an axis has no direction."""
    set_world(lit, (0.25, 0.5, 0.125))
    lit.camera.scale, lit.camera.data.type = scale, kind
    if kind == "PANO":
        owner = lit.camera.data if hasattr(lit.camera.data, "panorama_type") else lit.camera.data.cycles
        owner.panorama_type = "EQUIRECTANGULAR"
    exported = export(lit)
    (warning,) = exported.warnings
    assert "the world only" in warning and "scale" in warning
    seen = renderer.render(exported).frame.combined
    np.testing.assert_allclose(seen[..., :3], np.broadcast_to((0.25, 0.5, 0.125), (32, 32, 3)), rtol=1e-5)


@pytest.mark.parametrize("scale", [(2.0, 1.0, 1.0), (1.0, 3.0, 0.5), (1e-7, 1e-7, 1e-7), (1e-9, 1.0, 1e6)])
def test_uneven_scales_of_cameras_are_nothing(scene, scale):
    scene.camera.rotation_euler = (0.8, 0.1, 0.3)
    before = export(scene)
    scene.camera.scale = scale
    after = export(scene)
    np.testing.assert_allclose(after.camera.matrix, before.camera.matrix, atol=1e-5)
    assert after.warnings == [] and after.camera.clip_end == before.camera.clip_end


def test_field_of_view(scene):
    scene.camera.data.angle = math.radians(90.0)
    left, right, bottom, top = export(scene).camera.window
    assert (left, right, bottom, top) == pytest.approx((-1.0, 1.0, -1.0, 1.0), abs=1e-6)

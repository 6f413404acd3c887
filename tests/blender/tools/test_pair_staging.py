# SPDX-License-Identifier: GPL-3.0-or-later
"""Additions of tools/pairs to files that cannot be rendered as they are."""

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

from tests.parity.scenes import DIFFUSE, ball, light, material, new_scene, place
from tools.pairs import staging


def test_camera_sees_everything():
    scene = new_scene()
    balls = [ball(1.0, material(DIFFUSE), place(at)) for at in ((5.0, 2.0, 1.0), (-3.0, 0.0, 2.0))]
    bpy.context.view_layer.update()
    staging.add_camera(scene)
    bpy.context.view_layer.update()
    corners = [part.matrix_world @ Vector(corner) for part in balls for corner in part.bound_box]
    seen = [world_to_camera_view(scene, scene.camera, corner) for corner in corners]
    assert all(0.0 < x < 1.0 and 0.0 < y < 1.0 and depth > 0.0 for x, y, depth in seen)
    assert max(x for x, _, _ in seen) - min(x for x, _, _ in seen) > 0.5  # of the frame


def test_sun_is_for_files_without_lamps():
    def lamps(scene):
        return [part.data.type for part in scene.objects if part.type == "LIGHT"]

    scene = new_scene()
    ball(1.0, material(DIFFUSE))
    staging.add_camera(scene)
    assert lamps(scene) == ["SUN"]
    scene = new_scene()
    ball(1.0, material(DIFFUSE))
    light("POINT", 100.0, place((0.0, 0.0, 5.0)))
    staging.add_camera(scene)
    assert lamps(scene) == ["POINT"]


def test_library_is_a_file_for_its_materials():
    scene = new_scene()
    ball(1.0, material(DIFFUSE))
    assert not staging.is_library()
    for _ in range(4):
        material(DIFFUSE)
    assert staging.is_library()
    staging.add_camera(scene)
    assert not staging.is_library()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramas and depth of field as exported."""

import math
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_object, export

from rppm_addon.blender.export.camera.lens import export_panorama
from rppm_addon.scene import PanoramaKind
from rppm_addon.scene.errors import SceneError


def panorama(scene, kind, **properties):
    """The scene's camera made a panorama, exported."""
    camera = scene.camera.data
    camera.type = "PANO"
    for name, value in {"panorama_type": kind, **properties}.items():
        setattr(camera, name, value)
    return export(scene).camera


def test_equirectangular(scene):
    camera = panorama(
        scene, "EQUIRECTANGULAR", latitude_min=-0.5, latitude_max=1.0, longitude_min=-2.0, longitude_max=3.0
    )
    assert camera.panorama.kind is PanoramaKind.EQUIRECTANGULAR and not camera.orthographic
    assert camera.panorama.latitude == (-0.5, 1.0) and camera.panorama.longitude == (-2.0, 3.0)
    assert camera.window == (0.0, 1.0, 0.0, 1.0) and camera.aperture is None


def test_shift_moves_a_panorama_by_shares_of_the_frame(scene):
    camera = panorama(scene, "FISHEYE_EQUIDISTANT", fisheye_fov=2.0, shift_x=0.25, shift_y=-0.5)
    assert camera.window == (0.25, 1.25, -0.5, 0.5)
    assert camera.panorama.kind is PanoramaKind.FISHEYE_EQUIDISTANT and camera.panorama.field_of_view == 2.0


@pytest.mark.parametrize(
    ("fit", "size", "aspect", "sensor"),
    [
        ("AUTO", (200, 100), 1.0, (40.0, 20.0)),
        ("AUTO", (100, 200), 1.0, (20.0, 40.0)),
        ("HORIZONTAL", (100, 200), 1.0, (40.0, 80.0)),
        ("VERTICAL", (200, 100), 1.0, (60.0, 30.0)),
        ("AUTO", (100, 100), 2.0, (40.0, 20.0)),
    ],
)
def test_sensor_of_a_fisheye(scene, fit, size, aspect, sensor):
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.pixel_aspect_x = aspect
    properties = {"sensor_fit": fit, "sensor_width": 40.0, "sensor_height": 30.0, "fisheye_lens": 8.0}
    camera = panorama(scene, "FISHEYE_EQUISOLID", **properties)
    assert camera.panorama.sensor == pytest.approx(sensor) and camera.panorama.lens == 8.0


def test_polynomial_and_cylinder(scene):
    coefficients = {f"fisheye_polynomial_k{power}": 0.5**power for power in range(5)}
    camera = panorama(scene, "FISHEYE_LENS_POLYNOMIAL", **coefficients)
    assert camera.panorama.polynomial == (1.0, 0.5, 0.25, 0.125, 0.0625)
    if "CENTRAL_CYLINDRICAL" in scene.camera.data.bl_rna.properties["panorama_type"].enum_items:
        camera = panorama(
            scene, "CENTRAL_CYLINDRICAL", central_cylindrical_radius=2.0, central_cylindrical_range_v_max=3.0
        )
        assert camera.panorama.height == (-0.5, 1.5)


def stand_in(**properties):
    """A camera as Blender before 5 has it: panorama properties on what Cycles adds."""
    basics = {"sensor_fit": "AUTO", "sensor_width": 36.0, "sensor_height": 24.0}
    return SimpleNamespace(**basics, **properties)


def test_properties_that_cycles_adds(scene):
    polynomial = {f"fisheye_polynomial_k{power}": 0.0 for power in range(5)}
    cycles = SimpleNamespace(
        panorama_type="FISHEYE_EQUISOLID", fisheye_fov=2.5, fisheye_lens=9.0, latitude_min=-1.0, **polynomial
    )
    found = export_panorama(stand_in(cycles=cycles), "Camera", 200.0, 100.0)
    assert found.kind is PanoramaKind.FISHEYE_EQUISOLID and found.lens == 9.0 and found.sensor == (36.0, 18.0)


def test_panoramas_that_cannot_be_rendered_name_the_remedy(scene):
    with pytest.raises(SceneError, match='"Eye".*add-on Cycles'):
        export_panorama(stand_in(), "Eye", 1.0, 1.0)
    with pytest.raises(SceneError, match='"Eye".*PANINI.*Equirectangular'):
        export_panorama(stand_in(panorama_type="PANINI"), "Eye", 1.0, 1.0)


def test_aperture(scene):
    camera, lens = scene.camera.data, scene.camera.data.dof
    camera.lens = 80.0
    lens.use_dof, lens.focus_distance, lens.aperture_fstop = True, 3.5, 2.0
    lens.aperture_blades, lens.aperture_rotation, lens.aperture_ratio = 6, 0.3, 1.5
    exported = export(scene)
    aperture = exported.camera.aperture
    assert aperture.radius == pytest.approx(0.08 / 4) and aperture.focus_distance == 3.5
    assert aperture.blades == 6 and (aperture.rotation, aperture.ratio) == pytest.approx((0.3, 1.5))
    assert exported.warnings == []
    camera.type = "PANO"
    assert export(scene).camera.aperture.radius == pytest.approx(0.08 / 4)
    camera.type = "ORTHO"
    assert export(scene).camera.aperture.radius == pytest.approx(1 / 4)
    lens.use_dof = False
    assert export(scene).camera.aperture is None


def test_focus_on_an_object_is_along_the_view_axis(scene):
    """The camera stands at (0, 0, 5) and looks down."""
    lens = scene.camera.data.dof
    lens.use_dof, lens.focus_distance = True, 100.0
    parent = add_object(scene, "Parent", None, location=(0.0, 0.0, 0.5))
    target = add_object(scene, "Target", None, location=(3.0, 4.0, 1.0), parent=parent)
    lens.focus_object = target
    assert export(scene).camera.aperture.focus_distance == pytest.approx(3.5)
    scene.camera.scale = (2.0, 2.0, 2.0)
    assert export(scene).camera.aperture.focus_distance == pytest.approx(3.5)
    scene.camera.rotation_euler = (math.pi, 0.0, 0.0)
    assert export(scene).camera.aperture.focus_distance == pytest.approx(3.5)


def test_focus_on_a_bone(scene):
    data = bpy.data.armatures.new("Armature")
    armature = add_object(scene, "Armature", data)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bone = data.edit_bones.new("Bone")
    bone.head, bone.tail = (0.0, 0.0, 2.0), (0.0, 0.0, 3.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    lens = scene.camera.data.dof
    lens.use_dof, lens.focus_object = True, armature
    assert export(scene).camera.aperture.focus_distance == pytest.approx(5.0)
    lens.focus_subtarget = "Bone"
    assert export(scene).camera.aperture.focus_distance == pytest.approx(3.0)
    assert np.isfinite(export(scene).camera.matrix).all()

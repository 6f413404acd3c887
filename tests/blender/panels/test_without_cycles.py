# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels and renders while Cycles' add-on is disabled."""

import addon_utils
import bpy
import pytest
from blender_scenes import add_light, add_mesh, export, set_world
from drawing import context_of, drawn_panels

from rppm_addon.blender import panels
from rppm_addon.blender.panels.base import RppmPanel

PANELS = [cls for cls in panels.CLASSES if issubclass(cls, RppmPanel)]


@pytest.fixture
def without_cycles(scene):
    addon_utils.disable("cycles")
    yield scene
    addon_utils.enable("cycles")


def everything_of(scene):
    """Contexts in which the panels of all tabs have something to show."""
    cube, light = add_mesh(scene, "Quad"), add_light(scene, "AREA")
    cube.modifiers.new("Subdivision", "SUBSURF")
    return context_of(scene, object=cube, light=light.data, world=set_world(scene), camera=scene.camera.data)


def test_panels_name_what_the_addon_adds_and_offer_to_enable_it(without_cycles):
    records = drawn_panels(PANELS, everything_of(without_cycles))
    named = {name: record.labels for name, record in records.items() if record.operators}
    offered = {
        name: labels[0].removeprefix("With Cycles' add-on: ")
        for name, labels in named.items()
        if labels and labels[0].startswith("With Cycles' add-on")
    }
    expected = {
        "RPPM_PT_light": "Portal, Max Bounces",
        "RPPM_PT_motion_blur": "Rolling Shutter",
        "RPPM_PT_curves": "Shape, Curve Subdivisions",
        "RPPM_PT_subdivision": "Dicing Rate, Offscreen Scale, Max Subdivisions, Dicing Camera",
        "RPPM_PT_object_motion_blur": "Motion Blur, Steps, Deformation",
        "RPPM_PT_simplify": "Texture Limit, Culling",
        "RPPM_PT_object_culling": "Camera Culling, Distance Culling",
        "RPPM_PT_world_ray_visibility": "Ray Visibility, Max Bounces",
    }
    if bpy.app.version < (5, 0):
        expected |= {
            "RPPM_PT_shadow_terminator": "Geometry Offset, Shading Offset",
            "RPPM_PT_adaptive_subdivision": "Adaptive Subdivision, Dicing Scale",
        }
    assert offered == expected
    for name in offered:
        (button,) = [shown for shown in records[name].operators if shown._identifier == "preferences.addon_enable"]
        assert button.module == "cycles"


def test_with_the_addon_the_same_panels_show_its_properties(scene):
    records = drawn_panels(PANELS, everything_of(scene))
    assert not any("add-on" in label for record in records.values() for label in record.labels)
    shown = {name for record in records.values() for name in record.properties}
    assert shown >= {
        "is_portal", "max_bounces", "motion_steps", "use_deform_motion", "use_camera_cull", "use_distance_cull",
        "texture_limit", "texture_limit_render", "shape", "dicing_rate", "preview_dicing_rate", "camera",
        "use_adaptive_subdivision", "offscreen_dicing_scale", "max_subdivisions", "dicing_camera",
    }  # fmt: skip


def test_scenes_are_exported_with_the_defaults_of_cycles(without_cycles):
    everything_of(without_cycles)
    scene = export(without_cycles)
    assert len(scene.lights) == 1 and len(scene.instances) == 1 and scene.warnings == []

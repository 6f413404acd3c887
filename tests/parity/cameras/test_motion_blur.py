# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion while the shutter is open, compared with Cycles.

Cycles' table of times ends at 255/256 of the shutter's time, so that what moves through the picture lies up to a tenth
of a pixel behind; all scenes have some light in all of the picture, beside which that is little.
"""

import bpy
import numpy as np
import pytest
from support.moving import animate, blur

from ..comparison import CAUSTIC, CONVERGED, compare
from ..engines import render_cycles
from ..scenes import (
    DIFFUSE,
    EMISSION,
    GLASS,
    GLOSSY,
    ball,
    box,
    camera,
    light,
    link_object,
    material,
    new_scene,
    place,
    plane,
)
from .moments import cycles_at_moments, render_blurred

SETTINGS = {"photons": 2048, "photon_path_length": 5, "camera_path_length": 5, "iterations": 48, "seeds": 2}


def stage(world: float = 0.3) -> None:
    """A floor, an area light above it, and a camera that looks down."""
    new_scene(world=world)
    plane(6.0, material(DIFFUSE, Color=(0.6, 0.6, 0.6)))
    light("AREA", 60.0, place(at=(0.8, -1.0, 2.5), turn=(20.0, 15.0, 0.0)), shape="SQUARE", size=0.4)
    camera((0.0, -4.0, 2.6), (0.0, 0.0, 0.3), 40.0)


def bar() -> bpy.types.Object:
    return box((0.7, 0.2, 0.15), material(DIFFUSE, Color=(0.8, 0.2, 0.1)), place(at=(0.0, 0.0, 0.6)))


def compare_with_cycles(renderer, name: str, samples: int = 128, tolerance=CONVERGED, **settings: object) -> None:
    reference = render_cycles(samples)
    compare(f"motion_{name}", render_blurred(renderer, **SETTINGS | settings), reference, tolerance)


def test_a_moving_object_and_its_shadow(renderer):
    stage()
    animate(bar(), "location", (-1.2, 0.0, 0.6), (0.0, 0.2, 0.6), (1.2, 0.0, 0.9))
    blur()
    compare_with_cycles(renderer, "translation")


@pytest.mark.long
def test_a_turning_object(renderer):
    """A third of a turn, whose ends a straight way would cut off."""
    stage()
    turning = bar()
    animate(turning, "rotation_euler", (0.0, 0.3, -2.1), (0.0, 0.3, 0.0), (0.0, 0.3, 2.1))
    turning.cycles.motion_steps = 3
    blur()
    compare_with_cycles(renderer, "rotation")


@pytest.mark.long
@pytest.mark.parametrize("position", ["START", "END"])
def test_when_the_shutter_opens(renderer, position):
    """An object that stops at the frame, turning and growing as it comes, with a glossy floor."""
    stage()
    plane(1.5, material(GLOSSY, "GGX", Color=(0.8, 0.8, 0.8), Roughness=0.1), place(at=(0.0, 0.0, 0.05)))
    moving = bar()
    animate(moving, "location", (-1.5, 0.0, 0.6), (0.0, 0.0, 0.6), (0.0, 0.8, 0.6))
    animate(moving, "scale", (0.5, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 2.0))
    blur(0.8, position)
    # The light glares in the floor: few samples of it are many times as bright as their mean.
    compare_with_cycles(renderer, f"position_{position.lower()}", samples=1024, iterations=96, seeds=4)


@pytest.mark.long
def test_the_shutter_curve(renderer):
    """Opens slowly and closes at once."""
    stage()
    animate(bar(), "location", (-1.6, 0.0, 0.6), (0.0, 0.0, 0.6), (1.6, 0.0, 0.6))
    blur()
    curve = bpy.context.scene.render.motion_blur_shutter_curve.curves[0]
    curve.points[0].location, curve.points[-1].location = (0.0, 0.0), (1.0, 1.0)
    for point in curve.points:
        point.handle_type = "VECTOR"
    bpy.context.scene.render.motion_blur_shutter_curve.update()
    compare_with_cycles(renderer, "curve")


@pytest.mark.parametrize("duration", [0.3, pytest.param(0.0, marks=pytest.mark.long)])
def test_a_rolling_shutter(renderer, duration):
    """A bar that moves along the picture leans, with its shadow; each row is blurred by a part of its way."""
    stage()
    post = box((0.2, 0.2, 1.0), material(DIFFUSE, Color=(0.8, 0.2, 0.1)), place(at=(0.0, 0.0, 0.6)))
    animate(post, "location", (-1.2, 0.0, 0.6), (0.0, 0.0, 0.6), (1.2, 0.0, 0.6))
    blur()
    roll(duration)
    compare_with_cycles(renderer, f"rolling_{duration}", iterations=96)


def roll(duration: float) -> None:
    cycles = bpy.context.scene.cycles
    cycles.rolling_shutter_type, cycles.rolling_shutter_duration = "TOP", duration


@pytest.mark.long
def test_a_moving_camera_that_zooms(renderer):
    stage()
    bar()
    seen_from = bpy.context.scene.camera
    animate(seen_from, "location", (-0.5, -4.0, 2.6), (0.0, -4.0, 2.6), (0.3, -3.4, 2.6))
    animate(seen_from.data, "lens", 40.0, 50.0, 70.0)
    blur()
    compare_with_cycles(renderer, "camera")


@pytest.mark.long
def test_a_moving_camera_with_a_lens(renderer):
    """Depth of field and motion blur at once: a near object out of focus, and a far one that moves."""
    stage()
    plane(0.3, material(EMISSION, Color=(1.0, 0.8, 0.3), Strength=6.0), place(at=(-0.3, -2.0, 1.5), turn=(60, 0, 0)))
    animate(bar(), "location", (-0.8, 0.0, 0.6), (0.0, 0.0, 0.6), (0.8, 0.0, 0.6))
    seen_from = bpy.context.scene.camera
    seen_from.data.dof.use_dof, seen_from.data.dof.focus_distance, seen_from.data.dof.aperture_fstop = True, 4.3, 0.15
    animate(seen_from, "location", (-0.2, -4.0, 2.6), (0.0, -4.0, 2.6), (0.2, -4.0, 2.6))
    blur()
    compare_with_cycles(renderer, "lens", iterations=64)


def bend(owner: bpy.types.Object, how: str) -> None:
    """Let a bar bend: by shape keys, or by an armature of two bones."""
    if how == "shape_key":
        owner.shape_key_add(name="Basis")
        key = owner.shape_key_add(name="Bent")
        for point in key.data:
            point.co.z += 1.2 * point.co.x**2
            point.co.y += 0.6 * point.co.x
        animate(key, "value", -1.0 if key.slider_min < 0 else 0.0, 0.5, 1.0)
        return
    bones = link_object(bpy.data.armatures.new("Bones"))
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.mode_set(mode="EDIT")
    bone = bones.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0.0, 0.0, 0.6), (1.0, 0.0, 0.6)
    bpy.ops.object.mode_set(mode="OBJECT")
    group = owner.vertex_groups.new(name="Bone")
    for vertex in owner.data.vertices:
        group.add([vertex.index], max(0.0, vertex.co.x / 0.7), "REPLACE")
    owner.modifiers.new("Armature", "ARMATURE").object = bones
    pose = bones.pose.bones["Bone"]
    pose.rotation_mode = "XYZ"
    animate(pose, "rotation_euler", (-0.9, 0.0, -0.9), (0.0, 0.0, 0.0), (0.9, 0.0, 0.9))


@pytest.mark.long
@pytest.mark.parametrize("how", ["shape_key", "armature"])
def test_a_bending_object(renderer, how):
    stage()
    bent = bar()
    bent.modifiers.new("Subdivision", "SUBSURF").render_levels = 3
    bent.modifiers["Subdivision"].subdivision_type = "SIMPLE"
    bend(bent, how)
    bent.cycles.motion_steps = 2
    blur()
    compare_with_cycles(renderer, how)


@pytest.mark.long
def test_vertices_that_say_how_fast_they_are(renderer):
    stage()
    thrown = bar()
    velocities = thrown.data.attributes.new("velocity", "FLOAT_VECTOR", "POINT").data
    for vertex, velocity in zip(thrown.data.vertices, velocities, strict=True):
        velocity.vector = (20.0 + 10.0 * vertex.co.x, 0.0, 24.0 * vertex.co.x)  # of 24 frames a second
    blur()
    compare_with_cycles(renderer, "velocity")


MOMENTS = (np.arange(12) + 0.5) / 12 - 0.5


@pytest.mark.long
def test_a_moving_light(renderer):
    """Cycles leaves lights where they are: its pictures at moments are what a blurred one is to show."""
    stage(world=0.05)
    bar()
    spot = light("SPOT", 100.0, place(at=(0.0, -0.5, 2.2)), spot_size=0.9, shadow_soft_size=0.1)
    animate(spot, "location", (-2.0, -0.5, 2.2), (0.0, -0.5, 2.2), (1.0, 0.5, 2.2))
    animate(spot, "rotation_euler", (0.0, -0.5, 0.0), (0.0, 0.0, 0.0), (0.0, 0.9, 0.0))
    blur()
    reference = cycles_at_moments(64, MOMENTS)
    compare("motion_light", render_blurred(renderer, **SETTINGS), reference, CONVERGED)


@pytest.mark.long
def test_a_moving_emissive_mesh(renderer):
    stage(world=0.05)
    bar()
    glow = plane(0.3, material(EMISSION, Color=(0.3, 0.6, 1.0), Strength=12.0))
    animate(glow, "location", (-2.0, 0.0, 1.5), (0.0, 0.0, 1.5), (1.5, -0.5, 1.2))
    blur()
    compare_with_cycles(renderer, "emissive_mesh")


@pytest.mark.long
def test_a_moving_glass_ball_and_its_caustic(renderer):
    """Under a light wide enough for Cycles to find it through the ball."""
    new_scene(world=0.1)
    plane(6.0, material(DIFFUSE, Color=(0.6, 0.6, 0.6)))
    glow = plane(0.5, material(EMISSION, Color=(1.0, 1.0, 1.0), Strength=20.0))
    glow.matrix_world = place(at=(0.3, 0.0, 3.0), turn=(180.0, 0.0, 0.0))
    camera((0.0, -4.0, 2.6), (0.0, 0.0, 0.3), 40.0)
    glass = ball(0.4, material(GLASS, Color=(1.0, 1.0, 1.0), IOR=1.45, Roughness=0.0), place(at=(0.0, 0.0, 0.6)))
    animate(glass, "location", (-1.5, 0.0, 0.6), (0.0, 0.0, 0.6), (1.5, 0.3, 0.9))
    blur()
    compare_with_cycles(renderer, "caustic", 512, CAUSTIC, photons=16384, photon_path_length=8, camera_path_length=8)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion in the exports of final renders."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, add_object, collect, depsgraph, set_world
from node_trees import surface
from support.moving import FRAME, animate, blur, taken_scene

from rppm_addon.blender.export import SceneSync, export_scene
from rppm_addon.blender.export.updates.motion import step_times


@pytest.fixture
def scene(scene):
    """The scene with a black world."""
    set_world(scene)
    return scene


WAY = (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (2.0, 0.0, 0.0)
"""Places along X, a meter further in the frame FRAME and two in the one after it."""


@pytest.fixture
def quad(scene):
    """A quad that moves along WAY."""
    made = add_mesh(scene, "Quad")
    animate(made, "location", *WAY)
    blur()
    return made


def places(movement) -> list[float]:
    return movement.matrices[:, 0, 3].tolist()


def movement_of(scene):
    (movement,) = scene.shutter.instances
    return movement


def test_keys_lie_around_the_frame(quad):
    movement = movement_of(taken_scene())
    assert (movement.member, movement.times.tolist(), places(movement)) == (0, [0.0, 0.5, 1.0], [-0.5, 0.0, 1.0])
    assert bpy.context.scene.frame_current == FRAME and bpy.context.scene.frame_subframe == 0.0


@pytest.mark.parametrize(
    ("position", "expected"), [("START", [0.0, 0.5, 1.0]), ("CENTER", [-0.25, 0.0, 0.5]), ("END", [-0.5, -0.25, 0.0])]
)
def test_the_shutter_opens_when_it_is_told_to(quad, position, expected):
    blur(0.5, position)
    scene = taken_scene()
    np.testing.assert_allclose(places(movement_of(scene)), expected, atol=1e-6)
    assert scene.instances[0].matrix[0, 3] == pytest.approx(expected[1])
    assert bpy.context.scene.frame_current == FRAME and bpy.context.scene.frame_subframe == 0.0


def test_time_remapping_counts_once(quad):
    """A frame of a scene is half a frame of what moves: keys are half as far around where it is seen then."""
    render = bpy.context.scene.render
    render.frame_map_old, render.frame_map_new = 100, 200
    blur(2.0)
    bpy.context.scene.frame_set(2 * FRAME - 1)
    movement = movement_of(taken_scene())
    np.testing.assert_allclose(places(movement), [-1.0, -0.5, 0.0], atol=1e-6)
    assert bpy.context.scene.frame_current_final == FRAME - 0.5


def test_objects_have_as_many_keys_as_they_ask_for(quad):
    other = add_mesh(bpy.context.scene, "Other")
    animate(other, "location", (0.0, -1.0, 0.0), (0.0, 0.0, 0.0), (0.0, 2.0, 0.0))
    other.cycles.motion_steps = 2
    blur()
    first, second = taken_scene().shutter.instances
    assert (len(first.times), len(second.times)) == (3, 5)
    np.testing.assert_allclose(second.matrices[:, 1, 3], [-0.5, -0.25, 0.0, 0.5, 1.0], atol=1e-6)
    assert set(step_times(1)) < set(step_times(2)) < set(step_times(3))


def test_nothing_is_noted_where_nothing_is_blurred(quad):
    scene = bpy.context.scene
    quad.cycles.use_motion_blur = False
    blur(0.5, "START")
    still = taken_scene()  # in the middle of its way, as in Cycles
    assert still.shutter is None and still.instances[0].matrix[0, 3] == pytest.approx(0.5)
    quad.cycles.use_motion_blur = True
    for owner, name, value in (
        (scene.render, "use_motion_blur", False),
        (scene.render, "motion_blur_shutter", 0.0),
        (scene.view_layers[0], "use_motion_blur", False),
    ):
        if hasattr(owner, name):
            blur(0.5, "START")
            before = getattr(owner, name)
            setattr(owner, name, value)
            taken = taken_scene()
            assert taken.shutter is None and taken.instances[0].matrix[0, 3] == 0.0
            setattr(owner, name, before)


def test_what_does_not_move_costs_nothing(scene):
    add_mesh(scene, "Quad")
    add_mesh(scene, "Flat", scale=(1.0, 0.0, 1.0))
    add_light(scene, "AREA")
    blur()
    assert taken_scene().shutter is None


def test_only_final_renders_are_blurred(quad):
    assert export_scene(depsgraph()).shutter is None
    assert SceneSync().update(depsgraph(), taken_scene().camera).shutter is None


def bent(owner, middle=0.5):
    owner.shape_key_add(name="Basis")
    key = owner.shape_key_add(name="Bent")
    key.data[0].co.z += 1.0
    animate(key, "value", 0.0, middle, 1.0)


def test_shapes_have_keys(scene):
    quad, other = add_mesh(scene, "Quad"), add_mesh(scene, "Still")
    quad.data.shade_smooth()
    bent(quad)
    blur()
    taken = taken_scene()
    (deformation,) = taken.shutter.meshes
    assert not taken.shutter.instances and deformation.times.tolist() == [0.0, 0.5, 1.0]
    assert deformation.mesh == taken.instances[0].mesh
    np.testing.assert_allclose(deformation.positions[:, 0, 2], [0.25, 0.5, 0.75], atol=1e-6)
    np.testing.assert_array_equal(deformation.positions[1], taken.meshes[deformation.mesh].positions)
    assert np.abs(np.linalg.norm(deformation.corner_normals, axis=-1) - 1.0).max() < 1e-5
    for blurs in ("use_deform_motion", "use_motion_blur"):
        setattr(quad.cycles, blurs, False)
        assert taken_scene().shutter is None
        setattr(quad.cycles, blurs, True)
    other.cycles.use_motion_blur = False
    assert taken_scene().shutter is not None


def test_a_shape_that_rests_at_first_rests(scene):
    quad = add_mesh(scene, "Quad")
    bent(quad, 0.0)
    quad.cycles.motion_steps = 2
    blur()
    (deformation,) = taken_scene().shutter.meshes
    np.testing.assert_allclose(deformation.positions[:, 0, 2], [0.0, 0.0, 0.0, 0.25, 0.5], atol=1e-6)


def multiply_in_the_next_frame(quad):
    """Its faces are twice as many from the frame after FRAME on."""
    modifier = quad.modifiers.new("Array", "ARRAY")
    modifier.use_relative_offset, modifier.use_constant_offset = False, True
    for frame, count in ((FRAME, 1), (FRAME + 1, 2)):
        modifier.count = count
        modifier.keyframe_insert("count", frame=frame)


def test_shapes_with_other_faces_do_not_deform(scene):
    quad = add_mesh(scene, "Quad")
    multiply_in_the_next_frame(quad)
    for curve in quad.animation_data.action.layers[0].strips[0].channelbags[0].fcurves:
        for point in curve.keyframe_points:
            point.interpolation = "CONSTANT"
    blur(2.0)
    taken = taken_scene()
    assert taken.shutter is None and taken.triangle_count == 2
    assert taken.warnings and "its shape is not blurred" in taken.warnings[0] and '"Quad"' in taken.warnings[0]


def test_velocities_tell_how_vertices_go(scene):
    """Also of a mesh with other faces in each frame."""
    quad = add_mesh(scene, "Quad")
    velocities = quad.data.attributes.new("velocity", "FLOAT_VECTOR", "POINT").data
    velocities[2].vector = (0.0, 0.0, 24.0)
    velocities[3].vector = (float("nan"), 0.0, 0.0)
    multiply_in_the_next_frame(quad)
    blur(2.0)
    taken = taken_scene()
    (deformation,) = taken.shutter.meshes
    assert not taken.warnings and deformation.times.tolist() == [0.0, 0.5, 1.0]
    ways = deformation.positions - deformation.positions[1]
    np.testing.assert_allclose(ways[:, 2, 2], [-1.0, 0.0, 1.0], atol=1e-6)
    assert not ways[:, [0, 1, 3]].any()
    quad.cycles.use_deform_motion = False
    assert taken_scene().shutter is None


def test_what_is_not_there_at_times(scene):
    """It stays in its place where it comes or goes, and is not seen if it is not there in the middle."""
    goes, comes = add_mesh(scene, "Goes"), add_mesh(scene, "Comes")
    for made, hidden in ((goes, (False, False, True)), (comes, (True, True, False))):
        animate(made, "location", *WAY)
        for frame, value in enumerate(hidden, FRAME - 1):
            made.hide_render = value
            made.keyframe_insert("hide_render", frame=frame)
    blur(2.0)
    taken = taken_scene()
    assert [instance.object_name for instance in taken.instances] == ["Goes"]
    np.testing.assert_allclose(places(movement_of(taken)), [-1.0, 0.0, 0.0], atol=1e-6)


def test_instances_move_by_themselves_and_with_what_multiplies_them(scene):
    first, part = add_mesh(scene, "First"), add_mesh(scene, "Second")
    collection = collect(scene, first, part)
    animate(part, "location", (0.0, -1.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    empty = add_object(scene, "Empty", None, instance_type="COLLECTION", instance_collection=collection)
    add_object(scene, "Still", None, instance_type="COLLECTION", instance_collection=collection)
    animate(empty, "location", *WAY)
    blur()
    taken = taken_scene()
    ways = {}
    for movement in taken.shutter.instances:
        way = movement.matrices[-1, :2, 3] - movement.matrices[0, :2, 3]
        ways.setdefault(taken.instances[movement.member].object_name, []).append(tuple(np.round(way, 5)))
    assert sorted(ways["First"]) == [(1.5, 0.0)] and sorted(ways["Second"]) == [(0.0, 1.0), (1.5, 1.0)]
    empty.cycles.use_motion_blur = False
    (movement,) = taken_scene().shutter.instances
    np.testing.assert_allclose(movement.matrices[-1, :2, 3] - movement.matrices[0, :2, 3], [0.0, 1.0], atol=1e-6)


def test_particles_that_are_born_or_die_are_not_seen(scene):
    shown = add_mesh(scene, "Shown")
    emitter = add_mesh(scene, "Emitter")
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 20, 1, 20, 50
    settings.render_type, settings.instance_object, settings.normal_factor = "OBJECT", shown, 1.0
    for frame in range(1, FRAME + 1):  # particles go on from the frame before
        scene.frame_set(frame)
    scene.render.use_motion_blur = False
    alive = sum(instance.particle is not None for instance in taken_scene().instances)
    blur(2.0)
    taken = taken_scene()
    seen = [index for index, instance in enumerate(taken.instances) if instance.particle is not None]
    assert 0 < len(seen) < alive
    assert {movement.member for movement in taken.shutter.instances} == set(seen)
    for still in scene.objects:
        still.cycles.use_motion_blur = False
    unblurred = taken_scene()
    assert unblurred.shutter is None
    assert sum(instance.particle is not None for instance in unblurred.instances) == alive


def test_lights_and_cameras_move(scene):
    add_mesh(scene)
    light = add_light(scene, "POINT")
    animate(light, "location", (-1.0, 0.0, 3.0), (0.0, 0.0, 3.0), (2.0, 0.0, 3.0))
    animate(scene.camera, "location", (0.0, 0.0, 5.0), (0.0, 0.0, 5.0), (0.0, 2.0, 5.0))
    animate(scene.camera.data, "lens", 50.0, 50.0, 100.0)
    blur()
    shutter = taken_scene().shutter
    (movement,) = shutter.lights
    assert movement.member == 0 and places(movement) == [-0.5, 0.0, 1.0]
    np.testing.assert_allclose(shutter.camera.matrices[:, 1, 3], [0.0, 0.0, 1.0], atol=1e-6)
    widths = shutter.camera.windows[:, 1] - shutter.camera.windows[:, 0]
    np.testing.assert_allclose(widths, 36.0 / np.array([50.0, 50.0, 75.0]), rtol=1e-5)
    light.cycles.use_motion_blur = scene.camera.cycles.use_motion_blur = False
    assert taken_scene().shutter is None


@pytest.mark.parametrize("position", ["START", "END"])
def test_the_camera_is_that_of_the_frame(quad, position):
    """Though markers switch to others before and after it."""
    scene = bpy.context.scene
    cameras = [scene.camera]
    for number in (1, 2):
        cameras.append(add_object(scene, f"Camera {number}", scene.camera.data, location=(0.0, float(number), 5.0)))
    for number, camera in enumerate(cameras):
        scene.timeline_markers.new(camera.name, frame=FRAME - 1 + number).camera = camera
    blur(2.0, position)
    taken = taken_scene()
    assert taken.camera.matrix[1, 3] == 1.0 and taken.shutter.camera is None
    assert scene.camera == cameras[1]


def test_materials_are_those_of_the_frame(quad):
    material, shader = surface("ShaderNodeBsdfDiffuse")
    quad.data.materials.append(material)
    animate(shader.inputs["Color"], "default_value", (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0))
    blur(1.0, "END")
    taken = taken_scene()
    graph = taken.materials[taken.instances[0].materials[0]].graph
    np.testing.assert_allclose(graph.nodes[graph.surface.node].inputs["color"], (0.0, 1.0, 0.0), atol=1e-6)


def test_what_grows_from_nothing(scene):
    quad = add_mesh(scene, "Quad")
    animate(quad, "scale", (0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
    blur(2.0)
    np.testing.assert_allclose(movement_of(taken_scene()).matrices[:, 0, 0], [0.0, 1.0, 1.0], atol=1e-6)


def test_the_curve_is_sampled(quad):
    mapping = bpy.context.scene.render.motion_blur_shutter_curve
    mapping.curves[0].points[0].location = (0.0, 0.0)
    for point in mapping.curves[0].points:
        point.handle_type = "VECTOR"
    mapping.update()
    curve = taken_scene().shutter.curve
    np.testing.assert_allclose(curve, np.minimum((np.arange(256) + 0.5) / 128, 1.0), atol=2e-3)

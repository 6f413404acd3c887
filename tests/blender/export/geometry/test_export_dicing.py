# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes with Adaptive Subdivision, as they are before the renderer divides them, and by which view it does."""

import dataclasses

import bpy
import numpy as np
import pytest
from blender_scenes import CAMERA, add_mesh, add_object, collect, depsgraph, export, following, show_collection

from rppm_addon.blender.export import Eye, FrameExporter, SceneSync, export_scene
from rppm_addon.scene.meshes import Dicing
from rppm_addon.self_test.meshes import placed

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


@pytest.fixture
def cage(scene):
    """A creased cube with a UV map and Adaptive Subdivision, in a large picture."""
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 1920, 1080, 100
    cube = add_mesh(scene, "Cage", CORNERS, FACES)
    cube.data.uv_layers.new(name="UVMap")
    crease = cube.data.attributes.new("crease_edge", "FLOAT", "EDGE")
    crease.data.foreach_set("value", np.linspace(0.0, 1.0, 12))
    divide(cube)
    return cube


def divide(thing, levels=0):
    modifier = thing.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = levels
    owner = modifier if hasattr(modifier, "use_adaptive_subdivision") else thing.cycles
    owner.use_adaptive_subdivision = True
    return modifier


class Exporter(bpy.types.RenderEngine):
    """An engine that exports what Blender has it render."""

    bl_idname, bl_label = "EXPORTER", "Exporter"
    scenes = []  # noqa: RUF012

    def render(self, depsgraph):
        self.scenes.append(export_scene(depsgraph, self))


@pytest.fixture
def exported_by_render(scene):
    def give():
        scene.render.engine = Exporter.bl_idname
        bpy.ops.render.render()
        return Exporter.scenes.pop()

    bpy.utils.register_class(Exporter)
    yield give
    bpy.utils.unregister_class(Exporter)


def evaluated_positions(thing):
    mesh = thing.evaluated_get(depsgraph()).data
    return np.array([vertex.co for vertex in mesh.vertices], np.float32)


def test_levels_of_the_modifier_say_nothing(scene, cage, exported_by_render):
    """Blender has divided the mesh as often as is good for the renderer, by its own rules."""
    modifier = cage.modifiers[0]
    for levels in (0, 1, 3):
        modifier.levels = modifier.render_levels = levels
        for exported in (export(scene), exported_by_render()):
            (mesh,) = exported.meshes
            assert mesh.dicing.base_level == 6 and mesh.triangle_count == 6 * 4**6 * 2 and exported.warnings == []
        assert modifier.levels == modifier.render_levels == levels
        assert len(evaluated_positions(cage)) == [8, 26, None, 386][levels]
        assert not len(depsgraph().updates)
    owner = modifier if hasattr(modifier, "use_adaptive_subdivision") else cage.cycles
    owner.use_adaptive_subdivision, modifier.levels = False, 6
    cage.update_tag()
    np.testing.assert_array_equal(mesh.positions, evaluated_positions(cage))
    np.testing.assert_array_equal(mesh.corner_uv, export(scene).meshes[0].corner_uv)


def test_small_objects_are_hardly_divided_before(scene, cage):
    def level():
        cage.update_tag()
        return export(scene).meshes[0].dicing.base_level

    scene.camera.location = (0.0, 0.0, 300.0)
    far = level()
    scene.camera.location = (0.0, 0.0, 2000.0)
    assert level() == 1 < far < 6
    scene.cycles.dicing_camera = add_object(scene, "Near", bpy.data.cameras.new("Near"), location=(0.0, 0.0, 4.0))
    assert level() == 6
    scene.cycles.dicing_camera = None
    scene.cycles.dicing_rate = 0.1
    assert level() > 1
    cage.scale = (1e4, 1.0, 1.0)
    assert level() == 6


def test_objects_that_others_multiply_may_be_seen_anywhere(scene, cage):
    scene.camera.location = (0.0, 0.0, 2000.0)
    show_collection(scene, collect(scene, cage))
    assert export(scene).meshes[0].dicing.base_level == 5


def test_dense_meshes_are_hardly_divided_before(scene):
    side = np.linspace(-1.0, 1.0, 41)
    points = [(x, y, 0.0) for y in side for x in side]
    faces = [(k, k + 1, k + 42, k + 41) for j in range(40) for k in range(41 * j, 41 * j + 40)]
    dense = add_mesh(scene, "Dense", points, faces)
    scene.camera.location = (0.0, 0.0, 100.0)
    modifier = divide(dense, 2)
    assert export(scene).meshes[0].dicing.base_level == 1
    modifier.subdivision_type = "SIMPLE"  # whose vertices stay where they are
    dense.update_tag()
    exported = export(scene).meshes[0]
    assert exported.dicing.base_level == 0 and exported.triangle_count == 40 * 40 * 2


def test_divisions_before_are_limited_as_all_are(scene, cage):
    scene.cycles.max_subdivisions = 2
    assert export(scene).meshes[0].dicing.base_level == 2
    scene.render.use_simplify, scene.render.simplify_subdivision = True, 1
    cage.update_tag()
    assert export(scene).meshes[0].dicing.base_level == 1


def test_after_other_modifiers_renders_alone_set_the_level(scene, cage, exported_by_render):
    """In a viewport this would tag the object, which would then be exported again."""
    cage.modifiers.new("Bevel", "BEVEL")
    cage.modifiers.move(1, 0)
    cage.modifiers[1].levels = 1
    assert export(scene).meshes[0].dicing.base_level == 1
    assert exported_by_render().meshes[0].dicing.base_level > 1


def test_physics_are_not_applied_anew(scene, cage, exported_by_render):
    cage.modifiers.new("Collision", "COLLISION")
    cage.modifiers.move(1, 0)
    cage.modifiers[1].render_levels = 2
    assert exported_by_render().meshes[0].dicing.base_level == 2


@pytest.mark.skipif(bpy.app.version < (5, 0, 0), reason="Cycles' own property before")
def test_lengths_are_in_pixels_or_meters(scene, cage):
    modifier = cage.modifiers[0]
    modifier.adaptive_pixel_size = 2.0
    cage.update_tag()
    assert export(scene).meshes[0].dicing == Dicing(2.0, True, True, 6)
    modifier.adaptive_space, modifier.adaptive_object_edge_length = "OBJECT", 0.25
    cage.update_tag()
    assert export(scene).meshes[0].dicing == Dicing(0.25, False, True, 3)


def test_shapes_of_motion_are_divided_alike(scene, cage, exported_by_render):
    cage.shape_key_add(name="Basis")
    key = cage.shape_key_add(name="Wide")
    for point in key.data:
        point.co *= 2.0
    for frame in (0, 2):
        key.value = frame / 2
        key.keyframe_insert("value", frame=frame)
    scene.render.use_motion_blur = True
    scene.frame_set(1)
    exported = exported_by_render()
    (mesh,), (deformation,) = exported.meshes, exported.shutter.meshes
    assert mesh.dicing.base_level == 6 and deformation.positions.shape[1:] == mesh.positions.shape
    wider = deformation.positions[-1]
    scale = (wider * mesh.positions).sum() / (mesh.positions**2).sum()
    assert scale > 1.01
    np.testing.assert_allclose(wider, scale * mesh.positions, atol=1e-5)


def test_the_dicing_camera_decides(scene, cage):
    view = export(scene).dicing_view
    assert (view.rate, view.offscreen_scale, view.max_subdivisions, view.camera) == (1.0, 4.0, 12, None)
    cycles = scene.cycles
    cycles.dicing_camera = add_object(scene, "Far", bpy.data.cameras.new("Far"), location=(0.0, 0.0, 77.0))
    cycles.dicing_rate, cycles.offscreen_dicing_scale, cycles.max_subdivisions = 2.0, 3.0, 5
    scene.update_tag()
    view = export(scene).dicing_view
    assert (view.rate, view.offscreen_scale, view.max_subdivisions) == (2.0, 3.0, 5)
    assert view.camera.matrix[2, 3] == 77.0 and view.camera.width == export(scene).camera.width


def test_frames_that_follow_each_other_are_divided_as_if_alone(scene, cage):
    """With Persistent Data, in which the depsgraph reports nothing but the camera."""
    add_mesh(scene, "Other")
    exporter, levels, others = FrameExporter(), [], []
    for distance in (2000.0, 10.0, 10.0, 2000.0):
        scene.camera.location = (0.0, 0.0, distance)
        bpy.context.view_layer.update()
        exported = exporter.export(depsgraph(), lambda: False, lambda text: None, Eye())
        shown = {exported.meshes[instance.mesh].name: exported.meshes[instance.mesh] for instance in exported.instances}
        levels.append((shown["Cage"].dicing.base_level, shown["Cage"].triangle_count))
        others.append(shown["Other"])
        np.testing.assert_array_equal(shown["Cage"].positions, export(scene).meshes[0].positions)
    assert levels == [(1, 48), (6, 6 * 4**6 * 2), (6, 6 * 4**6 * 2), (1, 48)]
    assert all(other is others[0] for other in others)


def test_viewports_divide_anew_what_is_edited_only(scene, cage):
    """As in Cycles: not as the view turns, nor as other objects change."""
    other = add_mesh(scene, "Other")
    sync, turned = SceneSync(), dataclasses.replace(CAMERA, matrix=placed(0.0, 0.0, 9.0))
    first = sync.update(depsgraph(), CAMERA).dicing_view
    assert first.camera is CAMERA and first.rate == scene.cycles.preview_dicing_rate
    with following(lambda graph: sync.update(graph, turned)):
        other.location.x += 1.0
        bpy.context.view_layer.update()
        assert sync.scene.camera is turned and sync.scene.dicing_view is first
        cage.data.vertices[0].co.x -= 1.0
        cage.data.update()
        cage.data.update_tag()
        bpy.context.view_layer.update()
        assert sync.scene.dicing_view.camera is turned

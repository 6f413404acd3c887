# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves, hair of particle systems and point clouds as triangles."""

import bpy
import numpy as np
import pytest
from blender_scenes import CAMERA, add_mesh, add_object, depsgraph, export, following
from node_trees import add_node, geometry_nodes, multiply_cubes, new_material, surface
from support.moving import FRAME, animate, blur, taken_scene

from rppm_addon.blender.export.common.hashing import hashed, hashed_up_to
from rppm_addon.blender.export.geometry.strands import particle_hair, round_meshes, spheres, tubes
from rppm_addon.blender.export.geometry.strands.attributes import CURVE_RANDOM, INTERCEPT, LENGTH, THICKNESS
from rppm_addon.blender.export.updates.sync import SceneSync
from rppm_addon.integrator.surfaces.surface_attributes import SPHERE_REACHES
from rppm_addon.scene import MeshShape
from rppm_addon.scene.errors import SceneError


def helices(count=5, keys=8):
    """(count, keys, 3) places and (count, keys) radii of strands that turn."""
    along = np.linspace(0.0, 1.0, keys)
    turn = 3.0 * along + np.arange(count)[:, None]
    places = np.stack([np.arange(count)[:, None] + 0.3 * np.cos(turn), 0.3 * np.sin(turn), 0.0 * turn + along], axis=-1)
    return places.astype(np.float32), np.broadcast_to(0.02 - 0.015 * along, (count, keys)).astype(np.float32)


def strands_of(places, radii):
    count, keys = radii.shape
    starts = keys * np.arange(count + 1, dtype=np.int32)
    return tubes.Strands(places.reshape(-1, 3), radii.reshape(-1), starts, np.zeros(count, np.int32))


def add_curves(scene, places, radii, name="Hair"):
    data = bpy.data.hair_curves.new(name)
    data.add_curves([places.shape[1]] * len(places))
    data.attributes["position"].data.foreach_set("vector", places.reshape(-1))
    if radii is not None:
        radius = data.attributes.get("radius") or data.attributes.new("radius", "FLOAT", "POINT")
        radius.data.foreach_set("value", radii.reshape(-1))
    return add_object(scene, name, data)


def add_hair(scene, children="NONE"):
    source = add_mesh(scene, "Skin")
    source.modifiers.new("Hair", "PARTICLE_SYSTEM")
    source.particle_systems[0].seed = 1
    settings = source.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length = "HAIR", 20, 0.5
    settings.display_step = settings.render_step = 2
    settings.child_type, settings.child_percent, settings.rendered_child_count = children, 3, 3
    return source


def asking(*outputs):
    """A material that asks for outputs of Hair Info."""
    material = new_material("Asking")
    add = add_node(material.node_tree, "ShaderNodeVectorMath", operation="MULTIPLY_ADD")
    info = add_node(material.node_tree, "ShaderNodeHairInfo")
    for output, socket in zip(outputs, add.inputs, strict=False):
        material.node_tree.links.new(info.outputs[output], socket)
    return surface("ShaderNodeEmission", material=material, Color=add.outputs[0])[0]


@pytest.mark.parametrize("sides", [3, 5, 7, 11])
def test_tubes_hide_as_much_as_round_strands_in_the_mean(sides, monkeypatch):
    monkeypatch.setattr(tubes.Rings, "sides", sides)
    radii = np.full((1, 2), 0.1, np.float32)
    strands = strands_of(np.float32([[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]]), radii)
    rings = tubes.rings_of(strands, 4)
    vertices, normals = tubes.tube_vertices(strands, rings)
    turns = np.linspace(0.0, 2.0 * np.pi, 3601)[:-1]
    across = vertices[:sides, :2] @ np.stack([np.cos(turns), np.sin(turns)])
    assert np.ptp(across, axis=0).mean() == pytest.approx(0.2, rel=1e-5)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-6)


def test_triangles_face_outward_and_even_ones_point_to_the_tip():
    strands = strands_of(*helices())
    rings = tubes.rings_of(strands, 8)
    vertices, normals = tubes.tube_vertices(strands, rings)
    triangles = tubes.tube_triangles(rings)
    assert len(triangles) == rings.triangle_count
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), normals[triangles].sum(axis=1))
    assert (outward > 0.0).all()
    ring = triangles // rings.sides
    assert (ring[:, 1] == ring[:, 2]).all()
    np.testing.assert_array_equal(ring[:, 0] - ring[:, 1], np.tile([1, -1], len(triangles) // 2))


def test_splines_go_through_their_points_and_turn_little():
    places, radii = helices()
    strands = strands_of(places, radii)
    rings = tubes.rings_of(strands, 16)
    vertices, _ = tubes.tube_vertices(strands, rings)
    middles = vertices.reshape(len(rings.key), rings.sides, 3).mean(axis=1)
    at_keys = np.flatnonzero((rings.part == 0.0) | (rings.part == 1.0))
    np.testing.assert_allclose(middles[at_keys].reshape(places.shape), places, atol=1e-5)
    steps = np.diff(middles[: rings.starts[1]], axis=0)
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    assert np.degrees(np.arccos((steps[1:] * steps[:-1]).sum(axis=1))).max() < 15.0
    assert (np.diff(tubes.rings_of(strands, 1).starts) == places.shape[1]).all()


def test_spheres_have_the_area_of_their_points():
    for level in range(4):
        places, radii = np.float32([[1, 2, 3], [0, 0, 0]]), np.float32([0.5, 2.0])
        vertices, normals = spheres.sphere_vertices(places, radii, level)
        triangles = spheres.sphere_triangles(2, level)
        a, b, c = (vertices[triangles[:, corner]].astype(float) for corner in range(3))
        face = np.cross(b - a, c - a)
        areas = 0.5 * np.linalg.norm(face, axis=1).reshape(2, -1).sum(axis=1)
        np.testing.assert_allclose(areas, 4.0 * np.pi * radii**2, rtol=1e-5)
        assert (np.einsum("ij,ij->i", face, normals[triangles].sum(axis=1)) > 0.0).all()
        reach = np.linalg.norm(vertices[0] - places[0]) / radii[0]
        assert reach == pytest.approx(SPHERE_REACHES[level], rel=1e-6)


def test_numbers_of_strands_are_those_of_cycles():
    np.testing.assert_array_equal(hashed_up_to(100), np.float32([hashed(number) for number in range(100)]))


def test_hair_curves_are_tubes_with_what_nodes_ask_for(scene):
    places, radii = helices()
    source = add_curves(scene, places, radii)
    source.data.materials.append(asking("Intercept", "Length", "Thickness"))
    exported = export(scene)
    (mesh,), (instance,) = exported.meshes, exported.instances
    assert mesh.shape is MeshShape.STRANDS and not exported.warnings
    assert exported.materials[instance.materials[0]].on_round_shapes
    lengths = np.linalg.norm(np.diff(places, axis=1), axis=-1).sum(axis=1)
    assert set(np.unique(mesh.attributes[LENGTH].values)) == set(np.float32(lengths))
    thickness, intercept = mesh.attributes[THICKNESS].values, mesh.attributes[INTERCEPT].values
    assert (thickness.min(), thickness.max()) == pytest.approx((0.01, 0.04), rel=1e-5)
    assert (intercept.min(), intercept.max()) == (0.0, 1.0)
    source.data.materials[0] = asking("Random")
    assert len(np.unique(export(scene).meshes[0].attributes[CURVE_RANDOM].values)) == 5


def asking_for(name):
    """A material that asks for an attribute."""
    material = new_material(name)
    attribute = add_node(material.node_tree, "ShaderNodeAttribute", attribute_name=name)
    return surface("ShaderNodeEmission", material=material, Strength=attribute.outputs["Fac"])[0]


@pytest.mark.parametrize("name", ["uv", "read", "vertices"])
def test_attributes_of_curves_may_have_any_name(scene, name):
    source = add_curves(scene, *helices())
    numbers = np.arange(5, dtype=np.float32)
    source.data.attributes.new(name, "FLOAT", "CURVE").data.foreach_set("value", numbers)
    source.data.materials.append(asking_for(name))
    (mesh,) = export(scene).meshes
    assert np.array_equal(np.unique(mesh.attributes[name].values), numbers)


@pytest.mark.parametrize("name", ["points", "vertices"])
def test_attributes_of_points_may_have_any_name(scene, name):
    source = add_mesh(scene, "Points", faces=[])
    numbers = np.arange(4, dtype=np.float32)
    source.data.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", numbers)
    _, paint = geometry_nodes(source, "GeometryNodeMeshToPoints", "GeometryNodeSetMaterial")
    paint.inputs["Material"].default_value = asking_for(name)
    (mesh,) = export(scene).meshes
    assert mesh.shape is MeshShape.POINTS
    assert np.array_equal(np.unique(mesh.attributes[name].values), numbers)


def test_hair_without_curves_and_clouds_without_points_show_nothing(scene):
    add_object(scene, "Hair", bpy.data.hair_curves.new("Hair"))
    add_object(scene, "Points", bpy.data.pointclouds.new("Points"))
    exported = export(scene)
    assert exported.instances == [] and exported.warnings == []


def test_strands_that_cannot_be_placed_are_left_out(scene):
    places, radii = helices()
    places[2, 3] = np.nan
    add_curves(scene, places, radii)
    exported = export(scene)
    (mesh,) = exported.meshes
    assert np.isfinite(mesh.positions).all() and mesh.positions[:, 0].max() > 3.5
    assert any('"Hair"' in text and "left out" in text for text in exported.warnings)


def test_too_many_triangles_are_refused_with_a_remedy(scene, monkeypatch):
    add_curves(scene, *helices())
    monkeypatch.setattr(round_meshes, "MOST_TRIANGLES", 100)
    with pytest.raises(SceneError, match='"Hair".*5 strands.*lower'):
        export(scene)


def test_the_view_layer_may_have_no_strands(scene):
    add_curves(scene, *helices())
    add_hair(scene)
    assert len(export(scene).instances) == 3
    scene.view_layers[0].use_strand = False
    assert [instance.object_name for instance in export(scene).instances] == ["Skin"]


def test_children_stand_in_for_their_parents(scene):
    for children, strands in (("NONE", 20), ("SIMPLE", 60)):
        source = add_hair(scene, children)
        exported = export(scene)
        mesh = next(mesh for mesh in exported.meshes if mesh.shape is MeshShape.STRANDS)
        # Straight hair: 5 keys, and as many sides as there may be.
        assert mesh.triangle_count == 2 * 11 * 4 * strands
        roots = mesh.positions.reshape(strands, -1, 3)[:, :11].mean(axis=1)
        assert np.abs(roots[:, 2]).max() < 1e-5 and np.abs(roots).max() <= 1.3
        assert mesh.positions[:, 2].max() > 0.2
        bpy.data.objects.remove(source)


def test_hair_is_there_without_its_emitter(scene):
    source = add_hair(scene)
    source.show_instancer_for_render = source.show_instancer_for_viewport = False
    (instance,) = export(scene).instances
    assert instance.object_name == "Skin"


def test_what_nodes_of_geometry_multiply_has_no_hair(scene):
    for source in (add_hair(scene), add_hair(scene)):
        multiply_cubes(source, [((5.0, 0.0, 0.0), 1.0)])
    exported = export(scene)
    shapes = [exported.meshes[instance.mesh].shape for instance in exported.instances]
    assert shapes.count(MeshShape.SURFACE) == 4 and shapes.count(MeshShape.STRANDS) == 2


@pytest.mark.parametrize(("scale", "shown"), [((0.0, 0.0, 0.0), 0), ((1.0, 1.0, 0.0), 2)])
def test_hair_may_be_scaled_to_nothing(scene, scale, shown):
    source = add_hair(scene)
    source.scale, source.rotation_euler, source.location = scale, (0.4, 0.3, 0.0), (1.0, 2.0, 3.0)
    exported = export(scene)
    assert len(exported.instances) == shown
    assert [("have no extent" in text) for text in exported.warnings] == [True] * (shown == 0)
    for instance in exported.instances:
        positions = exported.meshes[instance.mesh].positions @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
        assert np.abs(positions - np.array(source.location)).max() < 1.5


def test_hair_in_memory_is_what_blenders_function_says(scene, monkeypatch):
    source = add_hair(scene, "SIMPLE")
    source.particle_systems[0].settings.child_length = 0.6
    source.particle_systems[0].settings.child_length_threshold = 0.5
    source.location = (1.0, 2.0, 3.0)
    read = export(scene).meshes
    assert particle_hair._paths_in_memory is not None
    monkeypatch.setattr(particle_hair, "_paths_in_memory", lambda hair: None)
    for one, other in zip(read, export(scene).meshes, strict=True):
        np.testing.assert_allclose(one.positions, other.positions, atol=2e-5)


def test_slices_export_the_same(scene):
    add_curves(scene, *helices())
    add_hair(scene, "SIMPLE")
    whole, sliced = SceneSync(), SceneSync()
    whole.update(depsgraph(), CAMERA)
    while sliced.advance(depsgraph(), CAMERA, seconds=0.0) is not None:
        pass
    assert len(sliced.scene.instances) == len(whole.scene.instances) == 3
    for one, other in zip(whole.scene.meshes, sliced.scene.meshes, strict=True):
        np.testing.assert_array_equal(one.positions, other.positions)
        np.testing.assert_array_equal(one.triangle_corners, other.triangle_corners)


@pytest.fixture
def synced(scene):
    """A SceneSync that is told of all updates."""
    sync = SceneSync()
    with following(lambda graph: sync.update(graph, CAMERA)):
        yield sync


def test_a_viewport_follows_curves_and_their_settings(scene, synced):
    source = add_curves(scene, *helices())
    bpy.context.view_layer.update()
    before = synced.scene.meshes[0]
    scene.cycles_curves.subdivisions = 0
    scene.update_tag()
    bpy.context.view_layer.update()
    assert synced.scene.meshes[0].triangle_count < before.triangle_count
    source.data.points[0].position = (9.0, 0.0, 0.0)
    source.data.update_tag()
    bpy.context.view_layer.update()
    assert synced.scene.meshes[0].positions[:, 0].max() > 8.5
    source.location.y = 2.0
    bpy.context.view_layer.update()
    assert synced.scene.instances[0].matrix[1, 3] == 2.0


def test_a_viewport_follows_hair(scene, synced):
    source = add_hair(scene)
    bpy.context.view_layer.update()

    def tubes_of(scene):
        return next(mesh for mesh in scene.meshes if mesh.shape is MeshShape.STRANDS)

    before = tubes_of(synced.scene)
    source.particle_systems[0].settings.root_radius *= 2.0
    bpy.context.view_layer.update()
    wide = tubes_of(synced.scene)
    assert np.ptp(wide.positions[:, 0]) != np.ptp(before.positions[:, 0])
    source.particle_systems[0].settings.count = 30
    bpy.context.view_layer.update()
    assert tubes_of(synced.scene).triangle_count == 1.5 * before.triangle_count


def test_strands_that_bend_are_blurred(scene):
    mesh = add_hair(scene)
    modifier = mesh.modifiers.new("Stretch", "SIMPLE_DEFORM")
    modifier.deform_method = "STRETCH"
    mesh.modifiers.move(1, 0)
    for frame, factor in ((FRAME - 1, -0.5), (FRAME + 1, 0.5)):
        modifier.factor = factor
        modifier.keyframe_insert("factor", frame=frame)
    scene.frame_set(FRAME)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    exported = taken_scene()
    place = next(number for number, made in enumerate(exported.meshes) if made.shape is MeshShape.STRANDS)
    (deformation,) = [found for found in exported.shutter.meshes if found.mesh == place]
    first, _, last = deformation.positions
    assert np.abs(last - first).max() > 0.01
    lengths = np.linalg.norm(deformation.corner_normals, axis=-1)
    np.testing.assert_allclose(lengths, 1.0, atol=1e-5)


def test_curves_and_hair_of_objects_that_move_are_blurred(scene):
    for source in (add_curves(scene, *helices()), add_hair(scene)):
        animate(source, "location", (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    blur()
    exported = taken_scene()
    names = {exported.instances[movement.member].object_name for movement in exported.shutter.instances}
    assert names == {"Hair", "Skin"} and len(exported.shutter.instances) == 3
    for movement in exported.shutter.instances:
        np.testing.assert_allclose(movement.matrices[:, 0, 3], [-0.5, 0.0, 0.5], atol=1e-6)

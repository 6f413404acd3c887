# SPDX-License-Identifier: GPL-3.0-or-later
"""Placements, visibility and material slots."""

import bpy
import numpy as np
from blender_scenes import add_mesh, add_object, export, new_material, shaders
from mathutils import Matrix

from rppm_addon.scene import RayVisibility


def test_nested_collection_instances_have_blenders_matrices(scene):
    quad = add_mesh(scene, "Quad", location=(1.0, 0.0, 0.0))
    inner = bpy.data.collections.new("Inner")
    inner.objects.link(quad)
    scene.collection.objects.unlink(quad)
    outer = bpy.data.collections.new("Outer")
    for index in range(3):
        empty = bpy.data.objects.new(f"Inner{index}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
        empty.location = (0.0, index, 0.0)
        empty.rotation_euler = (0.1 * index, 0.2, 0.3)
        outer.objects.link(empty)
    for index in range(4):
        empty = add_object(scene, f"Outer{index}", None, scale=(1.0 + index, 2.0, 1.0))
        empty.instance_type, empty.instance_collection = "COLLECTION", outer
    exported = export(scene)
    assert len(exported.meshes) == 1 and len(exported.instances) == 12 and exported.triangle_count == 24
    expected = [
        outer_empty.matrix_world @ inner_empty.matrix_world @ quad.matrix_world
        for outer_empty in scene.objects
        if outer_empty.name.startswith("Outer")
        for inner_empty in outer.objects
    ]
    found = np.array([instance.matrix for instance in exported.instances])
    for matrix in expected:
        assert np.abs(found - np.array(matrix)).max(axis=(1, 2)).min() < 1e-5


def test_geometry_nodes_instances_and_materials(scene):
    host = add_mesh(scene, "Host")
    quad = add_mesh(scene, "Quad")
    quad.hide_render = quad.hide_viewport = True
    material = new_material("Scattered")
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    line = tree.nodes.new("GeometryNodeMeshLine")
    line.inputs["Count"].default_value = 7
    cube = tree.nodes.new("GeometryNodeMeshCube")
    paint = tree.nodes.new("GeometryNodeSetMaterial")
    paint.inputs["Material"].default_value = material
    place = tree.nodes.new("GeometryNodeInstanceOnPoints")
    output = tree.nodes.new("NodeGroupOutput")
    tree.links.new(cube.outputs["Mesh"], paint.inputs["Geometry"])
    tree.links.new(line.outputs["Mesh"], place.inputs["Points"])
    tree.links.new(paint.outputs["Geometry"], place.inputs["Instance"])
    tree.links.new(place.outputs["Instances"], output.inputs[0])
    host.modifiers.new("Scatter", "NODES").node_group = tree
    exported = export(scene)
    assert len(exported.instances) == 7 and len(exported.meshes) == 1
    assert exported.meshes[0].triangle_count == 12
    (slot,) = set(exported.meshes[0].triangle_slots)
    assert {exported.materials[instance.materials[slot]].name for instance in exported.instances} == {"Scattered"}
    heights = sorted(instance.matrix[2, 3] for instance in exported.instances)
    np.testing.assert_allclose(heights, np.arange(7), atol=1e-6)


def test_hidden_things_stay_out(scene):
    add_mesh(scene, "Seen")
    add_mesh(scene, "Hidden").hide_viewport = True
    excluded = bpy.data.collections.new("Excluded")
    scene.collection.children.link(excluded)
    out = add_mesh(scene, "Out")
    excluded.objects.link(out)
    scene.collection.objects.unlink(out)
    scene.view_layers[0].layer_collection.children["Excluded"].exclude = True
    unseen = add_mesh(scene, "Unseen")
    for name in ("camera", "diffuse", "glossy", "transmission", "shadow"):
        setattr(unseen, f"visible_{name}", False)
    partly = add_mesh(scene, "Partly")
    partly.visible_shadow = False
    exported = export(scene)
    assert sorted(instance.object_name for instance in exported.instances) == ["Partly", "Seen"]
    partly, seen = sorted(exported.instances, key=lambda instance: instance.object_name)
    assert partly.visibility == RayVisibility.ALL ^ RayVisibility.SHADOW and seen.visibility == RayVisibility.ALL


def test_object_slots_win_over_those_of_the_mesh(scene):
    on_mesh, on_object, second = (new_material(name) for name in ("OnMesh", "OnObject", "Second"))
    first = add_mesh(scene, "First")
    first.data.materials.append(on_mesh)
    first.data.materials.append(second)
    other = add_object(scene, "Other", first.data)
    other.material_slots[0].link = "OBJECT"
    other.material_slots[0].material = on_object
    exported = export(scene)
    names = {
        instance.object_name: [exported.materials[index].name for index in instance.materials]
        for instance in exported.instances
    }
    assert names == {"First": ["OnMesh", "Second"], "Other": ["OnObject", "Second"]}
    assert len(exported.meshes) == 1 and len(exported.materials) == 3


def test_no_material_is_the_principled_surface_of_a_new_one(scene):
    add_mesh(scene, "None")
    empty_slot = add_mesh(scene, "EmptySlot")
    empty_slot.data.materials.append(None)
    exported = export(scene)
    (material,) = exported.materials
    ((shader, weight),) = shaders(material.graph)
    assert shader.kind == "bsdf_principled" and shader.options == {"distribution": "MULTI_GGX"}
    assert not shader.inputs and weight == 1.0
    assert [instance.materials for instance in exported.instances] == [[0], [0]]


def test_flat_placements_become_invertible_and_points_are_left_out(scene):
    add_mesh(scene, "Flat", scale=(2.0, 3.0, 0.0))
    add_mesh(scene, "Line", scale=(1.0, 0.0, 0.0))
    add_mesh(scene, "Point", scale=(0.0, 0.0, 0.0))
    broken = add_mesh(scene, "Broken")
    broken.matrix_world = Matrix.Identity(4)
    broken.location.x = float("nan")
    exported = export(scene)
    (instance,) = exported.instances
    assert instance.object_name == "Flat"
    np.testing.assert_allclose(instance.matrix @ (1, 1, 0, 1), (2, 3, 0, 1), atol=1e-6)
    assert np.isfinite(np.linalg.inv(instance.matrix)).all()
    for name in ("Line", "Point", "Broken"):
        assert any(f'"{name}"' in warning and "left out" in warning for warning in exported.warnings), name


def test_tiny_and_huge_scales_are_no_singular_placements(scene):
    for scale in (1e-7, 1e-3, 1e5):
        add_mesh(scene, f"Scale {scale}", scale=(scale, scale, scale))
    exported = export(scene)
    scales = sorted(instance.matrix[0, 0] for instance in exported.instances)
    np.testing.assert_allclose(scales, [1e-7, 1e-3, 1e5], rtol=1e-5)

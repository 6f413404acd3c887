# SPDX-License-Identifier: GPL-3.0-or-later
"""Placements, visibility and material slots."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, add_object, collect, export, show_collection
from mathutils import Matrix
from node_trees import add_node, new_material, node_group, shaders, surface

from rppm_addon.scene import RayVisibility


def test_nested_collection_instances_have_blenders_matrices(scene):
    quad = add_mesh(scene, "Quad", location=(1.0, 0.0, 0.0))
    inner = collect(scene, quad)
    empties = [
        show_collection(scene, inner, location=(0.0, index, 0.0), rotation_euler=(0.1 * index, 0.2, 0.3))
        for index in range(3)
    ]
    outer = collect(scene, *empties)
    for index in range(4):
        show_collection(scene, outer, f"Outer{index}", scale=(1.0 + index, 2.0, 1.0))
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
    host, material = add_mesh(scene, "Host"), new_material("Scattered")
    tree, _, last = node_group(outputs=[("Geometry", "Geometry")], tree_type="GeometryNodeTree")
    cube = add_node(tree, "GeometryNodeMeshCube")
    paint = add_node(tree, "GeometryNodeSetMaterial", Material=material, Geometry=cube.outputs["Mesh"])
    line = add_node(tree, "GeometryNodeMeshLine", Count=7)
    place = add_node(
        tree, "GeometryNodeInstanceOnPoints", Points=line.outputs["Mesh"], Instance=paint.outputs["Geometry"]
    )
    tree.links.new(place.outputs["Instances"], last.inputs[0])
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
    scene.collection.children.link(collect(scene, add_mesh(scene, "Out"), name="Excluded"))
    scene.view_layers[0].layer_collection.children["Excluded"].exclude = True
    unseen, partly = add_mesh(scene, "Unseen"), add_mesh(scene, "Partly")
    for name in _RAYS:
        setattr(unseen, f"visible_{name}", False)
    partly.visible_shadow = False
    exported = export(scene)
    assert sorted(instance.object_name for instance in exported.instances) == ["Partly", "Seen"]
    partly, seen = sorted(exported.instances, key=lambda instance: instance.object_name)
    assert partly.visibility == RayVisibility.ALL ^ RayVisibility.SHADOW and seen.visibility == RayVisibility.ALL


@pytest.mark.parametrize("kind", ["mesh", "hair"])
def test_rays_that_see_what_multiplies(scene, kind):
    """An instance is seen by rays that see both its object and what shows the collection."""
    if kind == "mesh":
        member = add_mesh(scene, "Member")
    else:
        curves = bpy.data.hair_curves.new("Member")
        curves.add_curves([2])
        curves.points[1].position = (0.0, 0.0, 1.0)
        member = add_object(scene, "Member", curves)
    collection = collect(scene, member)
    member.visible_glossy = False
    for hidden in ((), ("camera", "shadow"), _RAYS, ("diffuse",)):
        empty = show_collection(scene, collection)
        for rays in hidden:
            setattr(empty, f"visible_{rays}", False)
    seen = RayVisibility.ALL ^ RayVisibility.GLOSSY
    found = [instance.visibility for instance in export(scene).instances]
    expected = [seen, seen & ~(RayVisibility.CAMERA | RayVisibility.SHADOW), seen & ~RayVisibility.DIFFUSE]
    assert sorted(found, key=int) == sorted(expected, key=int)


@pytest.mark.parametrize(("own", "shown_by", "is_one"), [(True, False, False), (False, True, True)])
def test_holdouts_are_those_that_multiply(scene, own, shown_by, is_one):
    """As in Cycles, which asks the object itself only where it stands for itself."""
    member, empty = _shown_in_a_collection(scene)
    member.is_holdout, empty.is_holdout = own, shown_by
    (instance,) = export(scene).instances
    assert instance.holdout == is_one


@pytest.mark.parametrize("which", [0, 1])
def test_shadow_catchers_are_either(scene, which):
    _shown_in_a_collection(scene)[which].is_shadow_catcher = True
    (instance,) = export(scene).instances
    assert instance.shadow_catcher


@pytest.mark.parametrize(("own", "group"), [("", "Key"), ("Rim", "Rim")])
def test_light_groups_of_what_multiplies(scene, own, group):
    """Where an object has none itself; what multiplies a light hides nothing of it."""
    for name in ("Key", "Rim"):
        scene.view_layers[0].lightgroups.add(name=name)
    member, empty = _shown_in_a_collection(scene)
    lamp = add_light(scene, "POINT")
    scene.collection.objects.unlink(lamp)
    empty.instance_collection.objects.link(lamp)
    empty.lightgroup, member.lightgroup, lamp.lightgroup = "Key", own, own
    exported = export(scene)
    assert [instance.light_group for instance in exported.instances] == [group]
    assert [light.light_group for light in exported.lights] == [group]
    for rays in _RAYS:
        setattr(empty, f"visible_{rays}", False)
    exported = export(scene)
    assert (len(exported.instances), len(exported.lights)) == (0, 1)


def _shown_in_a_collection(scene):
    """A mesh object, and the empty that shows it."""
    member = add_mesh(scene, "Member")
    return member, show_collection(scene, collect(scene, member))


_RAYS = ("camera", "diffuse", "glossy", "transmission", "shadow")


@pytest.mark.parametrize(("kind", "output"), [("TexCoord", "Generated"), ("TexCoord", "UV"), ("UVMap", "UV")])
def test_coordinates_from_the_instancer(scene, kind, output):
    """Each instance has one value: UV of the face's middle, and Generated, of which Blender has none for faces, less a
    half as in Cycles. What stands for itself has zero."""
    material = new_material()
    node = add_node(material.node_tree, f"ShaderNode{kind}", from_instancer=True)
    surface("ShaderNodeEmission", material=material, Color=node.outputs[output])
    points = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (6, 0, 0), (6, 2, 0)]
    faces = add_mesh(scene, "Faces", points, [(0, 1, 2, 3), (1, 4, 5, 2)])
    uv = faces.data.uv_layers.new(name="UVMap")
    uv.data.foreach_set("uv", [0.1, 0.2, 0.3, 0.2, 0.3, 0.8, 0.1, 0.8, 0.5, 0.0, 0.9, 0.0, 0.9, 0.4, 0.5, 0.4])
    child, _ = add_mesh(scene, "Child", material=material), add_mesh(scene, "Alone", material=material)
    child.parent, faces.instance_type = faces, "FACES"
    exported = export(scene)
    assert exported.warnings == []
    found = {round(i.matrix[0, 3]): list(i.attributes.values()) for i in exported.instances if i.attributes}
    if output == "UV":
        expected = {1: (0.2, 0.5, 0.0), 4: (0.7, 0.2, 0.0), 0: (0.0, 0.0, 0.0)}
    else:
        expected = {1: (-0.5, -0.5), 4: (-0.5, -0.5), 0: (0.0, 0.0)}
    assert found.keys() == expected.keys()
    for place, values in expected.items():
        (value,) = found[place]
        np.testing.assert_allclose(value[: len(values)], values, atol=1e-6)


def test_object_slots_win_over_those_of_the_mesh(scene):
    on_mesh, on_object, second = (new_material(name) for name in ("OnMesh", "OnObject", "Second"))
    first = add_mesh(scene, "First", material=on_mesh)
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

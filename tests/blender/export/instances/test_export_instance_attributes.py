# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes that geometry nodes give instances: in these scenes, where the instance is."""

import bpy
import numpy as np
import pytest
from blender_scenes import CAMERA, add_light, add_mesh, collect, export, following, show_collection
from node_trees import add_node, link, new_material, node_group, surface

from rppm_addon.blender.export import SceneSync

pytestmark = pytest.mark.skipif(not hasattr(bpy.types.Object, "evaluated_geometry"), reason="Blender tells since 4.5")

NAME = "place"
ASKED = f"INSTANCER:{NAME}"


@pytest.fixture
def nodes(scene):
    """A tree of geometry nodes on a host."""
    tree, _, _ = node_group(outputs=[("Geometry", "Geometry")], tree_type="GeometryNodeTree")
    add_mesh(scene, "Host").modifiers.new("Scatter", "NODES").node_group = tree
    return tree


def asking_cube(nodes, side=0.1):
    """Its material reads the attribute."""
    material = new_material("Asking")
    asked = add_node(material.node_tree, "ShaderNodeAttribute", attribute_type="INSTANCER", attribute_name=NAME)
    surface("ShaderNodeEmission", material=material, Color=asked.outputs["Color"])
    cube = add_node(nodes, "GeometryNodeMeshCube", Size=(side, side, side))
    painted = add_node(nodes, "GeometryNodeSetMaterial", Material=material, Geometry=cube.outputs["Mesh"])
    return painted.outputs["Geometry"]


def line(nodes, count, offset):
    return add_node(nodes, "GeometryNodeMeshLine", Count=count, Offset=offset).outputs["Mesh"]


def with_numbers(nodes, points):
    """Points with identifiers of their own, as Distribute Points on Faces gives them."""
    odd = nodes.nodes.new("FunctionNodeIntegerMath")
    odd.operation, odd.inputs[1].default_value = "MULTIPLY", -1009
    link(nodes, add_node(nodes, "GeometryNodeInputIndex").outputs[0], odd.inputs[0])
    made = add_node(nodes, "GeometryNodeSetID", ID=odd.outputs[0], Geometry=points)
    return made.outputs["Geometry"]


def multiplied(nodes, points, geometry, name=NAME, shift=0.0):
    """Instances on points; the attribute holds where they are, and ``shift`` beside it."""
    placed = add_node(nodes, "GeometryNodeInstanceOnPoints", Points=points, Instance=geometry)
    stored = add_node(
        nodes,
        "GeometryNodeStoreNamedAttribute",
        data_type="FLOAT_VECTOR",
        domain="INSTANCE",
        Name=name,
        Geometry=placed.outputs["Instances"],
    )
    moved = nodes.nodes.new("ShaderNodeVectorMath")
    moved.inputs[1].default_value = (shift, 0.0, 0.0)
    link(nodes, add_node(nodes, "GeometryNodeInputPosition").outputs[0], moved.inputs[0])
    value = next(socket for socket in stored.inputs if socket.name == "Value" and socket.enabled)
    link(nodes, moved.outputs[0], value)
    return stored.outputs["Geometry"]


def joined(nodes, *parts):
    made = add_node(nodes, "GeometryNodeJoinGeometry")
    for part in parts:
        link(nodes, part, made.inputs[0])
    return made.outputs[0]


def show(nodes, geometry):
    link(nodes, geometry, nodes.nodes["Group Output"].inputs[0])


def instances_of(scene, nodes, geometry):
    """(n, 3) places and (n, 4) values of what is exported."""
    show(nodes, geometry)
    exported = export(scene)
    assert exported.warnings == []
    return _placed(exported)


def _placed(exported):
    places = np.array([instance.matrix[:3, 3] for instance in exported.instances])
    return places, np.array([instance.attributes[ASKED] for instance in exported.instances])


@pytest.mark.parametrize("numbered", [False, True])
def test_each_instance_has_its_own_value(scene, nodes, numbered):
    points = line(nodes, 7, (0.3, 0.1, 0.2))
    points = with_numbers(nodes, points) if numbered else points
    places, values = instances_of(scene, nodes, multiplied(nodes, points, asking_cube(nodes)))
    assert len(places) == 7
    np.testing.assert_allclose(values[:, :3], places, atol=1e-6)
    np.testing.assert_array_equal(values[:, 3], 1.0)


def test_what_is_joined_of_the_same_points(scene, nodes):
    """Two instances have the number of a point, so Blender makes one up."""
    points = with_numbers(nodes, line(nodes, 9, (0.3, 0.1, 0.2)))
    first = multiplied(nodes, points, asking_cube(nodes, 0.1))
    second = multiplied(nodes, points, asking_cube(nodes, 0.2), shift=100.0)
    places, values = instances_of(scene, nodes, joined(nodes, first, second))
    assert len(places) == 18
    shifts = values[:, 0] - places[:, 0]
    np.testing.assert_allclose(sorted(shifts), [0.0] * 9 + [100.0] * 9, atol=1e-5)
    np.testing.assert_allclose(values[:, 1:3], places[:, 1:], atol=1e-6)


@pytest.mark.parametrize("named", ["inner", "outer", "both"])
def test_the_innermost_level_that_has_it_counts(scene, nodes, named):
    """Instances of instances, beside a mesh of their own."""
    inner, outer = (NAME if named in {level, "both"} else "other" for level in ("inner", "outer"))
    pair = multiplied(nodes, line(nodes, 2, (0.0, 0.0, 1.0)), asking_cube(nodes), inner)
    whole = joined(nodes, asking_cube(nodes), pair) if named == "outer" else pair
    places, values = instances_of(scene, nodes, multiplied(nodes, line(nodes, 3, (2.0, 0.0, 0.0)), whole, outer))
    if named == "outer":
        assert len(places) == 9
        np.testing.assert_allclose(values[:, :3], places * (1.0, 1.0, 0.0), atol=1e-6)
    else:
        assert len(places) == 6
        np.testing.assert_allclose(values[:, :3], places * (0.0, 0.0, 1.0), atol=1e-6)


def test_in_a_collection_that_an_empty_shows(scene, nodes):
    """As linked libraries have it."""
    collection = collect(scene, add_light(scene, "POINT"), bpy.data.objects["Host"])
    show_collection(scene, collection, location=(0.0, 50.0, 0.0))
    points = line(nodes, 5, (0.3, 0.1, 0.2))
    places, values = instances_of(scene, nodes, multiplied(nodes, points, asking_cube(nodes)))
    assert len(places) == 5
    np.testing.assert_allclose(values[:, :3], places - (0.0, 50.0, 0.0), atol=1e-5)


def test_a_viewport_follows_edits(scene, nodes):
    show(nodes, multiplied(nodes, line(nodes, 3, (1.0, 0.0, 0.0)), asking_cube(nodes)))
    sync = SceneSync()
    shifted = next(node for node in nodes.nodes if node.bl_idname == "ShaderNodeVectorMath")
    with following(lambda graph: sync.update(graph, CAMERA)):
        for shift in (0.0, 7.0):
            shifted.inputs[1].default_value[0] = shift
            bpy.context.view_layer.update()
            places, values = _placed(sync.scene)
            np.testing.assert_allclose(values[:, 0], places[:, 0] + shift, atol=1e-6)

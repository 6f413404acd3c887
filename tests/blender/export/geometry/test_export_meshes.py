# SPDX-License-Identifier: GPL-3.0-or-later
"""Exported arrays against Blender read one element at a time."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, add_object, collect, depsgraph, export, show_collection
from node_trees import add_node, geometry_nodes, link, new_material

from rppm_addon.blender.export.geometry.meshes import element_arrays


def naive_arrays(mesh):
    """Return the arrays that the export should give, by Blender's plain documented properties."""
    mesh.calc_loop_triangles()
    uv = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    return {
        "positions": np.array([tuple(vertex.co) for vertex in mesh.vertices], np.float32),
        "corner_vertices": np.array([loop.vertex_index for loop in mesh.loops], np.int32),
        "corner_normals": naive_normals(mesh),
        "triangle_corners": np.array([tuple(triangle.loops) for triangle in mesh.loop_triangles], np.int32),
        "triangle_slots": np.array(
            [mesh.polygons[triangle.polygon_index].material_index for triangle in mesh.loop_triangles], np.int32
        ),
        "corner_uv": None if uv is None else np.array([tuple(item.vector) for item in uv.uv], np.float32),
    }


def naive_normals(mesh):
    """Flat faces have 0. Beside them smooth faces have the normals of vertices, but from Blender 5.2 on, or with sharp
    edges and custom normals, those of corners."""
    normals = np.array([tuple(normal.vector) for normal in mesh.corner_normals], np.float32)
    if mesh.has_custom_normals:
        return normals
    mixed = mesh.normals_domain == "CORNER" and not any(edge.use_edge_sharp for edge in mesh.edges)
    if mesh.normals_domain == "FACE":
        return np.zeros_like(normals)
    if mixed and bpy.app.version < (5, 2):
        for polygon in mesh.polygons:
            for corner, vertex in zip(polygon.loop_indices, polygon.vertices, strict=True):
                normals[corner] = mesh.vertices[vertex].normal if polygon.use_smooth else 0.0
    return normals


def assert_same(exported, mesh):
    for name, expected in naive_arrays(mesh).items():
        found = getattr(exported, name)
        if expected is None:
            assert found is None
        else:
            assert found.dtype == expected.dtype and found.shape == expected.shape, name
            np.testing.assert_allclose(found, expected, atol=1e-6, err_msg=name)


def evaluated(source):
    return source.evaluated_get(depsgraph()).data


def monkey():
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.object


def test_arrays_equal_the_naive_reading(scene):
    source = monkey()
    for polygon in source.data.polygons:
        polygon.material_index = polygon.index % 3
        polygon.use_smooth = polygon.index % 2 == 0
    for _ in range(3):
        source.data.materials.append(bpy.data.materials.new("M"))
    mesh = export(scene).meshes[0]
    assert mesh.triangle_count == 968 and set(mesh.triangle_slots) == {0, 1, 2}
    assert_same(mesh, evaluated(source))


def test_modifiers_are_applied(scene):
    source = add_mesh(scene)
    source.modifiers.new("Array", "ARRAY").count = 5
    source.modifiers.new("Subdivision", "SUBSURF").render_levels = 1
    exported = export(scene)
    assert exported.meshes[0].triangle_count > 5 * 2
    assert_same(exported.meshes[0], evaluated(source))


def test_custom_normals_reach_the_corners(scene):
    source = add_mesh(scene)
    tilted = [(0.6, 0.0, 0.8)] * 4
    source.data.normals_split_custom_set(tilted)
    mesh = export(scene).meshes[0]
    np.testing.assert_allclose(mesh.corner_normals, tilted, atol=1e-3)
    assert_same(mesh, evaluated(source))


def test_the_uv_map_for_rendering_is_the_one_exported(scene):
    source = add_mesh(scene)
    for index, name in enumerate(("First", "Second", "Third")):
        layer = source.data.uv_layers.new(name=name)
        for corner, item in enumerate(layer.uv):
            item.vector = (index, corner)
    source.data.uv_layers["Second"].active_render = True
    source.data.uv_layers.active = source.data.uv_layers["Third"]
    mesh = export(scene).meshes[0]
    np.testing.assert_array_equal(mesh.corner_uv, [(1, 0), (1, 1), (1, 2), (1, 3)])


def test_a_mesh_shared_by_objects_is_exported_once(scene):
    first = add_mesh(scene, "First")
    second = add_object(scene, "Second", first.data, location=(3.0, 0.0, 0.0))
    exported = export(scene)
    assert len(exported.meshes) == 1
    assert {instance.object_name for instance in exported.instances} == {"First", "Second"}
    second.modifiers.new("Array", "ARRAY").count = 3
    exported = export(scene)
    assert sorted(mesh.triangle_count for mesh in exported.meshes) == [2, 6]


def text_object(scene):
    data = bpy.data.curves.new("Text", "FONT")
    data.body = "ab"
    data.extrude = 0.1
    return add_object(scene, "Text", data)


def curve_object(scene):
    data = bpy.data.curves.new("Curve", "CURVE")
    data.dimensions = "3D"
    data.bevel_depth = 0.1
    spline = data.splines.new("POLY")
    spline.points.add(3)
    for index, point in enumerate(spline.points):
        point.co = (index, index * index * 0.2, 0.0, 1.0)
    return add_object(scene, "Curve", data)


def metaball_object(scene):
    data = bpy.data.metaballs.new("Metaball")
    data.elements.new()
    return add_object(scene, "Metaball", data)


def surface_object(scene):
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    return bpy.context.object


@pytest.mark.parametrize("make", [text_object, curve_object, metaball_object, surface_object])
def test_what_evaluates_to_a_mesh_is_exported_once(scene, make):
    source = make(scene)
    source.location = (1.0, 2.0, 3.0)
    source.data.materials.append(new_material("Own"))
    exported = export(scene)
    (instance,) = exported.instances
    np.testing.assert_allclose(instance.matrix[:3, 3], (1.0, 2.0, 3.0))
    assert exported.materials[instance.materials[0]].name == "Own"
    reference = source.evaluated_get(depsgraph())
    assert_same(exported.meshes[instance.mesh], reference.to_mesh())
    reference.to_mesh_clear()


@pytest.mark.parametrize("make", [text_object, curve_object, surface_object])
def test_converted_objects_are_multiplied_by_faces_and_collections(scene, make):
    source = make(scene)
    collection = collect(scene, source)
    empties = [show_collection(scene, collection, location=(0.0, 0.0, index)) for index in range(2)]
    exported = export(scene)
    assert len(exported.instances) == 2 and len(exported.meshes) == 1
    assert sorted(instance.matrix[2, 3] for instance in exported.instances) == [0.0, 1.0]

    scene.collection.objects.link(source)
    for empty in empties:
        bpy.data.objects.remove(empty)
    parent = add_mesh(scene, "Parent", *TWO_QUADS)
    parent.instance_type = "FACES"
    source.parent = parent
    exported = export(scene)
    of_source = [instance for instance in exported.instances if instance.object_name == source.name]
    # Blender shows the object on each face, and itself.
    assert sorted(instance.matrix[0, 3] for instance in of_source) == [-0.5, 0.0, 1.5]
    assert len({exported.meshes[instance.mesh].triangle_count for instance in of_source}) == 1


TWO_QUADS = (
    [(-1, -1, 0), (0, -1, 0), (0, 0, 0), (-1, 0, 0), (1, 1, 0), (2, 1, 0), (2, 2, 0), (1, 2, 0)],
    [(0, 1, 2, 3), (4, 5, 6, 7)],
)


def test_elements_that_do_not_lie_in_a_row_are_read_all_the_same(scene):
    """Objects, unlike elements of a mesh, are each in a place of their own."""
    for number in range(3):
        add_object(scene, "Object", None, location=(number, 2.0, 3.0))
    places = bpy.data.objects, "location", len(bpy.data.objects), 3, np.float32
    assert not element_arrays.view_is_right(*places)
    np.testing.assert_array_equal(element_arrays.elements(*places), [tuple(o.location) for o in bpy.data.objects])


@pytest.mark.parametrize("collection", ["loop_triangles", "loop_triangle_polygons", "corner_normals", "uv", "position"])
def test_all_that_meshes_are_made_of_lies_in_a_row(scene, collection):
    mesh = evaluated(monkey())
    mesh.calc_loop_triangles()
    corners, triangles = len(mesh.loops), len(mesh.loop_triangles)
    arguments = {
        "uv": lambda: (mesh.uv_layers[0].uv, "vector", corners, 2, np.float32),
        "position": lambda: (mesh.attributes["position"].data, "vector", len(mesh.vertices), 3, np.float32),
        "corner_normals": lambda: (mesh.corner_normals, "vector", corners, 3, np.float32),
        "loop_triangles": lambda: (mesh.loop_triangles, "loops", triangles, 3, np.int32),
        "loop_triangle_polygons": lambda: (mesh.loop_triangle_polygons, "value", triangles, 1, np.int32),
    }[collection]()
    assert element_arrays.view_is_right(*arguments)
    asked = [getattr(element, arguments[1]) for element in arguments[0]]
    np.testing.assert_array_equal(element_arrays.elements(*arguments), asked)


def test_one_triangle_and_no_triangle(scene):
    add_mesh(scene, "Triangle", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    add_mesh(scene, "Edge", [(0, 0, 0), (1, 0, 0)], [])
    add_mesh(scene, "Nothing", [], [])
    exported = export(scene)
    assert [instance.object_name for instance in exported.instances] == ["Triangle"]
    np.testing.assert_array_equal(exported.meshes[0].triangle_corners, [(0, 1, 2)])


def test_only_a_last_modifier_that_is_shown_divides_adaptively(scene):
    """As in Cycles, which else takes it for a plain one."""
    source = add_mesh(scene)
    modifier = source.modifiers.new("Subdivision", "SUBSURF")
    owner = modifier if hasattr(modifier, "use_adaptive_subdivision") else source.cycles
    owner.use_adaptive_subdivision = True

    def dicing():
        source.update_tag()
        return export(scene).meshes[0].dicing

    assert dicing() is not None
    modifier.show_viewport = False
    assert dicing() is None
    modifier.show_viewport = True
    source.modifiers.new("Triangulate", "TRIANGULATE")
    assert dicing() is None


def cut_away(source):
    """A modifier that leaves nothing of an object."""
    source.vertex_groups.new(name="None")
    source.modifiers.new("Mask", "MASK").vertex_group = "None"


def test_an_object_of_whose_faces_nothing_is_left_is_named(scene):
    first, second = add_mesh(scene, "First"), add_mesh(scene, "Second")
    cut_away(first)
    exported = export(scene)
    assert [instance.object_name for instance in exported.instances] == ["Second"]
    (warning,) = exported.warnings
    assert 'Object "First": its modifiers leave no faces' in warning
    cut_away(second)
    (warning,) = export(scene).warnings
    assert 'Objects "First", "Second": their modifiers leave no faces' in warning


def test_a_multiplied_object_of_whose_faces_nothing_is_left_is_named(scene):
    source = add_mesh(scene, "Source")
    cut_away(source)
    show_collection(scene, collect(scene, source))
    (warning,) = export(scene).warnings
    assert 'Object "Source": its modifiers leave no faces' in warning


def test_meshes_without_faces_are_as_they_are_meant(scene):
    """Edges alone, no vertex at all, and a mesh in place of which its nodes show others."""
    add_mesh(scene, "Edges", [(0, 0, 0), (1, 0, 0)], [])
    add_mesh(scene, "Empty", [], [])
    points = add_mesh(scene, "Points")
    (multiply,) = geometry_nodes(points, "GeometryNodeInstanceOnPoints")
    cube = add_node(multiply.id_data, "GeometryNodeMeshCube")
    link(multiply.id_data, cube.outputs[0], multiply.inputs["Instance"])
    exported = export(scene)
    assert exported.warnings == [] and len(exported.instances) == 4

# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's scene follows every edit: it equals one exported anew, and shares what did not change."""

import functools
import random

import bpy
import edits
import numpy as np
import pytest
from blender_scenes import add_object, show_collection
from edits import EDITS, do, fresh, same
from node_trees import add_node, with_nodes


@pytest.mark.parametrize("edit", [*EDITS, edits.displace, edits.subdivide_adaptively])
def test_each_edit_is_followed(synced, edit):
    before = synced.scene
    do(edit)
    assert same(synced.scene, fresh())
    changes = edit not in {edits.paint_unused, edits.next_frame, edits.parent}  # the parent stands at the origin
    assert (synced.scene is not before) == changes


@pytest.mark.parametrize("seed", range(4))
def test_edits_one_after_the_other(synced, seed):
    generator, has = random.Random(seed), bpy.data.objects.get
    for _ in range(30):
        edit = generator.choice([e for e in EDITS if e is not edits.instance_collection or not has("Empty")])
        if edit not in {edits.move_twin, edits.hide} or has("Twin"):
            do(edit)
            assert same(synced.scene, fresh()), edit.__name__


def test_what_stays_is_the_same_object(synced):
    before = synced.scene
    do(edits.move)
    after = synced.scene
    assert [a is b for a, b in zip(before.instances, after.instances, strict=True)].count(False) == 1
    assert after.meshes is before.meshes and after.materials is before.materials and after.lights is before.lights
    do(edits.paint)
    assert synced.scene.instances is after.instances and synced.scene.materials is not after.materials


def test_scenes_that_were_handed_out_stay_as_they_were(synced):
    before = synced.scene
    matrices = [instance.matrix.copy() for instance in before.instances]
    positions = [mesh.positions.copy() for mesh in before.meshes]
    do(edits.move, edits.edit_mesh, edits.ask_for_generated, edits.remove, edits.add)
    for instance, matrix in zip(before.instances, matrices, strict=True):
        np.testing.assert_array_equal(instance.matrix, matrix)
    for mesh, known in zip(before.meshes, positions, strict=True):
        np.testing.assert_array_equal(mesh.positions, known)
    assert not any(mesh.attributes for mesh in before.meshes)


def test_what_objects_lack_is_told_until_they_have_it(synced):
    tree = bpy.data.materials["Red"].node_tree
    attribute = add_node(tree, "ShaderNodeAttribute", attribute_name="Rust")
    tree.links.new(attribute.outputs["Color"], edits.principled("Red").inputs["Base Color"])
    bpy.context.view_layer.update()
    before = synced.scene
    assert any("Rust" in text for text in before.warnings)
    do(lambda: bpy.data.objects["Other"].select_set(True))  # lists all instances again, and changes nothing
    assert synced.scene is before
    do(edits.move)
    assert synced.scene.warnings == before.warnings


def test_an_edit_of_one_object_reads_no_other(synced, monkeypatch):
    """The cost of an edit does not grow with the scene: the depsgraph's instances are not listed again."""
    asked = []

    def shown(source: bpy.types.Object) -> bool:
        asked.append(source.name)
        return True

    monkeypatch.setattr(synced, "update", functools.partial(synced.update, shown=shown))
    for edit in (edits.move, edits.edit_mesh, edits.paint, edits.brighten, edits.move_light, edits.recolor_world):
        do(edit)
        assert same(synced.scene, fresh()), edit.__name__
    assert not asked
    do(lambda: add_object(bpy.context.scene, "New", bpy.data.meshes["Cube"]))
    assert {"Cube", "Twin", "Other", "New"} <= set(asked)


def test_a_mesh_that_bends_keeps_its_other_arrays(synced):
    do(bpy.data.meshes["Other"].shade_smooth)
    (before,) = (mesh for mesh in synced.scene.meshes if mesh.name == "Other")
    do(edits.edit_other_mesh)
    (after,) = (mesh for mesh in synced.scene.meshes if mesh.name == "Other")
    for name in ("corner_vertices", "triangle_corners", "triangle_slots"):
        assert getattr(after, name) is getattr(before, name)
    assert not np.array_equal(after.positions, before.positions)
    assert not np.array_equal(after.corner_normals, before.corner_normals)
    assert same(synced.scene, fresh())


def test_a_mesh_whose_vertices_are_another_keeps_nothing_wrong(synced):
    """More vertices, fewer, and as many in another order."""
    mesh = bpy.data.meshes["Other"]
    points, faces = [tuple(vertex.co) for vertex in mesh.vertices], [tuple(face.vertices) for face in mesh.polygons]
    for some in (faces[:4], faces, [face[::-1] for face in faces], faces[::-1]):
        mesh.clear_geometry()
        mesh.from_pydata(points, [], some)
        bpy.context.view_layer.update()
        assert same(synced.scene, fresh())


def test_many_objects_move_at_once_and_some_change_otherwise(synced, scene):
    root = add_object(scene, "Root", None)
    for number in range(50):
        data = bpy.data.meshes["Cube" if number % 3 else "Other"]
        add_object(scene, f"Crowd {number}", data, location=(number, 2.0, 0.0), parent=root)
    bpy.context.view_layer.update()
    chance = random.Random(3)
    changes = (
        lambda source: setattr(source, "color", (1.0, 0.5, 0.25, 1.0)),
        lambda source: setattr(source, "pass_index", 3),
        lambda source: setattr(source, "visible_shadow", False),
        lambda source: setattr(source, "name", source.name + "!"),
        lambda source: setattr(source, "scale", (1.0, 1.0, 0.0)),
        lambda source: setattr(source, "data", bpy.data.meshes["Cube"]),
        lambda source: source.__setitem__("heat", 0.5),
        lambda source: source.modifiers.new("More", "SUBSURF"),
        lambda source: setattr(source, "visible_camera", False),
    )
    for frame, change in enumerate(changes, 2):
        root.location.x += 0.5
        change(chance.choice(root.children))
        bpy.context.view_layer.update()
        assert same(synced.scene, fresh()), frame
        root.location.y += 0.5
        change(chance.choice(root.children))
        scene.frame_set(frame)
        assert same(synced.scene, fresh()), frame


def test_what_is_multiplied_keeps_to_what_multiplies_it(synced, scene):
    """Two empties bring the same objects, one of them with a material of its own."""
    collection = bpy.data.collections.new("Brought")
    for name in ("Cube", "Twin"):
        collection.objects.link(bpy.data.objects[name])
    slot = bpy.data.objects["Twin"].material_slots[0]
    slot.link, slot.material = "OBJECT", bpy.data.materials["Blue"]
    for number in range(2):
        show_collection(scene, collection, location=(0.0, 0.0, 3.0 + number))
    bpy.context.view_layer.update()
    assert same(synced.scene, fresh())
    brought = [instance for instance in synced.scene.instances if instance.matrix[2, 3] >= 3.0]
    names = sorted((i.object_name, i.matrix[2, 3], synced.scene.materials[i.materials[0]].name) for i in brought)
    assert names == [("Cube", 3.0, "Red"), ("Cube", 4.0, "Red"), ("Twin", 3.0, "Blue"), ("Twin", 4.0, "Blue")]
    assert len({instance.random for instance in brought}) == 4


@pytest.mark.parametrize("names", [("Cube",), ("Cube", "Other"), ("Other", "Cube")])
def test_edit_mode_is_followed(synced, names):
    """One object or several are in it, whose mesh another object has as well."""
    enter, leave = (lambda: edits.in_edit_mode(*names)), edits.in_object_mode
    first = (edits.pull, edits.move, edits.move_twin, edits.paint, edits.cut, edits.ask_for_generated, edits.pull)
    for step in (enter, *first, edits.subdivide, edits.assign, leave, edits.edit_mesh, enter, edits.pull, leave):
        do(step)
        assert same(synced.scene, fresh()), step
        assert len(synced.scene.instances) == 3 and synced.scene.warnings == []
    assert sum(mesh.triangle_count for mesh in synced.scene.meshes) > 3 * 12


def test_a_mesh_in_edit_mode_is_what_it_is_outside(scene):
    """With materials, UV, colors and the attributes that nodes ask for."""
    mesh = edits.add_box("Cube").data
    for name in ("Red", "Blue"):
        mesh.materials.append(bpy.data.materials.new(name))
        with_nodes(mesh.materials[-1])
    mesh.polygons[2].material_index, mesh.polygons[3].use_smooth = 1, True
    for number, place in enumerate(mesh.uv_layers.new(name="Map").uv):
        place.vector = (0.1 * number, 0.5)
    mesh.attributes.new("Rust", "FLOAT", "POINT").data[3].value = 2.0
    tree = mesh.materials[0].node_tree
    rust = add_node(tree, "ShaderNodeAttribute", attribute_name="Rust")
    tree.links.new(rust.outputs["Fac"], edits.principled("Red").inputs["Roughness"])
    bpy.context.view_layer.update()
    outside = fresh()
    do(lambda: edits.in_edit_mode("Cube"))
    inside = fresh()
    edits.in_object_mode()
    assert same(inside, outside) and inside.meshes[0].triangle_count == 12

# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's scene follows every edit: it equals one exported anew, and shares what did not change."""

import collections
import functools
import random
import time

import bmesh
import bpy
import numpy as np
import pytest

from rppm_addon.blender.engine import kept_exports
from rppm_addon.blender.export.geometry.meshes import meshes
from rppm_addon.blender.export.images import images
from rppm_addon.blender.export.instances import mesh_table
from rppm_addon.blender.export.updates.sync import SceneSync
from rppm_addon.scene import Camera, Instance, Scene
from rppm_addon.scene.storage.documents import field_names
from rppm_addon.scene.storage.sharing import equal

CAMERA = Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 8, 8)


@pytest.fixture
def synced(scene):
    """A SceneSync that is told of all updates, and the scene's objects."""
    sync = SceneSync()

    def follow(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        sync.update(depsgraph, CAMERA)

    cube = _add("Cube", _box("Cube"))
    _add("Twin", cube.data).location = (3.0, 0.0, 0.0)
    _add("Other", _box("Other", 0.5)).location = (0.0, 3.0, 0.0)
    for name in ("Red", "Blue"):
        material = bpy.data.materials.new(name)
        if bpy.app.version < (5, 0, 0):
            material.use_nodes = True
    cube.data.materials.append(bpy.data.materials["Red"])
    light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
    bpy.context.collection.objects.link(light)
    world = scene.world = bpy.data.worlds.new("World")
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    bpy.app.handlers.depsgraph_update_post.append(follow)
    bpy.app.handlers.frame_change_post.append(follow)
    bpy.context.view_layer.update()
    yield sync
    bpy.app.handlers.depsgraph_update_post.remove(follow)
    bpy.app.handlers.frame_change_post.remove(follow)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def _box(name: str, size: float = 1.0) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new(name)
    points = [(size * x, size * y, size * z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(points, [], faces)
    return mesh


def _add(name: str, data: bpy.types.ID) -> bpy.types.Object:
    added = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(added)
    return added


def move():
    bpy.data.objects["Cube"].location.x += 0.25


def move_twin():
    bpy.data.objects["Twin"].rotation_euler.z += 0.5


def edit_mesh():
    mesh = bpy.data.meshes["Cube"]
    mesh.vertices[0].co.x -= 0.3
    mesh.update()


def edit_other_mesh():
    mesh = bpy.data.meshes["Other"]
    mesh.vertices[3].co.z += 0.3
    mesh.update()


def paint():
    shader = bpy.data.materials["Red"].node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value[0] += 0.1


def paint_unused():
    bpy.data.materials["Blue"].node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value *= 0.9


def use_blue():
    bpy.data.objects["Other"].data.materials.append(bpy.data.materials["Blue"])


def swap_slot():
    bpy.data.objects["Cube"].material_slots[0].material = bpy.data.materials["Blue"]


def ask_for_generated():
    tree = bpy.data.materials["Red"].node_tree
    texture = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(texture.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])


def displace():
    material = bpy.data.materials["Red"]
    tree = material.node_tree
    height = tree.nodes.new("ShaderNodeDisplacement")
    tree.links.new(height.outputs[0], tree.nodes["Material Output"].inputs["Displacement"])
    material.displacement_method = "BOTH"


def subdivide_adaptively():
    modifier = bpy.data.objects["Cube"].modifiers.new("Subdivision", "SUBSURF")
    if hasattr(modifier, "use_adaptive_subdivision"):  # Blender 5
        modifier.use_adaptive_subdivision = True


def brighten():
    bpy.data.lights["Light"].energy += 50.0


def move_light():
    bpy.data.objects["Light"].location.z += 1.0


def recolor_world():
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value += 0.3


def hide():
    twin = bpy.data.objects["Twin"]
    twin.hide_viewport = not twin.hide_viewport


def hide_from_camera():
    bpy.data.objects["Other"].visible_camera ^= True


def subdivide():
    bpy.data.objects["Cube"].modifiers.new("Bevel", "BEVEL").segments = 2


def remove():
    twin = bpy.data.objects.get("Twin")
    if twin is not None:
        bpy.data.objects.remove(twin)


def add():
    _add("Added", _box("Added", 0.3))


def exchange_data():
    bpy.data.objects["Other"].data = bpy.data.meshes["Cube"]


def instance_collection():
    empty = _add("Empty", None)
    group = bpy.data.collections.new("Group")
    group.objects.link(bpy.data.objects["Other"])
    empty.instance_type, empty.instance_collection = "COLLECTION", group
    empty.location = (0.0, 0.0, 4.0)


def parent():
    bpy.data.objects["Other"].parent = bpy.data.objects["Cube"]


def other_settings():
    bpy.context.scene.rppm.alpha = 0.6
    bpy.context.scene.update_tag()


def next_frame():
    bpy.context.scene.frame_set(bpy.context.scene.frame_current + 1)


EDITS = (
    move, move_twin, edit_mesh, edit_other_mesh, paint, paint_unused, use_blue, swap_slot, ask_for_generated, brighten,
    move_light, recolor_world, hide, hide_from_camera, subdivide, remove, add, exchange_data, instance_collection,
    parent, other_settings, next_frame,
)  # fmt: skip


def fresh() -> Scene:
    return SceneSync().update(bpy.context.evaluated_depsgraph_get(), CAMERA)


def same(a: Scene, b: Scene) -> bool:
    """Whether two scenes say the same, however their meshes and materials are numbered."""

    def told(scene: Scene) -> list:
        instances = [
            (
                scene.meshes[instance.mesh],
                [scene.materials[material] for material in instance.materials],
                *(getattr(instance, name) for name in field_names(Instance) if name not in {"mesh", "materials"}),
            )
            for instance in scene.instances
        ]
        return [instances, scene.lights, scene.world, scene.settings, scene.exposure, sorted(scene.warnings)]

    return equal(told(a), told(b))


@pytest.mark.parametrize("edit", [*EDITS, displace, subdivide_adaptively])
def test_each_edit_is_followed(synced, edit):
    before = synced.scene
    edit()
    bpy.context.view_layer.update()
    assert same(synced.scene, fresh())
    changes = edit not in {paint_unused, next_frame, parent}  # the parent stands at the origin
    assert (synced.scene is not before) == changes


@pytest.mark.parametrize("seed", range(4))
def test_edits_one_after_the_other(synced, seed):
    generator = random.Random(seed)
    for _ in range(30):
        edit = generator.choice([e for e in EDITS if e is not instance_collection or "Empty" not in bpy.data.objects])
        if edit is move_twin and "Twin" not in bpy.data.objects or edit is hide and "Twin" not in bpy.data.objects:
            continue
        edit()
        bpy.context.view_layer.update()
        assert same(synced.scene, fresh()), edit.__name__


def test_what_stays_is_the_same_object(synced):
    before = synced.scene
    move()
    bpy.context.view_layer.update()
    after = synced.scene
    assert [a is b for a, b in zip(before.instances, after.instances, strict=True)].count(False) == 1
    assert after.meshes is before.meshes and after.materials is before.materials and after.lights is before.lights
    paint()
    bpy.context.view_layer.update()
    assert synced.scene.instances is after.instances and synced.scene.materials is not after.materials


def test_scenes_that_were_handed_out_stay_as_they_were(synced):
    before = synced.scene
    matrices = [instance.matrix.copy() for instance in before.instances]
    positions = [mesh.positions.copy() for mesh in before.meshes]
    for edit in (move, edit_mesh, ask_for_generated, remove, add):
        edit()
        bpy.context.view_layer.update()
    for instance, matrix in zip(before.instances, matrices, strict=True):
        np.testing.assert_array_equal(instance.matrix, matrix)
    for mesh, known in zip(before.meshes, positions, strict=True):
        np.testing.assert_array_equal(mesh.positions, known)
    assert not any(mesh.attributes for mesh in before.meshes)


def test_what_objects_lack_is_told_until_they_have_it(synced):
    tree = bpy.data.materials["Red"].node_tree
    attribute = tree.nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = "Rust"
    tree.links.new(attribute.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    bpy.context.view_layer.update()
    before = synced.scene
    assert any("Rust" in text for text in before.warnings)
    bpy.data.objects["Other"].select_set(True)  # lists all instances again, and changes nothing
    bpy.context.view_layer.update()
    assert synced.scene is before
    move()
    bpy.context.view_layer.update()
    assert synced.scene.warnings == before.warnings


def test_an_edit_of_one_object_reads_no_other(synced, monkeypatch):
    """The cost of an edit does not grow with the scene: the depsgraph's instances are not listed again."""
    asked = []

    def shown(source: bpy.types.Object) -> bool:
        asked.append(source.name)
        return True

    monkeypatch.setattr(synced, "update", functools.partial(synced.update, shown=shown))
    for edit in (move, edit_mesh, paint, brighten, move_light, recolor_world):
        edit()
        bpy.context.view_layer.update()
        assert same(synced.scene, fresh()), edit.__name__
    assert not asked
    _add("New", bpy.data.meshes["Cube"])
    bpy.context.view_layer.update()
    assert {"Cube", "Twin", "Other", "New"} <= set(asked)


def test_a_mesh_that_bends_keeps_its_other_arrays(synced):
    bpy.data.meshes["Other"].shade_smooth()
    bpy.context.view_layer.update()
    (before,) = (mesh for mesh in synced.scene.meshes if mesh.name == "Other")
    edit_other_mesh()
    bpy.context.view_layer.update()
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


def test_many_objects_move_at_once_and_some_change_otherwise(synced):
    root = _add("Root", None)
    crowd = [_add(f"Crowd {number}", bpy.data.meshes["Cube" if number % 3 else "Other"]) for number in range(50)]
    for number, source in enumerate(crowd):
        source.location, source.parent = (number, 2.0, 0.0), root
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
        change(chance.choice(crowd))
        bpy.context.view_layer.update()
        assert same(synced.scene, fresh()), frame
        root.location.y += 0.5
        change(chance.choice(crowd))
        bpy.context.scene.frame_set(frame)
        assert same(synced.scene, fresh()), frame


def test_what_is_multiplied_keeps_to_what_multiplies_it(synced):
    """Two empties bring the same objects, one of them with a material of its own."""
    collection = bpy.data.collections.new("Brought")
    for name in ("Cube", "Twin"):
        collection.objects.link(bpy.data.objects[name])
    slot = bpy.data.objects["Twin"].material_slots[0]
    slot.link, slot.material = "OBJECT", bpy.data.materials["Blue"]
    for number in range(2):
        empty = _add(f"Bringing {number}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location.z = 3.0 + number
    bpy.context.view_layer.update()
    assert same(synced.scene, fresh())
    scene = synced.scene
    brought = [instance for instance in scene.instances if instance.matrix[2, 3] >= 3.0]
    names = sorted((i.object_name, i.matrix[2, 3], scene.materials[i.materials[0]].name) for i in brought)
    assert names == [("Cube", 3.0, "Red"), ("Cube", 4.0, "Red"), ("Twin", 3.0, "Blue"), ("Twin", 4.0, "Blue")]
    assert len({instance.random for instance in brought}) == 4


def add_same_place():
    """Exchange a mesh, the memory of which may be used for the next one."""
    bpy.data.meshes.remove(bpy.data.meshes["Other"])
    _add("New", _box("New", 0.7))


@pytest.mark.parametrize("edit", [*EDITS, add_same_place])
def test_what_changes_while_an_export_is_in_slices(synced, edit):
    """A slice has time for one mesh; the edit comes amid them, and again before the end."""
    if edit is instance_collection:
        edit()
        bpy.context.view_layer.update()
    sync, graph = SceneSync(), bpy.context.evaluated_depsgraph_get()
    first = advance(sync, graph)
    while first.objects == 0:
        first = advance(sync, graph)
    assert 0 < first.objects < first.of
    prepared = []

    def follow(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        prepared.append(advance(sync, depsgraph))

    bpy.app.handlers.depsgraph_update_post.append(follow)
    bpy.app.handlers.frame_change_post.append(follow)
    if edit is not instance_collection:
        edit()
        bpy.context.view_layer.update()
    assert edit is instance_collection or prepared
    bpy.app.handlers.depsgraph_update_post.remove(follow)
    bpy.app.handlers.frame_change_post.remove(follow)
    graph = bpy.context.evaluated_depsgraph_get()
    finish(sync, graph)
    assert same(sync.scene, fresh())


def advance(sync: SceneSync, graph: bpy.types.Depsgraph):
    """A slice without time: one step and no more is done."""
    return sync.advance(graph, CAMERA, None, 0.0)


def finish(sync: SceneSync, graph: bpy.types.Depsgraph) -> int:
    """Slices until the scene is up to date."""
    slices = 1
    while advance(sync, graph) is not None:
        slices += 1
        assert slices < 2000
        time.sleep(0.001)  # threads may have something to do
    return slices


def test_no_slice_reads_what_another_has_read(synced, monkeypatch):
    """Each array of each mesh is read once, however short the slices are."""
    for name, read in meshes._READERS.items():
        monkeypatch.setitem(meshes._READERS, name, counted(name, read))
    monkeypatch.setattr(meshes, "_FEW", 0)
    reads.clear()
    assert finish(SceneSync(), bpy.context.evaluated_depsgraph_get()) > 10
    assert collections.Counter(reads) == dict.fromkeys(meshes._READERS, 2)


reads: list[str] = []


def counted(name, read):
    def reading(*arguments):
        reads.append(name)
        return read(*arguments)

    return reading


def test_slices_give_what_is_exported_at_once(synced, monkeypatch):
    """Arrays in parts, an image in steps; tangents and islands by threads; and a curve, which Blender converts."""
    mesh, tree = bpy.data.meshes["Cube"], bpy.data.materials["Red"].node_tree
    map_ = mesh.uv_layers.new(name="Map")
    map_.uv.foreach_set("vector", np.random.default_rng(1).random(2 * len(mesh.loops)))
    image = bpy.data.images.new("Noise", 32, 16)
    image.pixels.foreach_set(np.random.default_rng(2).random(32 * 16 * 4, np.float32))
    shader = tree.nodes["Principled BSDF"]
    for kind, output, socket in (
        ("ShaderNodeTexImage", "Color", "Base Color"),
        ("ShaderNodeNormalMap", "Normal", "Normal"),
        ("ShaderNodeNewGeometry", "Random Per Island", "Roughness"),
        ("ShaderNodeAttribute", "Fac", "Metallic"),
    ):
        node = tree.nodes.new(kind)
        tree.links.new(node.outputs[output], shader.inputs[socket])
    next(node for node in tree.nodes if node.type == "TEX_IMAGE").image = image
    name = next(iter(meshes._READERS))  # also that of an array which is read in a step
    mesh.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", np.random.default_rng(3).random(8))
    next(node for node in tree.nodes if node.type == "ATTRIBUTE").attribute_name = name
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.splines.new("POLY").points.add(3)
    curve.extrude = 0.5
    for number, point in enumerate(curve.splines[0].points):
        point.co = (number, number % 2, 0.0, 1.0)
    _add("Curve", curve)
    bpy.context.view_layer.update()
    whole = fresh()
    assert len(whole.images) == 1 and any(len(mesh.attributes) == 3 for mesh in whole.meshes)
    monkeypatch.setattr(meshes, "_FEW", 0)
    monkeypatch.setattr(meshes, "_COPIED_BYTES", 24)
    monkeypatch.setattr(images, "_LARGE", 1)
    sync = SceneSync()
    finish(sync, bpy.context.evaluated_depsgraph_get())
    assert same(sync.scene, whole) and equal(sync.scene.images, whole.images)


def test_many_new_objects_are_exported_in_slices(synced):
    graph = bpy.context.evaluated_depsgraph_get()
    handlers = list(bpy.app.handlers.depsgraph_update_post)
    bpy.app.handlers.depsgraph_update_post.clear()
    for number in range(4):
        _add(f"New {number}", _box(f"New {number}", 0.3))
    bpy.context.view_layer.update()
    bpy.app.handlers.depsgraph_update_post.extend(handlers)
    graph = bpy.context.evaluated_depsgraph_get()
    before = synced.scene
    assert advance(synced, graph) is not None and synced.scene is before
    assert finish(synced, graph) >= 4
    assert same(synced.scene, fresh())


@pytest.fixture
def kept(synced):
    """Kept export of a viewport that was switched to Solid; the engine's own handlers note what changes."""
    graph = bpy.context.evaluated_depsgraph_get()
    kept_exports.keep(kept_exports.key_of(graph), synced)
    follow = next(f for f in bpy.app.handlers.depsgraph_update_post if f.__name__ == "follow")
    for handlers in (bpy.app.handlers.depsgraph_update_post, bpy.app.handlers.frame_change_post):
        handlers.remove(follow)
    yield synced
    kept_exports.forget()
    for handlers in (bpy.app.handlers.depsgraph_update_post, bpy.app.handlers.frame_change_post):
        handlers.append(follow)


def switch_back() -> SceneSync | None:
    """Return the export that a viewport finds when it is switched to Rendered, or None."""
    bpy.context.view_layer.update()
    return kept_exports.take(bpy.context.evaluated_depsgraph_get())


def edit_in_edit_mode():
    """Enter edit mode, move a vertex, and stay there."""
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.update()
    edited = bmesh.from_edit_mesh(bpy.data.meshes["Cube"])
    edited.verts.ensure_lookup_table()
    edited.verts[0].co.x -= 0.3
    bmesh.update_edit_mesh(bpy.data.meshes["Cube"])


def edit_and_leave_edit_mode():
    """And leave it."""
    edit_in_edit_mode()
    bpy.context.view_layer.update()
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("edit", [*EDITS, add_same_place, edit_in_edit_mode, edit_and_leave_edit_mode])
def test_what_changes_in_another_shading_is_seen_after_switching_back(kept, edit):
    edit()
    found = switch_back()
    assert found is kept
    graph = bpy.context.evaluated_depsgraph_get()
    assert len(graph.updates) == 0
    assert same(found.update(graph, CAMERA), fresh())


@pytest.mark.parametrize("seed", range(2))
def test_many_edits_in_another_shading_are_seen_after_switching_back(kept, seed):
    generator = random.Random(seed)
    for edit in generator.sample([*EDITS, add_same_place], 8):
        if edit not in {move_twin, hide} or "Twin" in bpy.data.objects:
            edit()
            bpy.context.view_layer.update()
    assert same(switch_back().update(bpy.context.evaluated_depsgraph_get(), CAMERA), fresh())


@pytest.mark.parametrize("edit, exported", [(move, []), (paint, []), (brighten, []), (edit_other_mesh, ["Other"])])
def test_switching_back_exports_what_has_changed(kept, monkeypatch, edit, exported):
    names, export_mesh = [], mesh_table.export_mesh
    monkeypatch.setattr(
        mesh_table, "export_mesh", lambda mesh, name, *more: names.append(name) or export_mesh(mesh, name, *more)
    )
    before = kept.scene
    assert switch_back().update(bpy.context.evaluated_depsgraph_get(), CAMERA) is before
    kept_exports.keep(kept_exports.key_of(bpy.context.evaluated_depsgraph_get()), kept)
    edit()
    assert switch_back().update(bpy.context.evaluated_depsgraph_get(), CAMERA) is not before
    assert names == exported


def test_nothing_is_kept_beyond_undo_another_file_or_another_view_layer(kept):
    graph = bpy.context.evaluated_depsgraph_get()
    other = bpy.context.scene.view_layers.new("Other")
    other.update()
    assert kept_exports.take(other.depsgraph) is None
    for what in (lambda: bpy.ops.ed.undo(), lambda: bpy.ops.wm.read_factory_settings(use_empty=True)):
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ed.undo_push(message="after")
        kept_exports.keep(kept_exports.key_of(graph), kept)
        what()
        graph = bpy.context.evaluated_depsgraph_get()
        assert not kept_exports._kept


def test_what_takes_too_much_memory_or_changes_all_at_once_is_not_kept(kept, monkeypatch):
    monkeypatch.setattr(kept_exports, "_MOST_UPDATES", 2)
    move()
    edit_other_mesh()
    assert switch_back() is None
    monkeypatch.setattr(kept_exports, "MOST_BYTES", 100)
    kept_exports.keep(kept_exports.key_of(bpy.context.evaluated_depsgraph_get()), kept)
    assert switch_back() is None


def in_edit_mode(*names: str) -> None:
    for source in bpy.context.view_layer.objects:
        source.select_set(source.name in names)
    bpy.context.view_layer.objects.active = bpy.data.objects[names[0]]
    bpy.ops.object.mode_set(mode="EDIT")


def in_object_mode() -> None:
    bpy.ops.object.mode_set(mode="OBJECT")


def pull() -> None:
    """A vertex of the mesh under edit moves."""
    mesh = bmesh.from_edit_mesh(bpy.data.meshes["Cube"])
    mesh.verts.ensure_lookup_table()
    mesh.verts[0].co.x -= 0.3
    bmesh.update_edit_mesh(bpy.data.meshes["Cube"])


def cut() -> None:
    """Edges of the mesh under edit are divided, and a face goes."""
    mesh = bmesh.from_edit_mesh(bpy.data.meshes["Cube"])
    bmesh.ops.subdivide_edges(mesh, edges=mesh.edges[:], cuts=1)
    mesh.faces.ensure_lookup_table()
    bmesh.ops.delete(mesh, geom=[mesh.faces[0]], context="FACES")
    bmesh.update_edit_mesh(bpy.data.meshes["Cube"])


def assign() -> None:
    """A face of the mesh under edit takes the second material."""
    bpy.data.meshes["Cube"].materials.append(bpy.data.materials["Blue"])
    mesh = bmesh.from_edit_mesh(bpy.data.meshes["Cube"])
    mesh.faces.ensure_lookup_table()
    mesh.faces[1].material_index = 1
    bmesh.update_edit_mesh(bpy.data.meshes["Cube"])


@pytest.mark.parametrize("names", [("Cube",), ("Cube", "Other"), ("Other", "Cube")])
def test_edit_mode_is_followed(synced, names):
    """One object or several are in it, whose mesh another object has as well."""
    steps = (
        lambda: in_edit_mode(*names), pull, move, move_twin, paint, cut, ask_for_generated, pull, subdivide, assign,
        in_object_mode, edit_mesh, lambda: in_edit_mode(*names), pull, in_object_mode,
    )  # fmt: skip
    for step in steps:
        step()
        bpy.context.view_layer.update()
        assert same(synced.scene, fresh()), step
        assert len(synced.scene.instances) == 3 and synced.scene.warnings == []
    assert sum(mesh.triangle_count for mesh in synced.scene.meshes) > 3 * 12


def test_a_mesh_in_edit_mode_is_what_it_is_outside(scene):
    """With materials, UV, colors and the attributes that nodes ask for."""
    cube = _add("Cube", _box("Cube"))
    for name in ("Red", "Blue"):
        cube.data.materials.append(bpy.data.materials.new(name))
    cube.data.polygons[2].material_index, cube.data.polygons[3].use_smooth = 1, True
    layer = cube.data.uv_layers.new(name="Map")
    for number, place in enumerate(layer.uv):
        place.vector = (0.1 * number, 0.5)
    cube.data.attributes.new("Rust", "FLOAT", "POINT").data[3].value = 2.0
    tree = bpy.data.materials["Red"].node_tree
    if tree is None:
        bpy.data.materials["Red"].use_nodes = True
        tree = bpy.data.materials["Red"].node_tree
    rust = tree.nodes.new("ShaderNodeAttribute")
    rust.attribute_name = "Rust"
    tree.links.new(rust.outputs["Fac"], tree.nodes["Principled BSDF"].inputs["Roughness"])
    bpy.context.view_layer.update()
    outside = fresh()
    in_edit_mode("Cube")
    bpy.context.view_layer.update()
    inside = fresh()
    in_object_mode()
    assert same(inside, outside) and inside.meshes[0].triangle_count == 12


@pytest.mark.parametrize("edit", [pull, cut, assign])
def test_an_edit_amid_an_export_in_slices(synced, edit):
    in_edit_mode("Cube")
    bpy.context.view_layer.update()
    sync = SceneSync()

    def follow(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        advance(sync, depsgraph)

    advance(sync, bpy.context.evaluated_depsgraph_get())
    bpy.app.handlers.depsgraph_update_post.append(follow)
    edit()
    bpy.context.view_layer.update()
    bpy.app.handlers.depsgraph_update_post.remove(follow)
    finish(sync, bpy.context.evaluated_depsgraph_get())
    assert same(sync.scene, fresh())

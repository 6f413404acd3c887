# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances that are exported as arrays, beside the same instances one by one."""

import bpy
import numpy as np
import pytest
from blender_scenes import CAMERA, add_light, add_mesh, collect, depsgraph, export, following, show_collection
from node_trees import add_node, link, new_material, node_group, surface

from rppm_addon.blender.export import SceneSync
from rppm_addon.blender.export.common.report import ExportStopped, Report
from rppm_addon.blender.export.context import ExportContext
from rppm_addon.blender.export.instances.objects import ObjectExporter
from rppm_addon.scene import RayVisibility

MANY = 40
"""More instances than are exported one by one."""


def one_by_one(graph):
    """All instances of a depsgraph; those that are to be found again in other frames are in no array."""
    context = ExportContext(Report())
    context.read_from(graph)
    placed = ObjectExporter(context).export(graph, identify=True)
    assert placed.arrays == []
    return placed.instances


def members(instance):
    named = {name: getattr(instance, name) for name in instance.__slots__}
    return {**named, "matrix": (instance.matrix.dtype, instance.matrix.tobytes())}


def assert_same_instances(scene, most_alone):
    """Arrays have the same instances, in the same order, and leave few alone."""
    exported, expected = export(scene), one_by_one(depsgraph())
    assert len(exported.instances) <= most_alone and exported.instance_count == len(expected)
    assert list(map(members, exported.expanded().instances)) == list(map(members, expected))
    return exported


@pytest.fixture
def piece(scene):
    """A mesh object in a collection of its own, whose material asks for random numbers."""
    material = new_material("Piece")
    number = material.node_tree.nodes.new("ShaderNodeObjectInfo").outputs["Random"]
    surface("ShaderNodeEmission", material=material, Color=number)
    return add_mesh(scene, "Piece", material=material, location=(0.5, 0.0, 0.0))


def asking(name, domain="INSTANCER"):
    """A material that reads an attribute of instancers."""
    material = new_material("Asking")
    asked = add_node(material.node_tree, "ShaderNodeAttribute", attribute_type=domain, attribute_name=name)
    surface("ShaderNodeEmission", material=material, Color=asked.outputs["Color"])
    return material


def scatter(scene, *kinds, count=MANY, name="Host", material=None, copies=1, **values):
    """A host whose nodes of geometry put each kind of mesh in turn on the points of a line, and all of these on those
    of another where copies are wanted. The attribute "place" of an instance is where it is."""
    tree, _, last = node_group(outputs=[("Geometry", "Geometry")], tree_type="GeometryNodeTree")
    choice = tree.nodes.new("GeometryNodeGeometryToInstance")
    for kind in kinds:
        shape = add_node(tree, kind)
        painted = add_node(
            tree, "GeometryNodeSetMaterial", Material=material or new_material(kind), Geometry=shape.outputs["Mesh"]
        )
        link(tree, painted.outputs[0], choice.inputs[0])
    line = add_node(tree, "GeometryNodeMeshLine", Count=count, Offset=(0.1, 0.2, 0.3))
    placed = add_node(
        tree,
        "GeometryNodeInstanceOnPoints",
        Points=line.outputs["Mesh"],
        Instance=choice.outputs[0],
        Pick_Instance=True,
        Rotation=(0.1, 0.2, 0.3),
    )
    stored = add_node(
        tree,
        "GeometryNodeStoreNamedAttribute",
        data_type="FLOAT_VECTOR",
        domain="INSTANCE",
        Name="place",
        Geometry=placed.outputs["Instances"],
    )
    value = next(socket for socket in stored.inputs if socket.name == "Value" and socket.enabled)
    link(tree, add_node(tree, "GeometryNodeInputPosition").outputs[0], value)
    made = stored.outputs["Geometry"]
    if copies > 1:
        row = add_node(tree, "GeometryNodeMeshLine", Count=copies, Offset=(3.0, 0.0, 0.0))
        made = add_node(tree, "GeometryNodeInstanceOnPoints", Points=row.outputs["Mesh"], Instance=made).outputs[0]
    link(tree, made, last.inputs[0])
    host = add_mesh(scene, name, **values)
    host.modifiers.new("Scatter", "NODES").node_group = tree
    return host


def test_geometry_nodes(scene):
    scatter(scene, "GeometryNodeMeshCube", "GeometryNodeMeshCone", count=3 * MANY, location=(1.0, 2.0, 3.0))
    exported = assert_same_instances(scene, most_alone=1)
    assert sorted(map(len, exported.instance_arrays)) == [60, 60]
    assert len({array.first.mesh for array in exported.instance_arrays}) == 2
    assert len(np.unique(exported.instance_arrays[0].randoms)) == 60


def test_few_instances_are_no_array(scene):
    scatter(scene, "GeometryNodeMeshCube", count=5)
    assert assert_same_instances(scene, most_alone=6).instance_arrays == []


def test_instances_between_those_of_arrays_keep_their_order(scene, piece):
    """A collection of a mesh and a text, which comes as a curve and as a mesh, and a light."""
    text = bpy.data.objects.new("Text", bpy.data.curves.new("Text", "FONT"))
    text.data.body = "a"
    scene.collection.objects.link(text)
    collection = collect(scene, piece, text, add_light(scene, "POINT"))
    for number in range(MANY):
        show_collection(scene, collection, f"Show{number:02}", location=(number, 0.0, 0.0))
    exported = assert_same_instances(scene, most_alone=MANY)
    (array,) = exported.instance_arrays
    assert array.first.object_name == "Piece" and len(exported.lights) == MANY
    assert not set(np.diff(array.places)) <= {1}


def test_what_instancers_pass_on_separates_arrays(scene, piece):
    collection = collect(scene, piece)
    for number in range(2 * MANY):
        empty = show_collection(scene, collection, f"Show{number:02}", location=(number, 0.0, 0.0))
        empty.is_holdout = number % 2 == 1
        empty.visible_glossy = number != 7
    exported = assert_same_instances(scene, most_alone=1)
    holdouts = {array.first.holdout: len(array) for array in exported.instance_arrays}
    assert holdouts == {False: MANY, True: MANY - 1}
    (alone,) = exported.instances
    assert alone.visibility == RayVisibility.ALL ^ RayVisibility.GLOSSY


def grid_that_shows(scene, piece, kind):
    """A grid of 49 faces with a UV map that multiplies a piece."""
    places = [(0.3 * (number % 8), 0.3 * (number // 8), 0.0) for number in range(64)]
    faces = [(8 * y + x, 8 * y + x + 1, 8 * y + x + 9, 8 * y + x + 8) for x in range(7) for y in range(7)]
    host = add_mesh(scene, "Host", places, faces)
    uv = host.data.uv_layers.new(name="UVMap")
    uv.data.foreach_set("uv", np.linspace(0.0, 1.0, 2 * len(host.data.loops)))
    piece.parent, host.instance_type = host, kind


@pytest.mark.parametrize("kind", ["FACES", "VERTS"])
def test_faces_and_vertices(scene, piece, kind):
    grid_that_shows(scene, piece, kind)
    (array,) = assert_same_instances(scene, most_alone=2).instance_arrays
    assert len(array) == {"FACES": 49, "VERTS": 64}[kind]


@pytest.mark.parametrize("output", ["Generated", "UV"])
def test_coordinates_on_the_instancer(scene, piece, output):
    tree = piece.data.materials[0].node_tree
    asked = add_node(tree, "ShaderNodeTexCoord", from_instancer=True)
    emission = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeEmission")
    link(tree, asked.outputs[output], emission.inputs["Color"])
    grid_that_shows(scene, piece, "FACES")
    (array,) = assert_same_instances(scene, most_alone=2).instance_arrays
    (values,) = array.attributes.values()
    assert values.shape == (49, 3) and (output == "Generated" or len(np.unique(values[:, 0])) == 49)


@pytest.mark.skipif(not hasattr(bpy.types.Object, "evaluated_geometry"), reason="Blender tells since 4.5")
@pytest.mark.parametrize("copies", [1, 4])
def test_attributes_of_geometry_nodes(scene, copies):
    """Two hosts, whose instances Blender numbers from 0 on, share a material; one has a property of its own instead."""
    material = asking("place")
    hosts = [
        scatter(
            scene, "GeometryNodeMeshCube", "GeometryNodeMeshCone", count=80, copies=copies, material=material, name=name
        )
        for name in ("A", "B", "C")
    ]
    hosts[2].modifiers[0].node_group.nodes["Store Named Attribute"].inputs["Name"].default_value = "other"
    hosts[2]["place"] = 7.0
    exported = assert_same_instances(scene, most_alone=3)
    arrays = exported.instance_arrays
    assert [len(array) for array in arrays] == [40 * copies] * 6
    assert all(len(np.unique(array.attributes["INSTANCER:place"], axis=0)) == 40 for array in arrays[:4])
    assert all(array.attributes == {} for array in arrays[4:])
    assert {array.first.attributes["INSTANCER:place"] for array in arrays[4:]} == {(7.0,)}


@pytest.mark.skipif(not hasattr(bpy.types.Object, "evaluated_geometry"), reason="Blender tells since 4.5")
def test_attributes_in_slices(scene):
    scatter(scene, "GeometryNodeMeshCube", count=1000, material=asking("place"))
    sync = SceneSync()
    while sync.advance(depsgraph(), CAMERA, None, 0.0) is not None:
        pass
    (array,) = sync.scene.instance_arrays
    np.testing.assert_allclose(array.attributes["INSTANCER:place"][:, :3], array.matrices[:, :, 3], atol=1e-6)
    assert list(map(members, sync.scene.expanded().instances)) == list(map(members, one_by_one(depsgraph())))


def emit(scene, piece, count=MANY, **values):
    """A mesh object whose particles are instances of a piece."""
    emitter = add_mesh(scene, "Emitter")
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = count, 1, 1, 100
    settings.render_type, settings.instance_object = "OBJECT", piece
    for name, value in values.items():
        setattr(settings, name, value)
    scene.frame_set(4)
    return emitter


@pytest.mark.parametrize("kind", ["EMITTER", "HAIR"])
def test_particles(scene, piece, kind):
    emit(scene, piece, type=kind, size_random=0.5)
    (array,) = assert_same_instances(scene, most_alone=2).instance_arrays
    assert len(array) == MANY
    if kind == "EMITTER":
        assert len(np.unique(array.particles.index)) == MANY and set(array.particles.age) == {3.0}


def test_flat_and_singular_placements(scene, caplog):
    """Flattened placements are made usable one by one, and those without extent are left out."""
    for name, scale in (("Flat", (1.0, 1.0, 0.0)), ("Gone", (0.0, 0.0, 0.0)), ("Mirrored", (-1.0, 1.0, 1.0))):
        scatter(scene, "GeometryNodeMeshCube", name=name, scale=scale)
    exported = assert_same_instances(scene, most_alone=MANY + 2)
    (array,) = exported.instance_arrays
    assert array.first.object_name == "Mirrored" and (np.linalg.det(array.matrices[:, :, :3]) < 0.0).all()
    assert any(f'"Gone": {MANY} placements have no extent' in warning for warning in exported.warnings)


def test_what_is_not_seen_is_in_no_array(scene):
    host = scatter(scene, "GeometryNodeMeshCube")
    for rays in ("camera", "diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
        setattr(host, f"visible_{rays}", False)
    assert assert_same_instances(scene, most_alone=0).instance_count == 0


def test_nested_instances(scene, piece):
    inner = collect(scene, piece, scatter(scene, "GeometryNodeMeshCone"))
    outer = collect(
        scene, *(show_collection(scene, inner, f"In{number}", location=(0, number, 0)) for number in range(4))
    )
    for number in range(10):
        show_collection(scene, outer, f"Out{number}", location=(number, 0.0, 0.0), scale=(1.0 + number, 1.0, 1.0))
    exported = assert_same_instances(scene, most_alone=40)
    assert sorted(map(len, exported.instance_arrays)) == [40, 40 * MANY]


def test_an_export_in_slices_gives_the_same_arrays(scene, piece):
    """A slice without time ends after the least that it does."""
    emit(scene, piece, count=1000)
    scatter(scene, "GeometryNodeMeshCube", count=1000)
    sync, slices = SceneSync(), 1
    while (progress := sync.advance(depsgraph(), CAMERA, None, 0.0)) is not None:
        assert progress.objects <= progress.of
        slices += 1
    assert slices > 10
    expected = one_by_one(depsgraph())
    assert list(map(members, sync.scene.expanded().instances)) == list(map(members, expected))
    assert sorted(map(len, sync.scene.instance_arrays)) == [1000, 1000]


def test_arrays_that_have_not_changed_are_the_same(scene):
    """When another object is moved, and when all is listed anew."""
    other = add_mesh(scene, "Other")
    scatter(scene, "GeometryNodeMeshCube")
    sync = SceneSync()
    before = sync.update(depsgraph(), CAMERA)
    other.location.x = 5.0
    with following(lambda graph: sync.update(graph, CAMERA)):
        scene.view_layers[0].update()
    moved = sync.scene
    sync.relist()
    relisted = sync.update(depsgraph(), CAMERA)
    assert moved is not before and relisted is moved
    assert moved.instance_arrays[0] is before.instance_arrays[0]


def test_a_user_can_stop_amid_the_instances(scene):
    scatter(scene, "GeometryNodeMeshCube", count=2000)
    scene.view_layers[0].update()
    shown = []
    report = Report(should_stop=lambda: any("(" in text for text in shown), show=shown.append)
    context = ExportContext(report)
    context.read_from(depsgraph())
    with pytest.raises(ExportStopped):
        ObjectExporter(context).export(depsgraph())
    assert shown[-1].startswith("Exporting objects (") and "2001" not in shown[-1]

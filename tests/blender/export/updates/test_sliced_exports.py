# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports in slices, between which Blender stays responsive, give what is exported at once."""

import time

import bpy
import edits
import numpy as np
import pytest
from blender_scenes import CAMERA, add_object, depsgraph, following, new_image
from edits import EDITS, do, fresh, same
from node_trees import add_node

from rppm_addon.blender.export.updates.sync import SceneSync
from rppm_addon.scene.storage.sharing import equal


def advance(sync: SceneSync, graph: bpy.types.Depsgraph):
    """A slice without time: one step and no more is done."""
    return sync.advance(graph, CAMERA, None, 0.0)


def finish(sync: SceneSync) -> int:
    """The number of slices until the scene is up to date."""
    slices = 1
    while advance(sync, depsgraph()) is not None:
        slices += 1
        assert slices < 2000
        time.sleep(0.001)  # threads may have something to do
    return slices


@pytest.mark.parametrize("edit", [*EDITS, edits.add_same_place])
def test_what_changes_while_an_export_is_in_slices(edited, edit):
    """A slice has time for one mesh; the edit comes amid them, and again before the end."""
    if edit is edits.instance_collection:
        do(edit)
    sync = SceneSync()
    first = advance(sync, depsgraph())
    while first.objects == 0:
        first = advance(sync, depsgraph())
    assert 0 < first.objects < first.of
    prepared = []
    with following(lambda graph: prepared.append(advance(sync, graph))):
        if edit is not edits.instance_collection:
            do(edit)
            assert prepared
    finish(sync)
    assert same(sync.scene, fresh())


@pytest.mark.parametrize("edit", [edits.pull, edits.cut, edits.assign])
def test_an_edit_amid_an_export_in_slices(edited, edit):
    do(lambda: edits.in_edit_mode("Cube"))
    sync = SceneSync()
    advance(sync, depsgraph())
    with following(lambda graph: advance(sync, graph)):
        do(edit)
    finish(sync)
    assert same(sync.scene, fresh())


def test_slices_give_what_is_exported_at_once(edited, scene):
    """Arrays in parts, an image in steps; tangents and islands by threads; and a curve, which Blender converts."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=70, y_subdivisions=70)  # so large that each array is a step
    mesh, tree = bpy.context.object.data, bpy.data.materials["Red"].node_tree
    mesh.materials.append(bpy.data.materials["Red"])
    random = np.random.default_rng(1)
    mesh.uv_layers.new(name="Map").uv.foreach_set("vector", random.random(2 * len(mesh.loops)))
    name = "corner_vertices"  # also that of an array which is read in a step
    mesh.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", random.random(len(mesh.vertices)))
    image = new_image("Noise", random.random((1024, 1024, 4), np.float32))  # read in steps
    for kind, output, socket, properties in (
        ("ShaderNodeTexImage", "Color", "Base Color", {"image": image}),
        ("ShaderNodeNormalMap", "Normal", "Normal", {}),
        ("ShaderNodeNewGeometry", "Random Per Island", "Roughness", {}),
        ("ShaderNodeAttribute", "Fac", "Metallic", {"attribute_name": name}),
    ):
        node = add_node(tree, kind, **properties)
        tree.links.new(node.outputs[output], edits.principled("Red").inputs[socket])
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=450, y_subdivisions=450)  # so large that an array is copied in parts
    bpy.context.object.data.shade_smooth()
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.splines.new("POLY").points.add(3)
    curve.extrude = 0.5
    for number, point in enumerate(curve.splines[0].points):
        point.co = (number, number % 2, 0.0, 1.0)
    add_object(scene, "Curve", curve)
    bpy.context.view_layer.update()
    whole = fresh()
    assert len(whole.images) == 1 and any(len(mesh.attributes) == 3 for mesh in whole.meshes)
    assert max(mesh.corner_normals.nbytes for mesh in whole.meshes) > 1 << 23
    sync = SceneSync()
    assert finish(sync) > 10
    assert same(sync.scene, whole) and equal(sync.scene.images, whole.images)


def test_many_new_objects_are_exported_in_slices(edited):
    sync = SceneSync()
    before = sync.update(depsgraph(), CAMERA)
    for number in range(4):
        edits.add_box(f"New {number}", 0.3)
    bpy.context.view_layer.update()
    assert advance(sync, depsgraph()) is not None and sync.scene is before
    assert finish(sync) >= 4
    assert same(sync.scene, fresh())

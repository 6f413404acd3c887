# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances nested deep, of themselves, and of meshes that are replaced or deleted meanwhile."""

import dataclasses

import bpy
import numpy as np
import pytest
from blender_scenes import CAMERA, add_mesh, collect, depsgraph, export, following, show_collection
from node_trees import add_node, link, node_group

from rppm_addon.blender.export import SceneSync
from rppm_addon.scene import Instancing


def matrices_of_blender():
    """Sorted matrices of the instances of meshes that Blender lists, (n, 16)."""
    entries = depsgraph().object_instances
    found = [
        np.array(entry.matrix_world).ravel()
        for entry in entries
        if entry.show_self and entry.object.type == "MESH" and len(entry.object.data.polygons)
    ]
    return in_order(found)


def in_order(matrices):
    rows = np.round(np.array(matrices, np.float64).reshape(-1, 16), 4)
    return rows[np.lexsort(rows.T)]


def nested_collections(scene, levels):
    """Each shows the one below twice, a bit apart."""
    shown = collect(scene, add_mesh(scene, "Leaf"), name="Level0")
    for level in range(1, levels + 1):
        empties = [
            show_collection(
                scene, shown, f"Empty{level}{side}", location=(0.01 * 2**level * side, 0.0, 0.0), scale=scale
            )
            for side, scale in enumerate([(0.9, 0.9, 0.9), (0.9, -0.9, 0.8)])
        ]
        shown = shown if level == levels else collect(scene, *empties, name=f"Level{level}")


def nested_nodes(scene, levels):
    """Geometry nodes that put what the level below has made on two points."""
    tree, _, last = node_group(outputs=[("Geometry", "Geometry")], tree_type="GeometryNodeTree")
    made = add_node(tree, "GeometryNodeMeshCube").outputs["Mesh"]
    for level in range(levels):
        line = add_node(tree, "GeometryNodeMeshLine", Count=2, Offset=(0.01 * 2**level, 0.0, 0.0))
        made = add_node(
            tree, "GeometryNodeInstanceOnPoints", Points=line.outputs["Mesh"], Instance=made, Scale=(0.9, -0.9, 0.8)
        ).outputs[0]
    link(tree, made, last.inputs[0])
    add_mesh(scene, "Host").modifiers.new("Nodes", "NODES").node_group = tree


DEEPEST = {nested_collections: 7, nested_nodes: 6}
"""Levels of instances that Blender shows."""


@pytest.mark.parametrize("nest", DEEPEST)
@pytest.mark.parametrize("further", [0, 1, 3])
def test_nested_instances_are_those_that_blender_shows(scene, nest, further):
    nest(scene, DEEPEST[nest] + further)
    exported = export(scene).expanded()
    assert len(exported.instances) == 2 ** DEEPEST[nest] or further
    np.testing.assert_array_equal(in_order([it.matrix for it in exported.instances]), matrices_of_blender())


@pytest.mark.parametrize("nest", DEEPEST)
def test_pictures_of_nested_instances(lit, renderer, nest):
    """They are the same in two levels and expanded, and show them."""
    lit.objects["Quad"].hide_render = True
    nest(lit, DEEPEST[nest])
    scene, pictures = export(lit), []
    for scene.settings.instancing in (Instancing.EXPANDED, Instancing.TWO_LEVELS):
        pictures.append(renderer.render(scene).frame.combined)
    np.testing.assert_array_equal(*pictures)
    assert pictures[0][..., 3].max() == 1.0 and pictures[0][16, 16, :3].min() > 0.0


def by_its_own_nodes(scene):
    """Geometry nodes that put their own object on points."""
    tree, _, last = node_group(outputs=[("Geometry", "Geometry")], tree_type="GeometryNodeTree")
    host = add_mesh(scene, "Host")
    own = add_node(tree, "GeometryNodeObjectInfo", Object=host, As_Instance=True)
    line = add_node(tree, "GeometryNodeMeshLine", Count=3)
    placed = add_node(
        tree, "GeometryNodeInstanceOnPoints", Points=line.outputs["Mesh"], Instance=own.outputs["Geometry"]
    )
    link(tree, placed.outputs[0], last.inputs[0])
    host.modifiers.new("Nodes", "NODES").node_group = tree


def by_its_own_faces(scene):
    """A mesh whose faces multiply a child that multiplies itself likewise."""
    parent = add_mesh(scene, "Parent", instance_type="FACES")
    child = add_mesh(scene, "Child", instance_type="FACES", parent=parent)
    add_mesh(scene, "Grandchild", parent=child)


@pytest.mark.parametrize("make", [by_its_own_nodes, by_its_own_faces])
def test_instancers_of_themselves(lit, renderer, make):
    """They are rendered as far as Blender shows them. A circle of collections ends Blender itself."""
    make(lit)
    scene = export(lit)
    np.testing.assert_array_equal(in_order([it.matrix for it in scene.expanded().instances]), matrices_of_blender())
    assert len(scene.warnings) <= 1
    assert np.isfinite(renderer.render(scene).frame.combined).all()


def test_a_mesh_is_replaced_and_deleted_while_a_viewport_shows_it(lit, renderer):
    piece = add_mesh(lit, "Piece", scale=(0.1, 0.1, 0.1))
    shown = collect(lit, piece)
    for number in range(40):
        show_collection(lit, shown, f"Empty{number}", location=(0.02 * number, 0.1, 0.1))
    sync = SceneSync()

    def assert_shown(instances: int) -> None:
        lit.view_layers[0].update()
        scene = sync.update(depsgraph(), CAMERA)
        assert scene.instance_count == instances
        new = SceneSync().update(depsgraph(), CAMERA)
        quick = dataclasses.replace(scene.settings, iterations=1, photons=256)
        scenes = [dataclasses.replace(each, settings=quick) for each in (scene, new)]
        pictures = [renderer.render(each).frame.combined for each in scenes]
        np.testing.assert_array_equal(*pictures)

    with following(lambda graph: sync.update(graph, CAMERA)):
        assert_shown(41)
        before, piece.data = piece.data, bpy.data.meshes.new("Triangle")
        piece.data.from_pydata([(-2, -2, 0), (2, -2, 0), (0, 2, 0)], [], [(0, 1, 2)])
        bpy.data.meshes.remove(before)
        assert_shown(41)
        piece.data.clear_geometry()
        piece.data.update()
        assert_shown(1)
        bpy.data.meshes.remove(piece.data)
        assert_shown(1)

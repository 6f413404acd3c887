# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes and displacement of materials, and materials without outputs."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, export, export_graph
from node_trees import add_node, added, constant, link, shaders, surface
from single_shaders import OCHRE, single_shader

from rppm_addon.scene.meshes import SMOOTH_NORMALS, UNDISPLACED


def displaced():
    """A diffuse material with a Displacement node, and its shader."""
    material, diffuse = surface("ShaderNodeBsdfDiffuse", "Bumpy")
    tree = material.node_tree
    link(tree, add_node(tree, "ShaderNodeDisplacement").outputs[0], tree.nodes["Output"].inputs["Displacement"])
    return material, diffuse


def test_volume_absorption(scene):
    material, _ = surface("ShaderNodeBsdfGlass")
    tree = material.node_tree
    fog = add_node(tree, "ShaderNodeVolumeAbsorption", "Fog", Color=OCHRE, Density=4.0)
    link(tree, fog.outputs[0], tree.nodes["Output"].inputs["Volume"])
    add_mesh(scene, material=material)
    exported = export(scene)
    ((volume, weight),) = shaders(exported.materials[0].interior)
    assert (volume.kind, volume.inputs["color"], volume.inputs["density"]) == ("volume_absorption", OCHRE[:3], 4.0)
    assert weight == 1.0 and exported.warnings == []


def test_volume_alone_lets_light_in(scene, material, tree):
    absorption = add_node(tree, "ShaderNodeVolumeAbsorption", "Absorption", Density=1.0)
    fog = add_node(tree, "ShaderNodeVolumeScatter", "Fog")
    link(tree, added(tree, absorption, fog).outputs[0], tree.nodes["Output"].inputs["Volume"])
    shader, warnings = single_shader(scene, material)
    assert shader.kind == "bsdf_transparent" and any('"Fog" (Volume Scatter)' in text for text in warnings)


def test_displacement_turns_normals_and_moves_vertices(scene):
    material, diffuse = displaced()
    link(material.node_tree, add_node(material.node_tree, "ShaderNodeBump").outputs[0], diffuse.inputs["Normal"])
    graph, warnings = export_graph(scene, material)
    assert warnings == [] and graph.nodes[graph.normal.node].kind == "bump"
    assert graph.displacement is None and graph.nodes[graph.normal.node].attribute == ""
    for method in ("DISPLACEMENT", "BOTH"):
        material.displacement_method = method
        bpy.data.objects.remove(bpy.data.objects["Mesh"])
        graph, warnings = export_graph(scene, material)
        assert warnings == [] and graph.nodes[graph.displacement.node].kind == "displacement"
        assert (graph.normal is None) == (method == "DISPLACEMENT")
    assert graph.nodes[graph.normal.node].attribute == UNDISPLACED


def test_a_color_displaces_as_it_is(scene):
    material, _ = surface("ShaderNodeBsdfDiffuse")
    color = constant(material.node_tree, (0.25, 0.5, 1.0, 1.0), "ShaderNodeRGB")
    link(material.node_tree, color, material.node_tree.nodes["Output"].inputs["Displacement"])
    material.displacement_method = "DISPLACEMENT"
    graph, warnings = export_graph(scene, material)
    node = graph.nodes[graph.displacement.node]
    assert warnings == [] and node.inputs["vector"] == (0.25, 0.5, 1.0) and node.options["space"] == "WORLD"


@pytest.mark.parametrize("domain", ["POINT", "FACE", "CORNER"])
def test_meshes_tell_of_flat_faces_where_they_are_displaced(scene, domain):
    material, _ = displaced()
    bpy.ops.mesh.primitive_cube_add()
    mesh = bpy.context.object.data
    mesh.materials.append(material)
    others = [domain != "FACE"] * 5
    mesh.polygons.foreach_set("use_smooth", [domain == "POINT", *others])
    (exported,) = export(scene).meshes
    assert SMOOTH_NORMALS not in exported.attributes
    material.displacement_method = "DISPLACEMENT"
    (exported,) = export(scene).meshes
    if domain == "POINT":
        assert SMOOTH_NORMALS not in exported.attributes
        return
    values = exported.attributes[SMOOTH_NORMALS].values
    smooth = values[:, 3].reshape(-1, 4)
    assert (smooth == smooth[:, :1]).all() and smooth[:, 0].sum() == (0 if domain == "FACE" else 5)
    if domain == "FACE" or bpy.app.version < (5, 2):  # of a cube's vertices all normals are alike
        np.testing.assert_allclose(np.abs(values[:, :3]), 1.0 / np.sqrt(3.0), rtol=1e-5)
    else:
        np.testing.assert_array_equal(values[:, :3], exported.corner_normals)


@pytest.mark.parametrize("has_output", [True, False])
def test_what_has_no_surface_is_black_and_reported_where_it_has_no_output(scene, material, tree, has_output):
    if not has_output:
        tree.nodes.clear()
    graph, warnings = export_graph(scene, material)
    assert graph.surface is None and ["Material Output" in text for text in warnings] == [True] * (not has_output)

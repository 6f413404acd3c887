# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes of materials and of the world."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, export, set_world
from node_trees import add_node, added, constant, link, mixed, new_material, shaders, surface
from single_shaders import OCHRE

from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.scene import Link

KINDS = {
    "ShaderNodeVolumeAbsorption": "volume_absorption",
    "ShaderNodeVolumeScatter": "volume_scatter",
    "ShaderNodeVolumeCoefficients": "volume_coefficients",
    "ShaderNodeVolumePrincipled": "volume_principled",
    "ShaderNodeEmission": "emission",
}


def filled(scene, *nodes, material=None):
    """The exported material whose volume is the sum of some nodes of its tree."""
    material = material or bpy.data.materials["Material"]
    tree = material.node_tree
    total = nodes[0]
    for node in nodes[1:]:
        total = added(tree, total, node)
    link(tree, total.outputs[0], tree.nodes["Output"].inputs["Volume"])
    add_mesh(scene, material=material)
    exported = export(scene)
    assert exported.warnings == []
    return exported.materials[0]


def volumes_of(interior):
    compile_graph(interior)
    return [node for node, _ in shaders(interior)]


@pytest.mark.parametrize("bl_idname", [name for name in KINDS if hasattr(bpy.types, name)])
def test_nodes_of_volumes(scene, material, tree, bl_idname):
    """Without a surface, the material is no transparent surface either."""
    exported = filled(scene, add_node(tree, bl_idname))
    ((boundary, _),) = shaders(exported.graph)
    assert boundary.kind == "volume_boundary"
    assert [node.kind for node in volumes_of(exported.interior)] == [KINDS[bl_idname]]


def test_sockets_and_phase_functions(scene, material, tree):
    draine = {"phase": "DRAINE", "Color": OCHRE, "Density": 3.0, "Anisotropy": 0.25, "Alpha": 0.75}
    (node,) = volumes_of(filled(scene, add_node(tree, "ShaderNodeVolumeScatter", **draine)).interior)
    assert node.options["phase"] == "DRAINE"
    found = {name: node.inputs[name] for name in ("color", "density", "anisotropy", "alpha")}
    assert found == {"color": OCHRE[:3], "density": 3.0, "anisotropy": 0.25, "alpha": 0.75}


def test_a_linked_anisotropy_stays_a_link(scene, material, tree):
    double = add_node(tree, "ShaderNodeMath")
    link(tree, constant(tree, 0.2), double.inputs[0])
    scatter = add_node(tree, "ShaderNodeVolumeScatter", Anisotropy=double.outputs[0])
    (node,) = volumes_of(filled(scene, scatter).interior)
    assert isinstance(node.inputs["anisotropy"], Link)


def test_sums_and_mixtures(scene, material, tree):
    fog, fire = add_node(tree, "ShaderNodeVolumeScatter"), add_node(tree, "ShaderNodeEmission")
    haze = add_node(tree, "ShaderNodeVolumeAbsorption")
    interior = filled(scene, mixed(tree, 0.25, fog, haze), fire).interior
    weights = {node.kind: weight for node, weight in shaders(interior)}
    assert weights == pytest.approx({"volume_scatter": 0.75, "volume_absorption": 0.25, "emission": 1.0})


def test_attributes_of_a_principled_volume_are_grids(scene, material, tree):
    node = add_node(tree, "ShaderNodeVolumePrincipled")
    node.inputs["Density Attribute"].default_value = "smoke"
    node.inputs["Temperature Attribute"].default_value = ""
    interior = filled(scene, node).interior
    (volume,) = volumes_of(interior)
    grid = interior.nodes[volume.inputs["density_grid"].node]
    assert (grid.kind, grid.attribute) == ("grid_attribute", "smoke")
    assert "temperature_grid" not in volume.inputs and "color_grid" not in volume.inputs


def test_volume_info_reads_attributes_of_volumes_alone(scene, material, tree):
    info = add_node(tree, "ShaderNodeVolumeInfo")
    surface("ShaderNodeEmission", material=material, Strength=info.outputs["Density"])
    exported = filled(scene, add_node(tree, "ShaderNodeVolumeScatter", Density=info.outputs["Density"]))
    (node,) = volumes_of(exported.interior)
    density = exported.interior.nodes[node.inputs["density"].node]
    assert (density.kind, density.attribute) == ("attribute", "density")
    ((emission, _),) = shaders(exported.graph)
    assert emission.inputs["strength"] == 0.0


@pytest.mark.parametrize("bl_idname", ["ShaderNodeVolumeAbsorption", "ShaderNodeVolumePrincipled"])
def test_a_volume_is_no_surface(scene, bl_idname):
    material, _ = surface(bl_idname, "Fog")
    add_mesh(scene, material=material)
    exported = export(scene)
    assert exported.materials[0].graph.surface is None and exported.materials[0].interior is None
    (warning,) = exported.warnings
    assert 'node "Fog"' in warning and "is a volume and no surface" in warning


def test_object_info_gives_the_material_index_of_a_volume(scene, material, tree):
    material.pass_index = 7
    info = add_node(tree, "ShaderNodeObjectInfo")
    scatter = add_node(tree, "ShaderNodeVolumeScatter", Density=info.outputs["Material Index"])
    (node,) = volumes_of(filled(scene, scatter).interior)
    assert node.inputs["density"] == 7.0


@pytest.mark.parametrize("surroundings", ["a background", "no background"])
def test_the_volume_of_the_world(scene, surroundings):
    world = set_world(scene, strength=1.0)
    tree = world.node_tree
    fog = add_node(tree, "ShaderNodeVolumeScatter", "Fog", Density=0.125)
    link(tree, fog.outputs[0], tree.nodes["World Output"].inputs["Volume"])
    if surroundings == "no background":
        tree.nodes.remove(tree.nodes["Background"])
    exported = export(scene)
    assert exported.warnings == []
    (node,) = volumes_of(exported.world.volume)
    assert (node.kind, node.inputs["density"]) == ("volume_scatter", 0.125)
    assert np.any(exported.world.radiance) == (surroundings == "a background")


def test_a_world_without_a_volume_has_none(scene):
    set_world(scene, strength=1.0)
    assert export(scene).world.volume is None


def test_a_world_that_is_left_out_has_no_volume(scene):
    """Its Environment is switched off for the view layer."""
    tree = set_world(scene, strength=1.0).node_tree
    fog = add_node(tree, "ShaderNodeVolumeScatter")
    link(tree, fog.outputs[0], tree.nodes["World Output"].inputs["Volume"])
    scene.view_layers[0].use_sky = False
    assert export(scene).world.volume is None


def test_a_volume_in_a_group(scene):
    group = bpy.data.node_groups.new("Fog", "ShaderNodeTree")
    group.interface.new_socket("Volume", in_out="OUTPUT", socket_type="NodeSocketShader")
    result = group.nodes.new("NodeGroupOutput")
    link(group, add_node(group, "ShaderNodeVolumeScatter", Density=0.5).outputs[0], result.inputs[0])
    material = new_material("Grouped")
    node = add_node(material.node_tree, "ShaderNodeGroup", node_tree=group)
    (volume,) = volumes_of(filled(scene, node, material=material).interior)
    assert (volume.kind, volume.inputs["density"]) == ("volume_scatter", 0.5)

# SPDX-License-Identifier: GPL-3.0-or-later
"""All nodes of Blender: which are rendered, and what is said of those that are not."""

import bpy
import numpy as np
import pytest
from blender_scenes import export_graph
from node_trees import add_node, constant, link, new_material, shader_nodes, surface
from single_shaders import OCHRE, single_shader

from rppm_addon.blender.export.shading.nodes.graphs import HANDLERS, kind_name, snake_case
from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.materials.nodes import KINDS

NOT_RENDERED = {
    "EEVEE_SPECULAR", "SCRIPT", "SHADERTORGB", "SQUEEZE", "CAMERA",
}  # fmt: skip
"""Node types that a neutral value stands in for."""


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="names are those of Blender 5.0")
def test_every_node_of_blender_is_known_by_its_sockets(scene):
    unknown, common = set(), set(bpy.types.ShaderNode.bl_rna.properties.keys())
    for node in shader_nodes(new_material().node_tree):
        kind = KINDS.get(kind_name(node))
        if kind is None and node.type not in HANDLERS:
            unknown.add(node.type)
        elif kind is not None and node.type not in HANDLERS:
            sockets = {snake_case(socket.identifier) for socket in node.inputs}
            sockets |= set(node.bl_rna.properties.keys()) - common
            assert kind.inputs.keys() <= sockets, node.bl_idname
            assert {snake_case(socket.identifier) for socket in node.outputs} <= kind.outputs.keys(), node.bl_idname
            for name in kind.options:
                assert hasattr(node, name), (node.bl_idname, name)
    assert unknown <= NOT_RENDERED


@pytest.mark.parametrize("output", range(8))
def test_every_node_compiles_as_it_is_added(scene, material, tree, output):
    """Each output of each node, shown as a color: whatever is not rendered is named, and nothing else."""
    for node in shader_nodes(tree):
        if output >= len(node.outputs):
            continue
        tree.links.clear()
        node.name = "Shown"
        link(tree, node.outputs[output], tree.nodes["Output"].inputs["Surface"])
        graph, warnings = export_graph(scene, material)
        bpy.data.objects.remove(bpy.data.objects["Mesh"])
        compile_graph(graph)
        assert all('Material "Material": node "Shown"' in text for text in warnings), warnings
        assert not any("cannot be read" in text for text in warnings), warnings
        if node.type in NOT_RENDERED - {"CAMERA"}:
            assert warnings, node.bl_idname
        node.name = node.bl_idname


@pytest.mark.parametrize(
    ("node", "color", "told"),
    [("ShaderNodeBsdfToon", 0.8, "diffuse"), ("ShaderNodeEeveeSpecular", 0.0, "black, as in Cycles")],
)
def test_unknown_shaders_become_diffuse(scene, monkeypatch, node, color, told):
    """The first stands for a node of a newer version of Blender, of which there is no kind."""
    monkeypatch.delitem(KINDS, "bsdf_toon")
    material, _ = surface(node, "Odd")
    shader, warnings = single_shader(scene, material)
    assert shader.kind == "bsdf_diffuse"
    np.testing.assert_allclose(np.ravel(shader.inputs["color"])[:1], color, rtol=1e-6)
    assert any('Material "Material": node "Odd"' in text and told in text for text in warnings)


@pytest.mark.parametrize(
    ("node", "options", "inputs", "standing_in"),
    [
        ("ShaderNodeBsdfToon", {"component": "GLOSSY"}, {}, ""),
        ("ShaderNodeBsdfHair", {"component": "Transmission"}, {}, ""),
        ("ShaderNodeBsdfHairPrincipled", {"model": "HUANG"}, {}, ""),
        ("ShaderNodeSubsurfaceScattering", {}, {}, ""),
        ("ShaderNodeSubsurfaceScattering", {"falloff": "BURLEY"}, {}, "a random walk"),
        ("ShaderNodeBsdfAnisotropic", {"distribution": "ASHIKHMIN_SHIRLEY"}, {}, ""),
        ("ShaderNodeBsdfAnisotropic", {"distribution": "BECKMANN"}, {}, ""),
        ("ShaderNodeBsdfPrincipled", {}, {"Subsurface Weight": 0.3}, ""),
        ("ShaderNodeBsdfPrincipled", {"subsurface_method": "BURLEY"}, {"Subsurface Weight": 0.3}, "a random walk"),
        ("ShaderNodeBsdfPrincipled", {"subsurface_method": "BURLEY"}, {}, ""),
        ("ShaderNodeBsdfPrincipled", {}, {}, ""),
    ],
)
def test_each_fallback_is_named(scene, node, options, inputs, standing_in):
    material, shader = surface(node, "Odd", **options)
    for name, value in inputs.items():
        shader.inputs[name].default_value = value
    _, warnings = single_shader(scene, material)
    assert len(warnings) == bool(standing_in)
    assert all(f'Material "Material": node "Odd" ({shader.bl_label})' in text for text in warnings)
    assert all(standing_in in text and text.endswith("stands in") for text in warnings)


@pytest.mark.parametrize(
    ("node", "name"), [("ShaderNodeSubsurfaceScattering", "falloff"), ("ShaderNodeBsdfPrincipled", "subsurface_method")]
)
def test_older_versions_random_walk_is_the_legacy_of_later_ones(scene, node, name):
    material, shader = surface(node)
    exported, _ = single_shader(scene, material)
    has_legacy = "RANDOM_WALK_LEGACY" in shader.bl_rna.properties[name].enum_items
    assert exported.options[name] == ("RANDOM_WALK" if has_legacy else "RANDOM_WALK_LEGACY")
    if has_legacy:  # which files of older versions have
        setattr(shader, name, "RANDOM_WALK_LEGACY")
        assert single_shader(scene, material)[0].options[name] == "RANDOM_WALK_LEGACY"


def test_an_unknown_value_leaves_that_of_the_socket(scene):
    material, diffuse = surface("ShaderNodeBsdfDiffuse", Color=OCHRE)
    link(
        material.node_tree,
        add_node(material.node_tree, "ShaderNodeShaderToRGB", "Strange").outputs[0],
        diffuse.inputs["Color"],
    )
    shader, warnings = single_shader(scene, material)
    assert shader.inputs["color"] == OCHRE[:3]
    assert any('Material "Material": node "Strange" (Shader to RGB)' in text for text in warnings)


def test_a_color_as_a_surface_glows(scene, material, tree):
    link(tree, constant(tree, OCHRE, "ShaderNodeRGB"), tree.nodes["Output"].inputs["Surface"])
    shader, _ = single_shader(scene, material)
    assert shader.kind == "emission" and shader.inputs["color"] == OCHRE[:3]

# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees to node graphs."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, export, export_graph
from node_trees import add_node, added, constant, link, mixed, node_group, shaders, source, surface, to_surface
from single_shaders import OCHRE, RED, single_shader

from rppm_addon.blender.export.shading.nodes.graphs import snake_case
from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.scene import Link

SIMPLE = [
    ("ShaderNodeBsdfDiffuse", "bsdf_diffuse", {}),
    ("ShaderNodeBsdfAnisotropic", "bsdf_glossy", {"Roughness": 0.3}),
    ("ShaderNodeBsdfGlass", "bsdf_glass", {"Roughness": 0.1, "IOR": 1.33}),
    ("ShaderNodeBsdfRefraction", "bsdf_refraction", {"Roughness": 0.2, "IOR": 1.7}),
    ("ShaderNodeBsdfTransparent", "bsdf_transparent", {}),
    ("ShaderNodeBsdfTranslucent", "bsdf_translucent", {}),
    ("ShaderNodeEmission", "emission", {"Strength": 4.0}),
]


@pytest.mark.parametrize(("node", "kind", "values"), SIMPLE)
def test_simple_shaders(scene, node, kind, values):
    shader, warnings = single_shader(scene, surface(node, "Mine", Color=OCHRE, **values)[0])
    assert shader.kind == kind and shader.name == "Mine" and shader.inputs["color"] == OCHRE[:3]
    for name, value in values.items():
        assert shader.inputs[name.lower()] == pytest.approx(value)
    assert warnings == []


@pytest.mark.parametrize("node", ["ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfGlass", "ShaderNodeBsdfPrincipled"])
@pytest.mark.parametrize("distribution", ["GGX", "MULTI_GGX"])
def test_multiscatter(scene, node, distribution):
    material, _ = surface(node, distribution=distribution)
    assert single_shader(scene, material)[0].options["distribution"] == distribution


def test_principled(scene):
    material, node = surface("ShaderNodeBsdfPrincipled")
    values = {
        "Base Color": OCHRE, "Metallic": 0.25, "Roughness": 0.75, "IOR": 1.25, "Alpha": 0.5,
        "Specular IOR Level": 0.875, "Specular Tint": (0.5, 1.0, 0.25, 1.0), "Transmission Weight": 0.125,
        "Emission Color": RED, "Emission Strength": 3.0,
    }  # fmt: skip
    for name, value in values.items():
        node.inputs[name].default_value = value
    shader, warnings = single_shader(scene, material)
    assert shader.kind == "bsdf_principled" and warnings == []
    for name, value in values.items():
        expected = value[:3] if isinstance(value, tuple) else value
        assert shader.inputs[snake_case(name)] == pytest.approx(expected), name


def test_the_abbe_number_is_that_of_the_panel(scene):
    material, _ = surface("ShaderNodeBsdfGlass")
    material.rppm.abbe_number = 30.0
    add_mesh(scene, material=material)
    assert [exported.abbe_number for exported in export(scene).materials] == [None]
    material.rppm.use_dispersion = True
    assert [exported.abbe_number for exported in export(scene).materials] == [30.0]


def test_nested_mix_and_add(scene, material, tree):
    diffuse, glossy = add_node(tree, "ShaderNodeBsdfDiffuse"), add_node(tree, "ShaderNodeBsdfAnisotropic")
    glass, glow = add_node(tree, "ShaderNodeBsdfGlass"), add_node(tree, "ShaderNodeEmission")
    inner = mixed(tree, 0.25, diffuse, glossy)
    to_surface(material, mixed(tree, 0.5, added(tree, inner, glow), glass))
    graph, warnings = export_graph(scene, material)
    expected = [("bsdf_diffuse", 0.375), ("bsdf_glossy", 0.125), ("emission", 0.5), ("bsdf_glass", 0.5)]
    assert [(node.kind, weight) for node, weight in shaders(graph)] == expected and warnings == []


def test_unlinked_mix_side_is_black(scene, material, tree):
    mix = add_node(tree, "ShaderNodeMixShader")
    mix.inputs[0].default_value = 0.25
    link(tree, add_node(tree, "ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    to_surface(material, mix)
    graph, warnings = export_graph(scene, material)
    assert [(node.kind, weight) for node, weight in shaders(graph)] == [("bsdf_diffuse", 0.25)] and warnings == []


def test_a_fresnel_node_decides_a_mix(scene, material, tree):
    mix = mixed(tree, 0.5, add_node(tree, "ShaderNodeBsdfRefraction"), add_node(tree, "ShaderNodeBsdfAnisotropic"))
    link(tree, add_node(tree, "ShaderNodeFresnel", IOR=1.4).outputs[0], mix.inputs[0])
    to_surface(material, mix)
    graph, warnings = export_graph(scene, material)
    top = graph.nodes[graph.surface.node]
    assert source(graph, top, "fac").kind == "fresnel" and warnings == []
    assert source(graph, top, "fac").inputs["ior"] == pytest.approx(1.4)


def tinted_group():
    group, inside, outside = node_group([("Tint", "Color"), ("Rough", "Float")], [("Shader", "Shader")])
    reroute = group.nodes.new("NodeReroute")
    link(group, inside.outputs["Tint"], reroute.inputs[0])
    glossy = add_node(group, "ShaderNodeBsdfAnisotropic", Color=reroute.outputs[0], Roughness=inside.outputs["Rough"])
    link(group, glossy.outputs[0], outside.inputs[0])
    return group


def test_groups_reroutes_and_muted_nodes(scene, material, tree):
    outer, outer_in, outer_out = node_group([("Tint", "Color")], [("Shader", "Shader")])
    tint = outer_in.outputs["Tint"]
    nested = add_node(outer, "ShaderNodeGroup", node_tree=tinted_group(), Rough=0.625, Tint=tint)
    link(outer, nested.outputs[0], outer_out.inputs[0])
    ochre = constant(tree, OCHRE, "ShaderNodeRGB")
    gamma = add_node(tree, "ShaderNodeGamma", mute=True, Gamma=5.0, Color=ochre)
    to_surface(material, add_node(tree, "ShaderNodeGroup", node_tree=outer, Tint=gamma.outputs[0]))
    shader, warnings = single_shader(scene, material)
    assert shader.kind == "bsdf_glossy" and shader.inputs["color"] == OCHRE[:3]
    assert shader.inputs["roughness"] == 0.625 and warnings == []


def test_a_group_that_is_used_twice_gives_each_use_its_inputs(scene, material, tree):
    group = tinted_group()
    uses = (add_node(tree, "ShaderNodeGroup", node_tree=group, Tint=color) for color in (RED, OCHRE))
    to_surface(material, added(tree, *uses))
    graph, _ = export_graph(scene, material)
    assert [node.inputs["color"] for node, _ in shaders(graph)] == [RED[:3], OCHRE[:3]]


@pytest.mark.parametrize(("kind", "name"), [("ShaderNodeTexNoise", "Vector"), ("ShaderNodeFresnel", "Normal")])
@pytest.mark.parametrize("hidden", [False, True])
def test_the_value_of_a_group_feeds_inputs_that_are_the_surface_own_without(scene, kind, name, hidden):
    """As in Cycles; normals only where the group shows its value."""
    group, inside, outside = node_group([("Place", "Vector")], [("Value", "Float")])
    group.interface.items_tree["Place"].hide_value = hidden
    link(group, add_node(group, kind, **{name: inside.outputs[0]}).outputs[0], outside.inputs[0])
    material, diffuse = surface("ShaderNodeBsdfDiffuse")
    used = add_node(material.node_tree, "ShaderNodeGroup", node_tree=group, Place=(0.25, 0.5, 0.75))
    link(material.node_tree, used.outputs[0], diffuse.inputs["Roughness"])
    graph, _ = export_graph(scene, material)
    ((shader, _),) = shaders(graph)
    inputs = source(graph, shader, "roughness").inputs
    if name == "Normal" and hidden:
        assert "normal" not in inputs
    else:
        assert inputs[name.lower()] == (0.25, 0.5, 0.75)


def test_value_nodes_stay_nodes(scene, material, tree):
    half = add_node(tree, "ShaderNodeMath", "Half", operation="MULTIPLY", use_clamp=True, Value=constant(tree, 0.5))
    half.inputs[1].default_value = 0.25
    combined = add_node(tree, "ShaderNodeCombineColor", Red=1.0, Blue=0.125, Green=half.outputs[0])
    surface("ShaderNodeBsdfDiffuse", material=material, Color=combined.outputs[0])
    graph, warnings = export_graph(scene, material)
    ((shader, _),) = shaders(graph)
    combine = source(graph, shader, "color")
    math = source(graph, combine, "green")
    assert (combine.kind, combine.inputs["red"], combine.inputs["blue"]) == ("combine_color", 1.0, 0.125)
    assert (math.kind, math.name, math.inputs["value"], math.inputs["value_001"]) == ("math", "Half", 0.5, 0.25)
    assert math.options == {"operation": "MULTIPLY", "use_clamp": True} and warnings == []


@pytest.mark.parametrize("blend", ["MIX", "MULTIPLY", "ADD"])
def test_mixed_colors(scene, blend):
    material, diffuse = surface("ShaderNodeBsdfDiffuse")
    mix = add_node(material.node_tree, "ShaderNodeMix", data_type="RGBA", blend_type=blend)
    sockets = {socket.name: socket for socket in mix.inputs if socket.enabled}
    next(sockets[name] for name in ("Factor", "Fac") if name in sockets).default_value = 0.5
    sockets["A"].default_value, sockets["B"].default_value = (0.5, 0.25, 0.125, 1.0), (0.25, 0.5, 0.75, 1.0)
    link(material.node_tree, next(socket for socket in mix.outputs if socket.enabled), diffuse.inputs["Color"])
    graph, warnings = export_graph(scene, material)
    ((shader, _),) = shaders(graph)
    node = source(graph, shader, "color")
    assert node.kind == "mix_color" and node.options["blend_type"] == blend and warnings == []
    assert node.inputs == {"factor_float": 0.5, "a_color": (0.5, 0.25, 0.125), "b_color": (0.25, 0.5, 0.75)}


def test_one_node_serves_all_of_its_outputs(scene):
    material, principled = surface("ShaderNodeBsdfPrincipled")
    tree = material.node_tree
    noise = add_node(tree, "ShaderNodeTexNoise")
    ramp = add_node(tree, "ShaderNodeValToRGB")
    link(tree, noise.outputs[0], ramp.inputs[0])
    link(tree, noise.outputs["Color"], principled.inputs["Emission Color"])
    link(tree, ramp.outputs["Color"], principled.inputs["Base Color"])
    link(tree, ramp.outputs["Alpha"], principled.inputs["Alpha"])
    graph, _ = export_graph(scene, material)
    kinds = [node.kind for node in graph.nodes]
    assert kinds.count("val_to_rgb") == kinds.count("tex_noise") == 1


def test_chains_of_five_hundred_nodes(scene):
    """Each node adds one half: neither the export nor the compiler may run out of stack."""
    material, emission = surface("ShaderNodeEmission")
    tree = material.node_tree
    last = constant(tree, 0.5)
    for _ in range(500):
        last = add_node(tree, "ShaderNodeMath", Value=last).outputs[0]
    link(tree, last, emission.inputs["Strength"])
    graph, warnings = export_graph(scene, material)
    assert sum(node.kind == "math" for node in graph.nodes) == 500 and warnings == []
    text = compile_graph(graph).text
    assert text.count("node_math_add(") == 500 and len(text) < 100_000


def test_chains_of_five_hundred_shaders(scene, material, tree):
    last = add_node(tree, "ShaderNodeBsdfDiffuse")
    for _ in range(250):
        last = added(tree, mixed(tree, 0.5, last, last), add_node(tree, "ShaderNodeEmission"))
    to_surface(material, last)
    graph, warnings = export_graph(scene, material)
    assert warnings == []
    text = compile_graph(graph).text
    assert text.count("node_emission(") == 250 and text.count("node_bsdf_diffuse(") == 1 and len(text) < 100_000


def test_constants_are_what_the_sliders_say(scene):
    """The same program with other constants: what a slider changes."""
    material, principled = surface("ShaderNodeBsdfPrincipled")
    first, _ = export_graph(scene, material)
    bpy.data.objects.remove(bpy.data.objects["Mesh"])
    principled.inputs["Roughness"].default_value = 0.125
    principled.inputs["Base Color"].default_value = OCHRE
    second, _ = export_graph(scene, material)
    first, second = compile_graph(first), compile_graph(second)
    assert first.text == second.text
    changed = np.not_equal(first.constants, second.constants)
    assert changed.sum() == 4 and {0.5, 0.25, 0.125} <= set(np.array(second.constants)[changed])


def test_links_are_to_earlier_nodes(scene, material, tree):
    noise = add_node(tree, "ShaderNodeTexNoise")
    ramp = add_node(tree, "ShaderNodeValToRGB")
    link(tree, noise.outputs[0], ramp.inputs[0])
    surface("ShaderNodeBsdfDiffuse", material=material, Color=ramp.outputs[0])
    graph, _ = export_graph(scene, material)
    for index, node in enumerate(graph.nodes):
        assert all(value.node < index for value in node.inputs.values() if isinstance(value, Link))


def test_rotations_are_attributes_of_four_numbers(scene, material, tree):
    """As geometry nodes store them: W, X, Y, Z, of which Cycles takes the first three for a color."""
    attribute = add_node(tree, "ShaderNodeAttribute", attribute_name="turn")
    surface("ShaderNodeEmission", material=material, Color=attribute.outputs["Color"])
    quad = add_mesh(scene, material=material)
    given = np.linspace(-1.0, 1.0, 16, dtype=np.float32).reshape(4, 4)
    quad.data.attributes.new("turn", "QUATERNION", "POINT").data.foreach_set("value", given.reshape(-1))
    exported = export(scene)
    assert exported.warnings == []
    np.testing.assert_array_equal(exported.meshes[0].attributes["turn"].values, given)

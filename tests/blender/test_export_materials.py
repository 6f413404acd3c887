# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees to weighted lobes, and what is said about nodes that are not rendered."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, add_node, export, export_lobes, link, new_material, to_surface

from rppm_addon.blender.export.constants import blackbody, mean_fresnel

RED = (1.0, 0.0, 0.0, 1.0)
OCHRE = (0.5, 0.25, 0.125, 1.0)


def surface(kind, name=None, material=None, **inputs):
    """A material whose surface is one node."""
    material = material or new_material()
    node = add_node(material.node_tree, kind, name, **inputs)
    to_surface(material, node)
    return material, node


def single_lobe(scene, material):
    (lobe,), warnings = export_lobes(scene, material)
    return lobe, warnings


SIMPLE = [
    ("ShaderNodeBsdfDiffuse", LobeKind.DIFFUSE, {}),
    ("ShaderNodeBsdfAnisotropic", LobeKind.GLOSSY, {"Roughness": 0.3}),
    ("ShaderNodeBsdfGlass", LobeKind.GLASS, {"Roughness": 0.1, "IOR": 1.33}),
    ("ShaderNodeBsdfRefraction", LobeKind.REFRACTION, {"Roughness": 0.2, "IOR": 1.7}),
    ("ShaderNodeBsdfTransparent", LobeKind.TRANSPARENT, {}),
]


@pytest.mark.parametrize(("node", "kind", "values"), SIMPLE)
def test_simple_shaders(scene, node, kind, values):
    lobe, warnings = single_lobe(scene, surface(node, Color=OCHRE, **values)[0])
    assert lobe.kind is kind and lobe.weight == 1.0 and lobe.color == OCHRE[:3] and lobe.color_image == -1
    if "Roughness" in values:
        assert lobe.roughness == pytest.approx(values["Roughness"])
    if "IOR" in values:
        assert lobe.ior == pytest.approx(values["IOR"])
    assert warnings == []


@pytest.mark.parametrize("node", ["ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfGlass", "ShaderNodeBsdfPrincipled"])
@pytest.mark.parametrize("distribution", ["GGX", "MULTI_GGX"])
def test_multiscatter(scene, node, distribution):
    material, shader = surface(node)
    shader.distribution = distribution
    lobe, _ = single_lobe(scene, material)
    assert lobe.multiscatter == (distribution == "MULTI_GGX")


def test_emission(scene):
    lobe, _ = single_lobe(scene, surface("ShaderNodeEmission", Color=OCHRE, Strength=4.0)[0])
    assert lobe.kind is LobeKind.EMISSION and lobe.color == (2.0, 1.0, 0.5)


def test_emission_without_strength_is_nothing(scene):
    lobes, _ = export_lobes(scene, surface("ShaderNodeEmission", Strength=0.0)[0])
    assert lobes == []


def test_principled(scene):
    material, node = surface("ShaderNodeBsdfPrincipled")
    values = {
        "Base Color": OCHRE,
        "Metallic": 0.25,
        "Roughness": 0.75,
        "IOR": 1.25,
        "Alpha": 0.5,
        "Specular IOR Level": 0.875,
        "Specular Tint": (0.5, 1.0, 0.25, 1.0),
        "Transmission Weight": 0.125,
        "Emission Color": RED,
        "Emission Strength": 3.0,
    }
    for name, value in values.items():
        node.inputs[name].default_value = value
    lobe, warnings = single_lobe(scene, material)
    assert lobe.kind is LobeKind.PRINCIPLED and lobe.color == OCHRE[:3]
    assert (lobe.metallic, lobe.roughness, lobe.ior, lobe.alpha) == (0.25, 0.75, 1.25, 0.5)
    assert (lobe.specular_level, lobe.specular_tint, lobe.transmission) == (0.875, (0.5, 1.0, 0.25), 0.125)
    assert lobe.emission == (3.0, 0.0, 0.0) and warnings == []


def test_a_new_principled_node_has_no_emission_and_no_warning(scene):
    lobe, warnings = single_lobe(scene, surface("ShaderNodeBsdfPrincipled")[0])
    assert lobe.emission == (0.0, 0.0, 0.0) and lobe.alpha == 1.0 and warnings == []


def test_unrendered_parts_of_principled_are_named(scene):
    material, node = surface("ShaderNodeBsdfPrincipled", "Skin")
    node.inputs["Subsurface Weight"].default_value = 0.5
    node.inputs["Coat Weight"].default_value = 0.5
    _, warnings = single_lobe(scene, material)
    assert any(
        'Material "Material": node "Skin" (BSDF_PRINCIPLED) has "Subsurface Weight"' in text for text in warnings
    )
    assert any('"Coat Weight"' in text for text in warnings)


def mixed(material, factor, first, second, kind="ShaderNodeMixShader"):
    mix = add_node(material.node_tree, kind)
    offset = 0
    if kind == "ShaderNodeMixShader":
        mix.inputs[0].default_value = factor
        offset = 1
    link(material.node_tree, first.outputs[0], mix.inputs[offset])
    link(material.node_tree, second.outputs[0], mix.inputs[offset + 1])
    return mix


def test_nested_mix_and_add(scene):
    material = new_material()
    tree = material.node_tree
    diffuse, glossy = add_node(tree, "ShaderNodeBsdfDiffuse"), add_node(tree, "ShaderNodeBsdfAnisotropic")
    glass, glow = add_node(tree, "ShaderNodeBsdfGlass"), add_node(tree, "ShaderNodeEmission")
    inner = mixed(material, 0.25, diffuse, glossy)
    added = mixed(material, None, inner, glow, "ShaderNodeAddShader")
    to_surface(material, mixed(material, 0.5, added, glass))
    lobes, warnings = export_lobes(scene, material)
    assert [(lobe.kind.name, lobe.weight) for lobe in lobes] == [
        ("DIFFUSE", 0.375),
        ("GLOSSY", 0.125),
        ("EMISSION", 0.5),
        ("GLASS", 0.5),
    ]
    assert warnings == []


def test_unlinked_mix_side_is_black(scene):
    material = new_material()
    mix = add_node(material.node_tree, "ShaderNodeMixShader")
    mix.inputs[0].default_value = 0.25
    link(material.node_tree, add_node(material.node_tree, "ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    to_surface(material, mix)
    lobe, _ = single_lobe(scene, material)
    assert lobe.kind is LobeKind.DIFFUSE and lobe.weight == 0.25


def test_fresnel_mix_of_refraction_and_glossy_is_glass(scene):
    material = new_material()
    tree = material.node_tree
    value = add_node(tree, "ShaderNodeValue")
    value.outputs[0].default_value = 1.4
    fresnel = add_node(tree, "ShaderNodeFresnel")
    refraction = add_node(tree, "ShaderNodeBsdfRefraction", Color=OCHRE, Roughness=0.0)
    glossy = add_node(tree, "ShaderNodeBsdfAnisotropic", Color=OCHRE, Roughness=0.0)
    link(tree, value.outputs[0], fresnel.inputs["IOR"])
    link(tree, value.outputs[0], refraction.inputs["IOR"])
    mix = mixed(material, 0.5, refraction, glossy)
    link(tree, fresnel.outputs[0], mix.inputs[0])
    to_surface(material, mix)
    lobe, warnings = single_lobe(scene, material)
    assert lobe.kind is LobeKind.GLASS and lobe.ior == pytest.approx(1.4) and lobe.color == OCHRE[:3]
    assert lobe.weight == 1.0 and warnings == []
    glossy.inputs["Color"].default_value = RED
    bpy.data.objects.remove(bpy.data.objects["Mesh"])
    lobes, warnings = export_lobes(scene, material)
    assert [lobe.kind.name for lobe in lobes] == ["REFRACTION", "GLOSSY"]
    assert lobes[1].weight == pytest.approx(mean_fresnel(1.4)) and any("FRESNEL" in text for text in warnings)


def test_groups_reroutes_and_muted_nodes(scene):
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    group.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Rough", in_out="INPUT", socket_type="NodeSocketFloat")
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    inside, outside = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    glossy = add_node(group, "ShaderNodeBsdfAnisotropic")
    reroute = group.nodes.new("NodeReroute")
    group.links.new(inside.outputs["Tint"], reroute.inputs[0])
    group.links.new(reroute.outputs[0], glossy.inputs["Color"])
    group.links.new(inside.outputs["Rough"], glossy.inputs["Roughness"])
    group.links.new(glossy.outputs[0], outside.inputs[0])

    outer = bpy.data.node_groups.new("Outer", "ShaderNodeTree")
    outer.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    outer.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    outer_in, outer_out = outer.nodes.new("NodeGroupInput"), outer.nodes.new("NodeGroupOutput")
    nested = outer.nodes.new("ShaderNodeGroup")
    nested.node_tree = group
    nested.inputs["Rough"].default_value = 0.625
    outer.links.new(outer_in.outputs["Tint"], nested.inputs["Tint"])
    outer.links.new(nested.outputs[0], outer_out.inputs[0])

    material = new_material()
    tree = material.node_tree
    used = tree.nodes.new("ShaderNodeGroup")
    used.node_tree = outer
    rgb = add_node(tree, "ShaderNodeRGB")
    rgb.outputs[0].default_value = OCHRE
    gamma = add_node(tree, "ShaderNodeGamma", Gamma=5.0)
    gamma.mute = True
    link(tree, rgb.outputs[0], gamma.inputs["Color"])
    link(tree, gamma.outputs[0], used.inputs["Tint"])
    to_surface(material, used)
    lobe, warnings = single_lobe(scene, material)
    assert lobe.kind is LobeKind.GLOSSY and lobe.color == OCHRE[:3] and lobe.roughness == 0.625
    assert warnings == []


def test_constant_nodes_are_evaluated(scene):
    material, diffuse = surface("ShaderNodeBsdfDiffuse")
    tree = material.node_tree
    value = add_node(tree, "ShaderNodeValue")
    value.outputs[0].default_value = 0.5
    half = add_node(tree, "ShaderNodeMath")
    half.operation = "MULTIPLY"
    half.inputs[1].default_value = 0.5
    link(tree, value.outputs[0], half.inputs[0])
    combined = add_node(tree, "ShaderNodeCombineColor", Red=1.0, Blue=0.125)
    link(tree, half.outputs[0], combined.inputs["Green"])
    link(tree, combined.outputs[0], diffuse.inputs["Color"])
    lobe, warnings = single_lobe(scene, material)
    assert lobe.color == (1.0, 0.25, 0.125) and warnings == []


@pytest.mark.parametrize(
    ("blend", "expected"),
    [("MIX", (0.4, 0.3, 0.5)), ("MULTIPLY", (0.32, 0.28, 0.1)), ("ADD", (0.8, 0.5, 0.6))],
)
def test_mixed_colors(scene, blend, expected):
    material, diffuse = surface("ShaderNodeBsdfDiffuse")
    mix = add_node(material.node_tree, "ShaderNodeMix")
    mix.data_type, mix.blend_type = "RGBA", blend
    sockets = {socket.name: socket for socket in mix.inputs if socket.enabled}
    next(sockets[name] for name in ("Factor", "Fac") if name in sockets).default_value = 0.5
    sockets["A"].default_value = (0.4, 0.4, 0.2, 1.0)
    sockets["B"].default_value = (0.4, 0.2, 0.8, 1.0) if blend == "MIX" else (0.6, 0.4, 0.0, 1.0)
    if blend == "ADD":
        sockets["A"].default_value, sockets["B"].default_value = (0.5, 0.3, 0.2, 1.0), (0.6, 0.4, 0.8, 1.0)
    link(material.node_tree, next(socket for socket in mix.outputs if socket.enabled), diffuse.inputs["Color"])
    lobe, warnings = single_lobe(scene, material)
    np.testing.assert_allclose(lobe.color, expected, atol=1e-6)
    assert warnings == []


UNKNOWN = [
    ("ShaderNodeTexNoise", "TEX_NOISE"),
    ("ShaderNodeTexCoord", "TEX_COORD"),
    ("ShaderNodeVertexColor", "VERTEX_COLOR"),
    ("ShaderNodeAttribute", "ATTRIBUTE"),
    ("ShaderNodeObjectInfo", "OBJECT_INFO"),
    ("ShaderNodeTexChecker", "TEX_CHECKER"),
]


@pytest.mark.parametrize(("node", "type_name"), UNKNOWN)
def test_unknown_nodes_are_named_and_stop_nothing(scene, node, type_name):
    material, diffuse = surface("ShaderNodeBsdfDiffuse", Color=OCHRE)
    unknown = add_node(material.node_tree, node, "Strange")
    link(material.node_tree, unknown.outputs[0], diffuse.inputs["Color"])
    lobe, warnings = single_lobe(scene, material)
    assert all(0.0 <= channel <= 1.0 for channel in lobe.color)
    assert any(f'Material "Material": node "Strange" ({type_name})' in text for text in warnings)


def test_unknown_mix_factor_takes_the_value_of_its_socket(scene):
    material = new_material()
    tree = material.node_tree
    mix = mixed(material, 0.25, add_node(tree, "ShaderNodeBsdfDiffuse"), add_node(tree, "ShaderNodeBsdfGlass"))
    link(tree, add_node(tree, "ShaderNodeObjectInfo", "Info").outputs["Random"], mix.inputs[0])
    to_surface(material, mix)
    lobes, warnings = export_lobes(scene, material)
    assert [lobe.weight for lobe in lobes] == [0.75, 0.25]
    assert any('node "Info" (OBJECT_INFO)' in text for text in warnings)


def test_camera_rays_decide_a_light_path_mix(scene):
    material = new_material()
    tree = material.node_tree
    mix = mixed(material, 0.5, add_node(tree, "ShaderNodeBsdfDiffuse"), add_node(tree, "ShaderNodeBsdfGlass"))
    path = add_node(tree, "ShaderNodeLightPath")
    link(tree, path.outputs["Is Shadow Ray"], mix.inputs[0])
    to_surface(material, mix)
    lobe, warnings = single_lobe(scene, material)
    assert lobe.kind is LobeKind.DIFFUSE and any("LIGHT_PATH" in text for text in warnings)


@pytest.mark.parametrize(
    "node", ["ShaderNodeBsdfTranslucent", "ShaderNodeSubsurfaceScattering", "ShaderNodeBsdfSheen", "ShaderNodeBsdfToon"]
)
def test_unknown_shaders_become_diffuse(scene, node):
    lobe, warnings = single_lobe(scene, surface(node, "Odd", Color=OCHRE)[0])
    assert lobe.kind is LobeKind.DIFFUSE and lobe.color == OCHRE[:3]
    assert any('node "Odd"' in text and "diffuse" in text for text in warnings)


def test_a_color_as_a_surface_glows(scene):
    material = new_material()
    rgb = add_node(material.node_tree, "ShaderNodeRGB")
    rgb.outputs[0].default_value = OCHRE
    to_surface(material, rgb)
    lobe, _ = single_lobe(scene, material)
    assert lobe.kind is LobeKind.EMISSION and lobe.color == OCHRE[:3]


def test_volume_absorption(scene):
    material, _ = surface("ShaderNodeBsdfGlass")
    absorption = add_node(material.node_tree, "ShaderNodeVolumeAbsorption", Color=OCHRE, Density=4.0)
    link(material.node_tree, absorption.outputs[0], material.node_tree.nodes["Output"].inputs["Volume"])
    add_mesh(scene).data.materials.append(material)
    exported = export(scene)
    np.testing.assert_allclose(exported.materials[0].absorption, (2.0, 3.0, 3.5))
    assert exported.warnings == []


def test_volume_alone_lets_light_in(scene):
    material = new_material()
    absorption = add_node(material.node_tree, "ShaderNodeVolumeAbsorption", Density=1.0)
    scatter = add_node(material.node_tree, "ShaderNodeVolumeScatter", "Fog")
    both = add_node(material.node_tree, "ShaderNodeAddShader")
    link(material.node_tree, absorption.outputs[0], both.inputs[0])
    link(material.node_tree, scatter.outputs[0], both.inputs[1])
    link(material.node_tree, both.outputs[0], material.node_tree.nodes["Output"].inputs["Volume"])
    lobe, warnings = single_lobe(scene, material)
    assert lobe.kind is LobeKind.TRANSPARENT and any('"Fog" (VOLUME_SCATTER)' in text for text in warnings)


def test_displacement_and_normals_are_reported(scene):
    material, diffuse = surface("ShaderNodeBsdfDiffuse", "Bumpy")
    tree = material.node_tree
    link(tree, add_node(tree, "ShaderNodeBump").outputs[0], diffuse.inputs["Normal"])
    link(tree, add_node(tree, "ShaderNodeDisplacement").outputs[0], tree.nodes["Output"].inputs["Displacement"])
    _, warnings = single_lobe(scene, material)
    assert any("displacement" in text for text in warnings) and any('"Bumpy"' in text for text in warnings)


def test_no_surface_is_black(scene):
    lobes, warnings = export_lobes(scene, new_material())
    assert lobes == [] and warnings == []


def test_no_output_node_is_black_and_reported(scene):
    material = new_material()
    material.node_tree.nodes.clear()
    lobes, warnings = export_lobes(scene, material)
    assert lobes == [] and any("Material Output" in text for text in warnings)


def test_mean_fresnel_has_the_known_values():
    # The diffuse reflectance of a dielectric: 9.2 % at 1.5, 5.9 % for water, nothing at 1.
    assert mean_fresnel(1.0) == pytest.approx(0.0, abs=1e-9)
    assert mean_fresnel(1.5) == pytest.approx(0.0918, abs=1e-3)
    assert mean_fresnel(1.333) == pytest.approx(0.0666, abs=1e-3)


@pytest.mark.skipif(bpy.app.version < (4, 5), reason="this Blender's lights have no temperature to compare with")
@pytest.mark.parametrize("kelvin", [2000.0, 3000.0, 5000.0, 6500.0, 10000.0])
def test_blackbody_is_that_of_blenders_lights(scene, kelvin):
    light = bpy.data.lights.new("Light", "POINT")
    light.use_temperature, light.temperature = True, kelvin
    np.testing.assert_allclose(blackbody(kelvin), light.temperature_color, rtol=0.02, atol=0.03)

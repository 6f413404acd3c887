# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees to node graphs, and what is said about nodes that are not rendered."""

import bpy
import numpy as np
import pytest
from blender_scenes import (
    add_mesh,
    add_node,
    export,
    export_graph,
    link,
    new_material,
    shaders,
    source,
    to_surface,
)

from rppm_addon.blender.export.shading.nodes.graphs import HANDLERS, _own_properties, kind_name, snake_case
from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.materials.nodes import KINDS
from rppm_addon.scene import Link
from rppm_addon.scene.meshes import SMOOTH_NORMALS, UNDISPLACED

RED = (1.0, 0.0, 0.0, 1.0)
OCHRE = (0.5, 0.25, 0.125, 1.0)


def surface(kind, name=None, material=None, **inputs):
    """A material whose surface is one node."""
    material = material or new_material()
    node = add_node(material.node_tree, kind, name, **inputs)
    to_surface(material, node)
    return material, node


def single_shader(scene, material):
    graph, warnings = export_graph(scene, material)
    ((node, weight),) = shaders(graph)
    assert weight == 1.0
    return node, warnings


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
    material, shader = surface(node)
    shader.distribution = distribution
    exported, _ = single_shader(scene, material)
    assert exported.options["distribution"] == distribution


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


def test_a_new_principled_node_has_no_warning(scene):
    shader, warnings = single_shader(scene, surface("ShaderNodeBsdfPrincipled")[0])
    assert shader.inputs["emission_strength"] == 0.0 and shader.inputs["alpha"] == 1.0 and warnings == []


def mixed(material, factor, first, second, kind="ShaderNodeMixShader"):
    mix = add_node(material.node_tree, kind)
    offset = 0
    if kind == "ShaderNodeMixShader":
        mix.inputs[0].default_value = factor
        offset = 1
    link(material.node_tree, first.outputs[0], mix.inputs[offset])
    link(material.node_tree, second.outputs[0], mix.inputs[offset + 1])
    return mix


def test_the_abbe_number_is_that_of_the_panel(scene):
    material, _ = surface("ShaderNodeBsdfGlass")
    material.rppm.abbe_number = 30.0
    add_mesh(scene).data.materials.append(material)
    assert [exported.abbe_number for exported in export(scene).materials] == [None]
    material.rppm.use_dispersion = True
    assert [exported.abbe_number for exported in export(scene).materials] == [30.0]


def test_nested_mix_and_add(scene):
    material = new_material()
    tree = material.node_tree
    diffuse, glossy = add_node(tree, "ShaderNodeBsdfDiffuse"), add_node(tree, "ShaderNodeBsdfAnisotropic")
    glass, glow = add_node(tree, "ShaderNodeBsdfGlass"), add_node(tree, "ShaderNodeEmission")
    inner = mixed(material, 0.25, diffuse, glossy)
    added = mixed(material, None, inner, glow, "ShaderNodeAddShader")
    to_surface(material, mixed(material, 0.5, added, glass))
    graph, warnings = export_graph(scene, material)
    assert [(node.kind, weight) for node, weight in shaders(graph)] == [
        ("bsdf_diffuse", 0.375),
        ("bsdf_glossy", 0.125),
        ("emission", 0.5),
        ("bsdf_glass", 0.5),
    ]
    assert warnings == []


def test_unlinked_mix_side_is_black(scene):
    material = new_material()
    mix = add_node(material.node_tree, "ShaderNodeMixShader")
    mix.inputs[0].default_value = 0.25
    link(material.node_tree, add_node(material.node_tree, "ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    to_surface(material, mix)
    graph, warnings = export_graph(scene, material)
    assert [(node.kind, weight) for node, weight in shaders(graph)] == [("bsdf_diffuse", 0.25)] and warnings == []


def test_a_fresnel_node_decides_a_mix(scene):
    material = new_material()
    tree = material.node_tree
    fresnel = add_node(tree, "ShaderNodeFresnel", IOR=1.4)
    mix = mixed(material, 0.5, add_node(tree, "ShaderNodeBsdfRefraction"), add_node(tree, "ShaderNodeBsdfAnisotropic"))
    link(tree, fresnel.outputs[0], mix.inputs[0])
    to_surface(material, mix)
    graph, warnings = export_graph(scene, material)
    top = graph.nodes[graph.surface.node]
    assert source(graph, top, "fac").kind == "fresnel" and warnings == []
    assert source(graph, top, "fac").inputs["ior"] == pytest.approx(1.4)


def tinted_group():
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
    return group


def test_groups_reroutes_and_muted_nodes(scene):
    outer = bpy.data.node_groups.new("Outer", "ShaderNodeTree")
    outer.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    outer.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    outer_in, outer_out = outer.nodes.new("NodeGroupInput"), outer.nodes.new("NodeGroupOutput")
    nested = outer.nodes.new("ShaderNodeGroup")
    nested.node_tree = tinted_group()
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
    shader, warnings = single_shader(scene, material)
    assert shader.kind == "bsdf_glossy" and shader.inputs["color"] == OCHRE[:3]
    assert shader.inputs["roughness"] == 0.625 and warnings == []


def test_a_group_that_is_used_twice_gives_each_use_its_inputs(scene):
    material, group = new_material(), tinted_group()
    first, second = (add_node(material.node_tree, "ShaderNodeGroup") for _ in range(2))
    for used, color in ((first, RED), (second, OCHRE)):
        used.node_tree = group
        used.inputs["Tint"].default_value = color
    to_surface(material, mixed(material, None, first, second, "ShaderNodeAddShader"))
    graph, _ = export_graph(scene, material)
    assert [node.inputs["color"] for node, _ in shaders(graph)] == [RED[:3], OCHRE[:3]]


@pytest.mark.parametrize(("kind", "name", "hidden"), [
    ("ShaderNodeTexNoise", "Vector", False),
    ("ShaderNodeTexNoise", "Vector", True),
    ("ShaderNodeFresnel", "Normal", False),
    ("ShaderNodeFresnel", "Normal", True),
])  # fmt: skip
def test_the_value_of_a_group_feeds_inputs_that_are_the_surface_own_without(scene, kind, name, hidden):
    """As in Cycles; normals only where the group shows its value."""
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    group.interface.new_socket("Place", in_out="INPUT", socket_type="NodeSocketVector").hide_value = hidden
    group.interface.new_socket("Value", in_out="OUTPUT", socket_type="NodeSocketFloat")
    inside, outside = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    node = add_node(group, kind)
    link(group, inside.outputs[0], node.inputs[name])
    link(group, node.outputs[0], outside.inputs[0])
    material, diffuse = surface("ShaderNodeBsdfDiffuse")
    used = add_node(material.node_tree, "ShaderNodeGroup")
    used.node_tree = group
    used.inputs[0].default_value = (0.25, 0.5, 0.75)
    link(material.node_tree, used.outputs[0], diffuse.inputs["Roughness"])
    graph, _ = export_graph(scene, material)
    ((shader, _),) = shaders(graph)
    inputs = source(graph, shader, "roughness").inputs
    if name == "Normal" and hidden:
        assert "normal" not in inputs
    else:
        assert inputs[name.lower()] == (0.25, 0.5, 0.75)


def test_value_nodes_stay_nodes(scene):
    material, diffuse = surface("ShaderNodeBsdfDiffuse")
    tree = material.node_tree
    value = add_node(tree, "ShaderNodeValue")
    value.outputs[0].default_value = 0.5
    half = add_node(tree, "ShaderNodeMath", "Half")
    half.operation, half.use_clamp = "MULTIPLY", True
    half.inputs[1].default_value = 0.25
    link(tree, value.outputs[0], half.inputs[0])
    combined = add_node(tree, "ShaderNodeCombineColor", Red=1.0, Blue=0.125)
    link(tree, half.outputs[0], combined.inputs["Green"])
    link(tree, combined.outputs[0], diffuse.inputs["Color"])
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
    mix = add_node(material.node_tree, "ShaderNodeMix")
    mix.data_type, mix.blend_type = "RGBA", blend
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
    ramp = add_node(tree, "ShaderNodeValToRGB")
    noise = add_node(tree, "ShaderNodeTexNoise")
    link(tree, noise.outputs[0], ramp.inputs[0])
    link(tree, noise.outputs["Color"], principled.inputs["Emission Color"])
    link(tree, ramp.outputs["Color"], principled.inputs["Base Color"])
    link(tree, ramp.outputs["Alpha"], principled.inputs["Alpha"])
    graph, _ = export_graph(scene, material)
    kinds = [node.kind for node in graph.nodes]
    assert kinds.count("val_to_rgb") == kinds.count("tex_noise") == 1


NOT_RENDERED = {
    "BSDF_RAY_PORTAL", "EEVEE_SPECULAR", "SCRIPT", "SHADERTORGB", "SQUEEZE",
    "VOLUME_COEFFICIENTS", "PRINCIPLED_VOLUME", "VOLUME_SCATTER", "CAMERA",
}  # fmt: skip
"""Node types that a neutral value stands in for."""


def shader_nodes(tree):
    """A node of each type that Blender's shader editor offers, except outputs and groups."""
    for name in sorted(dir(bpy.types)):
        if name.startswith("ShaderNode") and not name.startswith(("ShaderNodeOutput", "ShaderNodeGroup")):
            try:
                yield tree.nodes.new(name)
            except RuntimeError:
                continue  # a base class


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="names are those of Blender 5.0")
def test_every_node_of_blender_is_known_by_its_sockets(scene):
    unknown = set()
    for node in shader_nodes(new_material().node_tree):
        kind = KINDS.get(kind_name(node))
        if kind is None and node.type not in HANDLERS:
            unknown.add(node.type)
        elif kind is not None and node.type not in HANDLERS:
            sockets = {snake_case(socket.identifier) for socket in node.inputs} | _own_properties(node)
            assert kind.inputs.keys() <= sockets, node.bl_idname
            assert {snake_case(socket.identifier) for socket in node.outputs} <= kind.outputs.keys(), node.bl_idname
            for name in kind.options:
                assert hasattr(node, name), (node.bl_idname, name)
    assert unknown <= NOT_RENDERED


@pytest.mark.parametrize("output", range(8))
def test_every_node_compiles_as_it_is_added(scene, output):
    """Each output of each node, shown as a color: whatever is not rendered is named, and nothing else."""
    material = new_material()
    tree = material.node_tree
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
    [("ShaderNodeBsdfRayPortal", 1.0, "diffuse"), ("ShaderNodeEeveeSpecular", 0.0, "black, as in Cycles")],
)
def test_unknown_shaders_become_diffuse(scene, node, color, told):
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
    material, shader = surface(node, "Odd", **inputs)
    for name, value in options.items():
        setattr(shader, name, value)
    _, warnings = single_shader(scene, material)
    assert len(warnings) == bool(standing_in)
    assert all(f'Material "Material": node "Odd" ({shader.type})' in text for text in warnings)
    assert all(standing_in in text and text.endswith("stands in") for text in warnings)


@pytest.mark.parametrize(
    ("node", "name"),
    [("ShaderNodeSubsurfaceScattering", "falloff"), ("ShaderNodeBsdfPrincipled", "subsurface_method")],
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
    script = add_node(material.node_tree, "ShaderNodeShaderToRGB", "Strange")
    link(material.node_tree, script.outputs[0], diffuse.inputs["Color"])
    shader, warnings = single_shader(scene, material)
    assert shader.inputs["color"] == OCHRE[:3]
    assert any('Material "Material": node "Strange" (SHADERTORGB)' in text for text in warnings)


def test_a_color_as_a_surface_glows(scene):
    material = new_material()
    rgb = add_node(material.node_tree, "ShaderNodeRGB")
    rgb.outputs[0].default_value = OCHRE
    to_surface(material, rgb)
    shader, _ = single_shader(scene, material)
    assert shader.kind == "emission" and shader.inputs["color"] == OCHRE[:3]


def with_volume(material, *kinds):
    tree = material.node_tree
    both = add_node(tree, "ShaderNodeAddShader")
    for socket, (kind, name, inputs) in zip(both.inputs, kinds, strict=False):
        link(tree, add_node(tree, kind, name, **inputs).outputs[0], socket)
    link(tree, both.outputs[0], tree.nodes["Output"].inputs["Volume"])
    return material


def test_volume_absorption(scene):
    material = with_volume(
        surface("ShaderNodeBsdfGlass")[0], ("ShaderNodeVolumeAbsorption", "Fog", {"Color": OCHRE, "Density": 4.0})
    )
    add_mesh(scene).data.materials.append(material)
    exported = export(scene)
    ((volume, weight),) = shaders(exported.materials[0].interior)
    assert (volume.kind, volume.inputs["color"], volume.inputs["density"]) == ("volume_absorption", OCHRE[:3], 4.0)
    assert weight == 1.0 and exported.warnings == []


def test_volume_alone_lets_light_in(scene):
    absorption = ("ShaderNodeVolumeAbsorption", "Absorption", {"Density": 1.0})
    material = with_volume(new_material(), absorption, ("ShaderNodeVolumeScatter", "Fog", {}))
    shader, warnings = single_shader(scene, material)
    assert shader.kind == "bsdf_transparent" and any('"Fog" (VOLUME_SCATTER)' in text for text in warnings)


def test_displacement_turns_normals_and_moves_vertices(scene):
    material, diffuse = surface("ShaderNodeBsdfDiffuse", "Bumpy")
    tree = material.node_tree
    link(tree, add_node(tree, "ShaderNodeBump").outputs[0], diffuse.inputs["Normal"])
    link(tree, add_node(tree, "ShaderNodeDisplacement").outputs[0], tree.nodes["Output"].inputs["Displacement"])
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
    tree = material.node_tree
    color = add_node(tree, "ShaderNodeRGB")
    color.outputs[0].default_value = (0.25, 0.5, 1.0, 1.0)
    link(tree, color.outputs[0], tree.nodes["Output"].inputs["Displacement"])
    material.displacement_method = "DISPLACEMENT"
    graph, warnings = export_graph(scene, material)
    node = graph.nodes[graph.displacement.node]
    assert warnings == [] and node.inputs["vector"] == (0.25, 0.5, 1.0) and node.options["space"] == "WORLD"


@pytest.mark.parametrize("domain", ["POINT", "FACE", "CORNER"])
def test_meshes_tell_of_flat_faces_where_they_are_displaced(scene, domain):
    material, _ = surface("ShaderNodeBsdfDiffuse")
    tree = material.node_tree
    link(tree, add_node(tree, "ShaderNodeDisplacement").outputs[0], tree.nodes["Output"].inputs["Displacement"])
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


def test_no_surface_is_black(scene):
    graph, warnings = export_graph(scene, new_material())
    assert graph.surface is None and warnings == []


def test_no_output_node_is_black_and_reported(scene):
    material = new_material()
    material.node_tree.nodes.clear()
    graph, warnings = export_graph(scene, material)
    assert graph.surface is None and any("Material Output" in text for text in warnings)


def test_chains_of_five_hundred_nodes(scene):
    """Each node adds one half: neither the export nor the compiler may run out of stack."""
    material, emission = surface("ShaderNodeEmission")
    tree = material.node_tree
    last = add_node(tree, "ShaderNodeValue")
    for _ in range(500):
        following = add_node(tree, "ShaderNodeMath")
        link(tree, last.outputs[0], following.inputs[0])
        last = following
    link(tree, last.outputs[0], emission.inputs["Strength"])
    graph, warnings = export_graph(scene, material)
    assert sum(node.kind == "math" for node in graph.nodes) == 500 and warnings == []
    text = compile_graph(graph).text
    assert text.count("node_math_add(") == 500 and len(text) < 100_000


def test_chains_of_five_hundred_shaders(scene):
    material = new_material()
    last = add_node(material.node_tree, "ShaderNodeBsdfDiffuse")
    for _ in range(250):
        last = mixed(material, 0.5, last, last)
        last = mixed(material, None, last, add_node(material.node_tree, "ShaderNodeEmission"), "ShaderNodeAddShader")
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


def test_links_are_to_earlier_nodes(scene):
    material, diffuse = surface("ShaderNodeBsdfDiffuse")
    tree = material.node_tree
    noise, ramp = add_node(tree, "ShaderNodeTexNoise"), add_node(tree, "ShaderNodeValToRGB")
    link(tree, noise.outputs[0], ramp.inputs[0])
    link(tree, ramp.outputs[0], diffuse.inputs["Color"])
    graph, _ = export_graph(scene, material)
    for index, node in enumerate(graph.nodes):
        assert all(value.node < index for value in node.inputs.values() if isinstance(value, Link))


def test_rotations_are_attributes_of_four_numbers(scene):
    """As geometry nodes store them: W, X, Y, Z, of which Cycles takes the first three for a color."""
    material = new_material()
    attribute = add_node(material.node_tree, "ShaderNodeAttribute")
    attribute.attribute_name = "turn"
    shader = add_node(material.node_tree, "ShaderNodeEmission")
    link(material.node_tree, attribute.outputs["Color"], shader.inputs["Color"])
    to_surface(material, shader)
    quad = add_mesh(scene)
    quad.data.materials.append(material)
    given = np.linspace(-1.0, 1.0, 16, dtype=np.float32).reshape(4, 4)
    quad.data.attributes.new("turn", "QUATERNION", "POINT").data.foreach_set("value", given.reshape(-1))
    exported = export(scene)
    assert exported.warnings == []
    np.testing.assert_array_equal(exported.meshes[0].attributes["turn"].values, given)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Broken materials: a finite picture with a neutral fallback, and a warning that names material and node."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, add_node, export, link, new_material, to_surface
from rendering import picture, stage
from test_export_images import new_image
from test_export_materials import mixed

from rppm_addon.blender.export import export_scene

NAN, INFINITY = float("nan"), float("inf")


def diffuse(material, **inputs):
    node = add_node(material.node_tree, "ShaderNodeBsdfDiffuse", "Diffuse", **inputs)
    to_surface(material, node)
    return node


def named(warnings, node):
    return any(f'Material "Material": node "{node}"' in text for text in warnings)


def test_links_in_a_circle(scene, renderer):
    material = new_material()
    tree = material.node_tree
    emission = add_node(tree, "ShaderNodeEmission")
    to_surface(material, emission)
    nodes = [add_node(tree, "ShaderNodeMath", f"Math {k}") for k in range(100)]
    for node, following in zip(nodes, [*nodes[1:], nodes[0]], strict=True):
        link(tree, node.outputs[0], following.inputs[0])
    link(tree, nodes[0].outputs[0], emission.inputs["Strength"])
    stage(scene, material)
    picture(renderer, scene)


def test_reroutes_in_a_circle(scene, renderer):
    material = new_material()
    tree = material.node_tree
    node = diffuse(material)
    first, second = tree.nodes.new("NodeReroute"), tree.nodes.new("NodeReroute")
    link(tree, first.outputs[0], second.inputs[0])
    link(tree, second.outputs[0], first.inputs[0])
    link(tree, second.outputs[0], node.inputs["Color"])
    stage(scene, material)
    assert picture(renderer, scene)[0].any()


def test_a_circle_of_shaders(scene, renderer):
    material = new_material()
    tree = material.node_tree
    glow = add_node(tree, "ShaderNodeEmission")
    first = mixed(material, 0.5, glow, glow)
    second = mixed(material, 0.5, first, glow)
    link(tree, second.outputs[0], first.inputs[1])
    to_surface(material, second)
    stage(scene, material)
    assert picture(renderer, scene)[0].any()


def test_a_group_without_a_tree(scene, renderer):
    material = new_material()
    tree = material.node_tree
    node = diffuse(material, Color=(0.5, 0.25, 0.125, 1.0))
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    used = add_node(tree, "ShaderNodeGroup", "Lost")
    used.node_tree = group
    link(tree, used.outputs[0], node.inputs["Color"])
    bpy.data.node_groups.remove(group)
    stage(scene, material)
    radiance, warnings, exported = picture(renderer, scene)
    assert radiance.mean() > 0.1 and named(warnings, "Lost")


@pytest.mark.parametrize("place", ["Surface", "Color"])
def test_a_group_of_a_library_that_is_gone(scene, renderer, tmp_path, place):
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    socket = "NodeSocketShader" if place == "Surface" else "NodeSocketColor"
    group.interface.new_socket("Out", in_out="OUTPUT", socket_type=socket)
    library, main = str(tmp_path / "library.blend"), str(tmp_path / "main.blend")
    bpy.data.libraries.write(library, {group})
    bpy.data.node_groups.remove(group)
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.node_groups = ["Group"]
    material = new_material()
    used = add_node(material.node_tree, "ShaderNodeGroup", "Lost")
    used.node_tree = wanted.node_groups[0]
    if place == "Surface":
        to_surface(material, used)
    else:
        link(material.node_tree, used.outputs[0], diffuse(material).inputs["Color"])
    stage(scene, material)
    bpy.ops.wm.save_as_mainfile(filepath=main)
    (tmp_path / "library.blend").unlink()
    try:
        bpy.ops.wm.open_mainfile(filepath=main)
    except RuntimeError as error:  # what Blender reports on the way
        assert "library.blend" in str(error)
    radiance, warnings, _ = picture(renderer, bpy.context.scene)
    assert radiance.mean() > 0.1 and named(warnings, "Lost")


@pytest.mark.parametrize("place", ["Surface", "Color"])
def test_a_node_type_that_is_unknown(scene, renderer, place):
    """As of another version of Blender or an add-on that is not there."""

    class Foreign(bpy.types.ShaderNodeCustomGroup):
        bl_idname, bl_label = "ForeignNode", "Foreign"

        def init(self, context):
            self.node_tree = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
            socket = "NodeSocketShader" if place == "Surface" else "NodeSocketColor"
            self.node_tree.interface.new_socket("Out", in_out="OUTPUT", socket_type=socket)

    bpy.utils.register_class(Foreign)
    try:
        material = new_material()
        node = material.node_tree.nodes.new("ForeignNode")
        node.name = "Foreign"
        if place == "Surface":
            to_surface(material, node)
        else:
            link(material.node_tree, node.outputs[0], diffuse(material).inputs["Color"])
    finally:
        bpy.utils.unregister_class(Foreign)
    stage(scene, material)
    radiance, warnings, _ = picture(renderer, scene)
    assert radiance.mean() > 0.1 and named(warnings, "Foreign")


def test_a_group_of_an_add_on_is_a_group(scene, renderer):
    class Glowing(bpy.types.ShaderNodeCustomGroup):
        bl_idname, bl_label = "GlowingNode", "Glowing"

    bpy.utils.register_class(Glowing)
    try:
        tree = bpy.data.node_groups.new("Inside", "ShaderNodeTree")
        tree.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketShader")
        emission, inside = add_node(tree, "ShaderNodeEmission", Strength=3.0), tree.nodes.new("NodeGroupOutput")
        tree.links.new(emission.outputs[0], inside.inputs[0])
        material = new_material()
        node = material.node_tree.nodes.new("GlowingNode")
        node.node_tree = tree
        to_surface(material, node)
        stage(scene, material)
        radiance, warnings, _ = picture(renderer, scene)
    finally:
        bpy.utils.unregister_class(Glowing)
    np.testing.assert_allclose(np.median(radiance), 3.0, rtol=1e-3)
    assert warnings == []


def test_missing_images(scene, renderer, tmp_path):
    lost = new_image("Lost", np.ones((2, 2, 4)))
    lost.source, lost.filepath = "FILE", str(tmp_path / "nowhere.png")
    for image in (None, lost):
        material = new_material()
        texture = add_node(material.node_tree, "ShaderNodeTexImage", "Picture")
        texture.image = image
        link(material.node_tree, texture.outputs[0], diffuse(material).inputs["Color"])
        stage(scene, material)
        radiance, warnings, _ = picture(renderer, scene)
        assert any(f'Material "{material.name}": node "Picture"' in text for text in warnings)
        assert radiance[..., 0].mean() > 4 * radiance[..., 1].mean()  # magenta
        for name in ("Shown", "Wall", "Sun", "Light"):
            bpy.data.objects.remove(bpy.data.objects[name])


def test_an_image_without_pixels(scene, renderer):
    """Blender refuses sizes of 0; an image without a buffer has them."""
    image = bpy.data.images.new("Empty", 1, 1)
    image.source = "FILE"
    assert tuple(image.size) == (0, 0)
    material = new_material()
    texture = add_node(material.node_tree, "ShaderNodeTexImage", "Picture")
    texture.image = image
    link(material.node_tree, texture.outputs["Alpha"], diffuse(material).inputs["Roughness"])
    stage(scene, material)
    assert named(picture(renderer, scene)[1], "Picture")


EXTREME = [NAN, INFINITY, -INFINITY, 1e38, -1e38, 0.0, -1.0, 1e-38]
SHADERS = [
    "ShaderNodeBsdfPrincipled", "ShaderNodeBsdfGlass", "ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfRefraction",
    "ShaderNodeBsdfMetallic", "ShaderNodeBsdfSheen", "ShaderNodeBsdfDiffuse", "ShaderNodeEmission",
]  # fmt: skip


@pytest.mark.parametrize("kind", SHADERS)
def test_extreme_sliders(scene, renderer, kind):
    """All inputs at once; zero roughness with zero IOR and negative colors are among them."""
    material = new_material()
    node = add_node(material.node_tree, kind)
    to_surface(material, node)
    stage(scene, material)
    for value in EXTREME:
        for socket in node.inputs:
            stored = getattr(socket, "default_value", None)
            if isinstance(stored, float):
                socket.default_value = value
            elif stored is not None and hasattr(stored, "__len__"):
                socket.default_value = [value] * len(stored)
        picture(renderer, scene)


@pytest.mark.parametrize("kind", SHADERS)
def test_extreme_values_from_nodes(scene, renderer, kind):
    """Values that sliders do not let through come from nodes: 0 / 0, overflows, huge normals."""
    material = new_material()
    tree = material.node_tree
    node = add_node(tree, kind)
    to_surface(material, node)
    stage(scene, material)
    value = add_node(tree, "ShaderNodeValue")
    exponent = add_node(tree, "ShaderNodeMath")
    exponent.operation = "POWER"
    exponent.inputs[1].default_value = 30.0
    link(tree, value.outputs[0], exponent.inputs[0])
    for socket in node.inputs:
        if socket.type != "SHADER":
            link(tree, exponent.outputs[0], socket)
    for base in (1e30, -1e30, 10.0, 0.0):
        value.outputs[0].default_value = base
        picture(renderer, scene)


def test_ramps_and_curves_at_their_least(scene, renderer):
    material = new_material()
    tree = material.node_tree
    ramp = add_node(tree, "ShaderNodeValToRGB", "Ramp")
    while len(ramp.color_ramp.elements) > 1:
        ramp.color_ramp.elements.remove(ramp.color_ramp.elements[0])
    curve = add_node(tree, "ShaderNodeRGBCurve", "Curve")
    for point in curve.mapping.curves[0].points:
        point.location = (0.5, NAN)
    link(tree, ramp.outputs[0], curve.inputs["Color"])
    link(tree, curve.outputs[0], diffuse(material).inputs["Color"])
    divide = add_node(tree, "ShaderNodeMath")
    divide.operation = "LOGARITHM"
    divide.inputs[0].default_value = -1.0
    link(tree, divide.outputs[0], ramp.inputs[0])
    stage(scene, material)
    picture(renderer, scene)


ATTRIBUTES = [
    ("ShaderNodeUVMap", {"uv_map": "Lost"}),
    ("ShaderNodeAttribute", {"attribute_name": "Lost"}),
    ("ShaderNodeAttribute", {"attribute_name": "Lost", "attribute_type": "OBJECT"}),
    ("ShaderNodeAttribute", {"attribute_name": "Lost", "attribute_type": "INSTANCER"}),
    ("ShaderNodeAttribute", {"attribute_name": "Lost", "attribute_type": "VIEW_LAYER"}),
    ("ShaderNodeAttribute", {"attribute_name": ""}),
    ("ShaderNodeVertexColor", {"layer_name": "Lost"}),
    ("ShaderNodeNormalMap", {"uv_map": "Lost"}),
    ("ShaderNodeTangent", {"uv_map": "Lost", "direction_type": "UV_MAP"}),
]


@pytest.mark.parametrize(("kind", "values"), ATTRIBUTES)
@pytest.mark.parametrize("has_uv", [True, False])
def test_attributes_that_are_not_there(scene, renderer, kind, values, has_uv):
    material = new_material()
    tree = material.node_tree
    node = add_node(tree, kind, "Lost")
    for name, value in values.items():
        setattr(node, name, value)
    shader = diffuse(material)
    link(tree, node.outputs[0], shader.inputs["Color"])
    if kind in {"ShaderNodeNormalMap", "ShaderNodeTangent"}:
        link(tree, node.outputs[0], shader.inputs["Normal"])
    stage(scene, material)
    if not has_uv:
        layers = bpy.data.objects["Shown"].data.uv_layers
        layers.remove(layers[0])
    picture(renderer, scene)


def test_empty_material_slots(scene, renderer):
    stage(scene, None)
    radiance, warnings, exported = picture(renderer, scene)
    assert radiance.mean() > 0.1 and warnings == []


def test_drivers_that_fail(scene, renderer):
    material = new_material()
    shader = diffuse(material)
    curve = material.node_tree.driver_add(f'nodes["{shader.name}"].inputs["Roughness"].default_value')
    curve.driver.expression = "1 / 0 + nothing.at.all"
    stage(scene, material)
    assert picture(renderer, scene)[0].mean() > 0.1


@pytest.mark.long
def test_a_chain_of_five_hundred_nodes_is_rendered(scene, renderer):
    material = new_material()
    tree = material.node_tree
    emission = add_node(tree, "ShaderNodeEmission")
    to_surface(material, emission)
    last = add_node(tree, "ShaderNodeValue")
    for _ in range(500):
        following = add_node(tree, "ShaderNodeMath")
        following.inputs[1].default_value = 0.01
        link(tree, last.outputs[0], following.inputs[0])
        last = following
    last.inputs[0].default_value = 0.0
    link(tree, last.outputs[0], emission.inputs["Strength"])
    stage(scene, material)
    start = next(node for node in tree.nodes if node.type == "VALUE").outputs[0].default_value
    np.testing.assert_allclose(picture(renderer, scene)[0], start + 5.0, rtol=1e-3)


def test_worlds_that_are_broken(scene, renderer):
    stage(scene, new_material())
    tree = scene.world.node_tree
    background = tree.nodes["Background"]
    for value in (NAN, INFINITY, 1e38, -1.0):
        background.inputs["Strength"].default_value = value
        picture(renderer, scene)
    sky = add_node(tree, "ShaderNodeTexEnvironment", "Lost sky")
    link(tree, sky.outputs[0], background.inputs["Color"])
    background.inputs["Strength"].default_value = 1.0
    assert any('World "World": node "Lost sky"' in text for text in picture(renderer, scene)[1])
    assert export(scene).world.graph is not None


MISSING = {
    "ShaderNodeUVMap": ({"uv_map": "Lost"}, 'the attribute or UV map "Lost"'),
    "ShaderNodeAttribute": ({"attribute_name": "Lost"}, 'the attribute or UV map "Lost"'),
    "ShaderNodeVertexColor": ({}, "the color attribute in use"),
    "ShaderNodeNormalMap": ({"uv_map": "Lost"}, 'the UV map "Lost"'),
}


@pytest.mark.parametrize("kind", MISSING)
def test_what_objects_do_not_have_is_told(scene, kind):
    """Once for a material, however many objects there are; not of materials that no face has."""
    properties, what = MISSING[kind]
    material, unused = new_material(), new_material()
    for one in (material, unused):
        node = add_node(one.node_tree, kind, "Reader")
        for name, value in properties.items():
            setattr(node, name, value)
        link(one.node_tree, node.outputs[0], diffuse(one).inputs["Normal" if "Normal" in kind else "Color"])
    for number in range(2):
        mesh = add_mesh(scene, f"Mesh {number}").data
        mesh.materials.append(material)
        mesh.materials.append(unused)
    told = [text for text in export(scene).warnings if '"Reader"' in text]
    assert len(told) == 1 and named(told, "Reader") and what in told[0] and told[0].count("such as") == 1


def test_a_property_that_an_object_does_not_have(scene):
    material = new_material()
    tree = material.node_tree
    node = add_node(tree, "ShaderNodeAttribute", "Reader")
    node.attribute_name, node.attribute_type = "wear", "OBJECT"
    link(tree, node.outputs["Fac"], diffuse(material).inputs["Color"])
    owner = add_mesh(scene)
    owner.data.materials.append(material)
    assert any('the property "wear"' in text for text in export(scene).warnings)
    owner["wear"] = 0.5
    owner.update_tag()
    assert export(scene).warnings == []


def test_numbers_that_are_not_finite_are_told(scene):
    material = new_material()
    tree = material.node_tree
    number = add_node(tree, "ShaderNodeValue", "Number")
    number.outputs[0].default_value = NAN
    link(tree, number.outputs[0], diffuse(material).inputs["Roughness"])
    add_mesh(scene).data.materials.append(material)
    assert named(export(scene).warnings, "Number")


def test_attributes_of_the_view_layer_that_is_rendered(scene):
    """Not of that in Blender's window."""
    material = new_material()
    tree = material.node_tree
    node = add_node(tree, "ShaderNodeAttribute")
    node.attribute_name, node.attribute_type = "wear", "VIEW_LAYER"
    emission = add_node(tree, "ShaderNodeEmission")
    link(tree, node.outputs["Fac"], emission.inputs["Strength"])
    to_surface(material, emission)
    add_mesh(scene).data.materials.append(material)
    other = scene.view_layers.new("Other")
    scene.view_layers[0]["wear"], other["wear"] = 0.25, 0.75
    other.update()
    exported = export_scene(other.depsgraph)
    strength = [node.inputs["strength"] for node in exported.materials[0].graph.nodes if node.kind == "emission"]
    assert strength == [0.75]

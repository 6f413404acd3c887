# SPDX-License-Identifier: GPL-3.0-or-later
"""Broken materials: a finite picture with a neutral fallback, and a warning that names material and node."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, export, new_image
from material_rendering import picture, stage, staged
from node_trees import add_node, constant, link, mixed, new_material, node_group, surface, to_surface

from rppm_addon.blender.export import export_scene

NAN, INFINITY = float("nan"), float("inf")


def diffuse(material, **given):
    return surface("ShaderNodeBsdfDiffuse", "Diffuse", material, **given)[1]


def named(warnings, node):
    return any(f'Material "Material": node "{node}"' in text for text in warnings)


def shown_at(place, material, node):
    """Show a node as the surface, or as the color of one."""
    if place == "Surface":
        to_surface(material, node)
    else:
        diffuse(material, Color=node.outputs[0])


def test_links_in_a_circle(scene, renderer, material, tree):
    nodes = [add_node(tree, "ShaderNodeMath", f"Math {k}") for k in range(100)]
    for node, following in zip(nodes, [*nodes[1:], nodes[0]], strict=True):
        link(tree, node.outputs[0], following.inputs[0])
    surface("ShaderNodeEmission", material=material, Strength=nodes[0].outputs[0])
    staged(renderer, scene, material)


def test_reroutes_in_a_circle(scene, renderer, material, tree):
    first, second = tree.nodes.new("NodeReroute"), tree.nodes.new("NodeReroute")
    link(tree, first.outputs[0], second.inputs[0])
    link(tree, second.outputs[0], first.inputs[0])
    diffuse(material, Color=second.outputs[0])
    assert staged(renderer, scene, material)[0].any()


def test_a_circle_of_shaders(scene, renderer, material, tree):
    glow = add_node(tree, "ShaderNodeEmission")
    first = mixed(tree, 0.5, glow, glow)
    second = mixed(tree, 0.5, first, glow)
    link(tree, second.outputs[0], first.inputs[1])
    to_surface(material, second)
    assert staged(renderer, scene, material)[0].any()


def test_a_group_without_a_tree(scene, renderer, material, tree):
    group, _, _ = node_group(outputs=[("Color", "Color")])
    used = add_node(tree, "ShaderNodeGroup", "Lost", node_tree=group)
    diffuse(material, Color=(0.5, 0.25, 0.125, 1.0))
    link(tree, used.outputs[0], tree.nodes["Diffuse"].inputs["Color"])
    bpy.data.node_groups.remove(group)
    radiance, warnings, _ = staged(renderer, scene, material)
    assert radiance.mean() > 0.1 and named(warnings, "Lost")


@pytest.mark.parametrize(("place", "kind"), [("Surface", "Shader"), ("Color", "Color")])
def test_a_group_of_a_library_that_is_gone(scene, renderer, material, tree, tmp_path, place, kind):
    group, _, _ = node_group(outputs=[("Out", kind)])
    library, main = str(tmp_path / "library.blend"), str(tmp_path / "main.blend")
    bpy.data.libraries.write(library, {group})
    bpy.data.node_groups.remove(group)
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.node_groups = ["Group"]
    shown_at(place, material, add_node(tree, "ShaderNodeGroup", "Lost", node_tree=wanted.node_groups[0]))
    stage(scene, material)
    bpy.ops.wm.save_as_mainfile(filepath=main)
    (tmp_path / "library.blend").unlink()
    try:
        bpy.ops.wm.open_mainfile(filepath=main)
    except RuntimeError as error:  # what Blender reports on the way
        assert "library.blend" in str(error)
    radiance, warnings, _ = picture(renderer, bpy.context.scene)
    assert radiance.mean() > 0.1 and named(warnings, "Lost")


@pytest.mark.parametrize(("place", "kind"), [("Surface", "Shader"), ("Color", "Color")])
def test_a_node_type_that_is_unknown(scene, renderer, material, tree, place, kind):
    """As of another version of Blender or an add-on that is not there."""

    class Foreign(bpy.types.ShaderNodeCustomGroup):
        bl_idname, bl_label = "ForeignNode", "Foreign"

        def init(self, context):
            self.node_tree, _, _ = node_group(outputs=[("Out", kind)])

    bpy.utils.register_class(Foreign)
    try:
        shown_at(place, material, add_node(tree, "ForeignNode", "Foreign"))
    finally:
        bpy.utils.unregister_class(Foreign)
    radiance, warnings, _ = staged(renderer, scene, material)
    assert radiance.mean() > 0.1 and named(warnings, "Foreign")


def test_a_group_of_an_add_on_is_a_group(scene, renderer):
    class Glowing(bpy.types.ShaderNodeCustomGroup):
        bl_idname, bl_label = "GlowingNode", "Glowing"

    bpy.utils.register_class(Glowing)
    try:
        group, _, last = node_group(outputs=[("Out", "Shader")])
        link(group, add_node(group, "ShaderNodeEmission", Strength=3.0).outputs[0], last.inputs[0])
        material, _ = surface("GlowingNode", node_tree=group)
        radiance, warnings, _ = staged(renderer, scene, material)
    finally:
        bpy.utils.unregister_class(Glowing)
    np.testing.assert_allclose(np.median(radiance), 3.0, rtol=1e-3)
    assert warnings == []


@pytest.mark.parametrize("has_image", [False, True])
def test_missing_images(scene, renderer, material, tree, tmp_path, has_image):
    texture = add_node(tree, "ShaderNodeTexImage", "Picture")
    if has_image:
        texture.image = new_image("Lost", np.ones((2, 2, 4)))
        texture.image.source, texture.image.filepath = "FILE", str(tmp_path / "nowhere.png")
    diffuse(material, Color=texture.outputs["Color"])
    radiance, warnings, _ = staged(renderer, scene, material)
    assert named(warnings, "Picture")
    assert radiance[..., 0].mean() > 4 * radiance[..., 1].mean()  # magenta


def test_an_image_without_pixels(scene, renderer, material, tree):
    """Blender refuses sizes of 0; an image without a buffer has them."""
    image = bpy.data.images.new("Empty", 1, 1)
    image.source = "FILE"
    assert tuple(image.size) == (0, 0)
    diffuse(material, Roughness=add_node(tree, "ShaderNodeTexImage", "Picture", image=image).outputs["Alpha"])
    assert named(staged(renderer, scene, material)[1], "Picture")


EXTREME = [NAN, INFINITY, -INFINITY, 1e38, -1e38, 0.0, -1.0, 1e-38]
SHADERS = [
    "ShaderNodeBsdfPrincipled", "ShaderNodeBsdfGlass", "ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfRefraction",
    "ShaderNodeBsdfMetallic", "ShaderNodeBsdfSheen", "ShaderNodeBsdfDiffuse", "ShaderNodeEmission",
]  # fmt: skip


@pytest.mark.parametrize("kind", SHADERS)
def test_extreme_sliders(scene, renderer, kind):
    """All inputs at once; zero roughness with zero IOR and negative colors are among them."""
    material, node = surface(kind)
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
    material, node = surface(kind)
    tree = material.node_tree
    stage(scene, material)
    value = constant(tree, 0.0)
    exponent = add_node(tree, "ShaderNodeMath", operation="POWER", Value=value)
    exponent.inputs[1].default_value = 30.0
    for socket in node.inputs:
        if socket.type != "SHADER":
            link(tree, exponent.outputs[0], socket)
    for base in (1e30, -1e30, 10.0, 0.0):
        value.default_value = base
        picture(renderer, scene)


def test_ramps_and_curves_at_their_least(scene, renderer, material, tree):
    ramp = add_node(tree, "ShaderNodeValToRGB", "Ramp")
    while len(ramp.color_ramp.elements) > 1:
        ramp.color_ramp.elements.remove(ramp.color_ramp.elements[0])
    link(tree, add_node(tree, "ShaderNodeMath", operation="LOGARITHM", Value=-1.0).outputs[0], ramp.inputs[0])
    curve = add_node(tree, "ShaderNodeRGBCurve", "Curve", Color=ramp.outputs[0])
    for point in curve.mapping.curves[0].points:
        point.location = (0.5, NAN)
    diffuse(material, Color=curve.outputs[0])
    staged(renderer, scene, material)


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
def test_attributes_that_are_not_there(scene, renderer, material, tree, kind, values, has_uv):
    output = add_node(tree, kind, "Lost", **values).outputs[0]
    shader = diffuse(material, Color=output)
    if kind in {"ShaderNodeNormalMap", "ShaderNodeTangent"}:
        link(tree, output, shader.inputs["Normal"])
    stage(scene, material)
    if not has_uv:
        layers = bpy.data.objects["Shown"].data.uv_layers
        layers.remove(layers[0])
    picture(renderer, scene)


def test_empty_material_slots(scene, renderer):
    radiance, warnings, _ = staged(renderer, scene, None)
    assert radiance.mean() > 0.1 and warnings == []


def test_drivers_that_fail(scene, renderer, material, tree):
    shader = diffuse(material)
    curve = tree.driver_add(f'nodes["{shader.name}"].inputs["Roughness"].default_value')
    curve.driver.expression = "1 / 0 + nothing.at.all"
    assert staged(renderer, scene, material)[0].mean() > 0.1


@pytest.mark.long
def test_a_chain_of_five_hundred_nodes_is_rendered(scene, renderer, material, tree):
    last = start = constant(tree, 0.5)
    for _ in range(500):
        following = add_node(tree, "ShaderNodeMath", Value=last)
        following.inputs[1].default_value = 0.01
        last = following.outputs[0]
    surface("ShaderNodeEmission", material=material, Strength=last)
    np.testing.assert_allclose(staged(renderer, scene, material)[0], start.default_value + 5.0, rtol=1e-3)


def test_worlds_that_are_broken(scene, renderer, material):
    stage(scene, material)
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
        reader = add_node(one.node_tree, kind, "Reader", **properties)
        diffuse(one, **{"Normal" if "Normal" in kind else "Color": reader.outputs[0]})
    for number in range(2):
        add_mesh(scene, f"Mesh {number}", material=material).data.materials.append(unused)
    told = [text for text in export(scene).warnings if '"Reader"' in text]
    assert len(told) == 1 and named(told, "Reader") and what in told[0] and told[0].count("such as") == 1


def test_a_property_that_an_object_does_not_have(scene, material, tree):
    reader = add_node(tree, "ShaderNodeAttribute", "Reader", attribute_name="wear", attribute_type="OBJECT")
    diffuse(material, Color=reader.outputs["Fac"])
    owner = add_mesh(scene, material=material)
    assert any('the property "wear"' in text for text in export(scene).warnings)
    owner["wear"] = 0.5
    owner.update_tag()
    assert export(scene).warnings == []


def test_numbers_that_are_not_finite_are_told(scene, material, tree):
    number = add_node(tree, "ShaderNodeValue", "Number")
    number.outputs[0].default_value = NAN
    diffuse(material, Roughness=number.outputs[0])
    add_mesh(scene, material=material)
    assert named(export(scene).warnings, "Number")


def test_attributes_of_the_view_layer_that_is_rendered(scene, material, tree):
    """Not of that in Blender's window."""
    wear = add_node(tree, "ShaderNodeAttribute", attribute_name="wear", attribute_type="VIEW_LAYER")
    surface("ShaderNodeEmission", material=material, Strength=wear.outputs["Fac"])
    add_mesh(scene, material=material)
    other = scene.view_layers.new("Other")
    scene.view_layers[0]["wear"], other["wear"] = 0.25, 0.75
    other.update()
    exported = export_scene(other.depsgraph)
    strength = [node.inputs["strength"] for node in exported.materials[0].graph.nodes if node.kind == "emission"]
    assert strength == [0.75]


def test_an_output_of_another_kind_is_none(scene, material, tree):
    """Scripts may give a material the output of a world."""
    tree.nodes.clear()
    tree.nodes.new("ShaderNodeOutputWorld")
    add_mesh(scene, material=material)
    (warning,) = export(scene).warnings
    assert "no Material Output node" in warning

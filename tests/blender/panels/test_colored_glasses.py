# SPDX-License-Identifier: GPL-3.0-or-later
"""Three glasses of red, green and blue, found and made one glass that disperses."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, export
from drawing import context_of, drawn
from node_trees import add_node, constant, link, new_material

from rppm_addon.blender.colored_glasses import colored_glasses
from rppm_addon.blender.panels.shading import RPPM_PT_material_settings
from rppm_addon.materials import dispersion

INDICES = (1.60, 1.62, 1.65)
PRIMARIES = np.eye(3)


def glasses(material, indices=INDICES, kind="Glass", colors=PRIMARIES, roughness=(0.1,) * 3):
    """The outputs of three glasses."""
    made = [
        add_node(material.node_tree, f"ShaderNodeBsdf{kind}", Color=(*color, 1.0), IOR=index, Roughness=rough)
        for color, index, rough in zip(colors, indices, roughness, strict=True)
    ]
    return [node.outputs[0] for node in made]


def added(tree, first, *others):
    """The output of Add Shader nodes that add up outputs."""
    for other in others:
        add = add_node(tree, "ShaderNodeAddShader")
        link(tree, first, add.inputs[0])
        link(tree, other, add.inputs[1])
        first = add.outputs[0]
    return first


def shown(material, shader):
    link(material.node_tree, shader, material.node_tree.nodes["Output"].inputs["Surface"])
    return material


def three_glasses(**given):
    material = new_material()
    return shown(material, added(material.node_tree, *glasses(material, **given)))


def converted(material):
    with bpy.context.temp_override(material=material):
        return bpy.ops.rppm.convert_to_dispersion()


@pytest.mark.parametrize("kind", ["Glass", "Refraction"])
def test_three_glasses_become_one_with_an_abbe_number(scene, kind):
    material = three_glasses(kind=kind)
    tree = material.node_tree
    assert converted(material) == {"FINISHED"}
    (glass,) = (node for node in tree.nodes if node.type != "OUTPUT_MATERIAL")
    assert glass.type == f"BSDF_{kind.upper()}" and glass.outputs[0].links[0].to_node == tree.nodes["Output"]
    assert tuple(glass.inputs["Color"].default_value) == (1.0, 1.0, 1.0, 1.0)
    assert glass.inputs["Roughness"].default_value == pytest.approx(0.1)
    found = glass.inputs["IOR"].default_value, material.rppm.abbe_number
    assert material.rppm.use_dispersion and found == pytest.approx(dispersion.fitted(np.array(INDICES)), rel=1e-5)
    assert INDICES[0] < found[0] < INDICES[2] and 5.0 < found[1] < 30.0
    assert converted(material) == {"CANCELLED"}


def test_the_panel_offers_it_where_there_are_such_glasses(scene):
    material = three_glasses()
    assert len(drawn(RPPM_PT_material_settings, context_of(scene, material=material)).operators) == 1
    converted(material)
    assert drawn(RPPM_PT_material_settings, context_of(scene, material=material)).operators == []


def test_mixes_by_thirds_and_indices_by_arithmetic(scene, material, tree):
    """As tutorials have it: the spread is a Value that is added to the index; what else uses nodes keeps them."""
    red, green, blue = glasses(material, colors=3.0 * PRIMARIES)
    index, spread = constant(tree, 1.5), constant(tree, 0.02)
    for glass, operation in ((red, "SUBTRACT"), (blue, "ADD")):
        math = add_node(tree, "ShaderNodeMath", operation=operation, Value=index)
        link(tree, spread, math.inputs[1])
        link(tree, math.outputs[0], glass.node.inputs["IOR"])
    link(tree, index, green.node.inputs["IOR"])
    half, third, outer = (add_node(tree, "ShaderNodeMixShader") for _ in range(3))
    third.inputs[0].default_value = 1.0 / 3.0
    reroute, factor = tree.nodes.new("NodeReroute"), add_node(tree, "ShaderNodeLightPath")
    link(tree, factor.outputs["Is Transmission Ray"], outer.inputs[0])
    link(tree, third.outputs[0], reroute.inputs[0])
    mixes = ((half, red, green), (third, half.outputs[0], blue), (outer, red, reroute.outputs[0]))
    for mix, *shown_by in mixes:
        for socket, place in zip(shown_by, (1, 2), strict=True):
            link(tree, socket, mix.inputs[place])
    shown(material, outer.outputs[0])
    found = colored_glasses(material)
    assert found.root == third and found.color == pytest.approx((1.0, 1.0, 1.0))
    assert found.indices == pytest.approx((1.48, 1.5, 1.52))
    converted(material)
    assert sum(node.type == "BSDF_GLASS" for node in tree.nodes) == 2 and red.node in list(tree.nodes)
    add_mesh(scene, material=material)
    kinds = [node.kind for node in export(scene).materials[0].graph.nodes]
    assert sorted(kinds) == ["bsdf_glass", "bsdf_glass", "light_path", "math", "mix_shader"]


def test_the_other_order_of_colors_is_told(scene, capsys):
    material = three_glasses(indices=INDICES[::-1])
    assert converted(material) == {"FINISHED"}
    assert material.rppm.abbe_number > 0.0 and "red had the largest index" in capsys.readouterr().out


@pytest.mark.parametrize(
    "given",
    [
        {"indices": (1.5, 1.5, 1.5)},
        {"indices": (0.9, 1.5, 1.6)},
        {"colors": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.5, 1.0))},
        {"colors": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0))},
        {"roughness": (0.1, 0.1, 0.2)},
    ],
)
def test_other_glasses_are_left_alone(scene, given):
    material = three_glasses(**given)
    assert colored_glasses(material) is None
    assert converted(material) == {"CANCELLED"}


def test_numbers_of_nodes_that_are_used_twice_are_found_once(scene):
    """Else a chain of thirty would be computed a billion times whenever the panel is drawn."""
    material = three_glasses()
    tree = material.node_tree
    value = constant(tree, INDICES[0] / 2**30)
    for _ in range(30):
        twice = add_node(tree, "ShaderNodeMath")  # which adds
        for term in twice.inputs[:2]:
            link(tree, value, term)
        value = twice.outputs[0]
    red = next(node for node in tree.nodes if node.type == "BSDF_GLASS" and node.inputs["Color"].default_value[0] == 1)
    link(tree, value, red.inputs["IOR"])
    assert colored_glasses(material).indices == pytest.approx(INDICES, rel=1e-5)

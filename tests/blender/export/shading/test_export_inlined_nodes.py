# SPDX-License-Identifier: GPL-3.0-or-later
"""Trees that Blender resolves: which they are, whom warnings name, and that edits of them are seen.

What they look like is compared with Cycles in tests/parity/features.
"""

from types import SimpleNamespace

import bpy
import pytest
from blender_scenes import add_mesh, export, export_graph
from node_trees import add_node, link, new_material, node_group, surface, to_surface

from rppm_addon.blender.export.common.report import Report
from rppm_addon.blender.export.context import ExportContext
from rppm_addon.blender.export.shading.nodes.graphs import HANDLERS, GraphExporter
from rppm_addon.blender.export.shading.nodes.inlining import readable_tree

pytestmark = pytest.mark.skipif(bpy.app.version < (5, 0), reason="Blender 5 is the first that has such nodes")

SOLVED_HERE = {"NodeFrame", "NodeGroupInput", "NodeGroupOutput", "NodeReroute"}


def glowing(material, **given):
    return surface("ShaderNodeEmission", "Glow", material, **given)[1]


def menu_switch(tree, choice="A"):
    """A color by a menu: A is red, B is blue."""
    node = add_node(tree, "GeometryNodeMenuSwitch", "Switch", data_type="RGBA")
    node.inputs["Menu"].default_value = choice
    node.inputs["A"].default_value, node.inputs["B"].default_value = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)
    return node


def repeat_zone(tree, iterations, kind="FLOAT"):
    """The first and the last node of a zone that hands on Item."""
    first, last = tree.nodes.new("GeometryNodeRepeatInput"), tree.nodes.new("GeometryNodeRepeatOutput")
    first.pair_with_output(last)
    last.repeat_items.new(kind, "Item")
    first.inputs["Iterations"].default_value = iterations
    return first, last


def add_group(tree, **sockets):
    group, _, _ = node_group(**sockets)
    return add_node(tree, "ShaderNodeGroup", node_tree=group), group


def emitted(scene):
    exported = export(scene)
    (graph,) = (material.graph for material in exported.materials if material.name == "Material")
    assert not exported.warnings
    return graph.nodes[graph.surface.node].inputs


def test_every_node_that_is_no_shader_node_is_resolved():
    probe = bpy.data.node_groups.new("Probe", "ShaderNodeTree")
    asked = set()
    for name in dir(bpy.types):
        if name.startswith(("ShaderNode", "NodeInternal")):
            continue
        try:
            probe.nodes.new(name)
        except (RuntimeError, TypeError):
            continue  # of other trees, or no node
        probe.nodes.clear()
        material = new_material()
        material.node_tree.nodes.new(name)
        if readable_tree(material).owner is not None:
            asked.add(name)
        else:
            assert name in SOLVED_HERE
    assert {"GeometryNodeRepeatInput", "NodeEvaluateClosure", "NodeCombineBundle", "GeometryNodeMenuSwitch"} <= asked


def test_other_trees_are_read_as_they_are(scene, material):
    glowing(material)
    _, group = add_group(material.node_tree)
    group.nodes.new("ShaderNodeTexNoise")
    material.node_tree.nodes.new("NodeReroute")
    found = readable_tree(material)
    assert found.owner is None and found.tree == material.node_tree
    group.nodes.new("GeometryNodeMenuSwitch")
    assert readable_tree(material).owner is not None


def test_an_output_in_a_group_counts_where_the_tree_has_none(scene, material):
    tree = material.node_tree
    tree.nodes.clear()
    _, group = add_group(tree)
    glow = add_node(group, "ShaderNodeEmission", Color=(1.0, 0.0, 0.0, 1.0))
    inside = add_node(group, "ShaderNodeOutputMaterial")
    group.links.new(glow.outputs[0], inside.inputs["Surface"])
    add_mesh(scene, material=material)
    assert emitted(scene)["color"] == (1.0, 0.0, 0.0)
    outside, other = add_node(tree, "ShaderNodeOutputMaterial"), add_node(tree, "ShaderNodeEmission")
    other.inputs["Color"].default_value = (0.0, 1.0, 0.0, 1.0)
    tree.links.new(other.outputs[0], outside.inputs["Surface"])
    assert emitted(scene)["color"] == (0.0, 1.0, 0.0)


def test_edits_and_animation_are_seen(scene, material, tree):
    switch = menu_switch(tree)
    first, last = repeat_zone(tree, 2)
    more = add_node(tree, "ShaderNodeMath", operation="ADD", Value=first.outputs["Item"])
    more.inputs[1].default_value = 0.5
    link(tree, more.outputs[0], last.inputs["Item"])
    glowing(material, Color=switch.outputs[0], Strength=last.outputs["Item"])
    add_mesh(scene, material=material)
    assert emitted(scene) == {"color": (1.0, 0.0, 0.0), "strength": 1.0}
    switch.inputs["Menu"].default_value = "B"
    assert emitted(scene)["color"] == (0.0, 0.0, 1.0)
    rounds = first.inputs["Iterations"]
    for frame, value in ((1, 2), (5, 6)):
        rounds.default_value = value
        rounds.keyframe_insert("default_value", frame=frame)
    for frame, strength in ((1, 1.0), (5, 3.0)):
        scene.frame_set(frame)
        assert emitted(scene)["strength"] == strength


def test_warnings_name_the_users_nodes(scene, material, tree):
    """Once, also of a node in a zone that is unrolled, in a group."""
    used, group = add_group(tree, outputs=[("Surface", "Shader")])
    first, last = repeat_zone(group, 3, "SHADER")
    both = group.nodes.new("ShaderNodeAddShader")
    link(group, first.outputs["Item"], both.inputs[0])
    link(group, add_node(group, "ShaderNodeEeveeSpecular", "2_Odd").outputs[0], both.inputs[1])
    link(group, both.outputs[0], last.inputs["Item"])
    link(group, last.outputs["Item"], group.nodes["Group Output"].inputs["Surface"])
    to_surface(material, used)
    add_node(tree, "ShaderNodeGroup", "Lost")
    graph, warnings = export_graph(scene, material)
    assert [node.name for node in graph.nodes].count("2_Odd") == 1  # it does not depend on the round
    assert len(warnings) == 2
    assert sum('Material "Material": node "2_Odd" (Specular BSDF)' in text for text in warnings) == 1
    assert sum('node "Lost" (Group) is a group whose node tree is missing' in text for text in warnings) == 1


def test_trees_with_links_in_a_circle_are_read_all_the_same(scene, material, tree):
    """Blender makes nothing of them."""
    first = add_node(tree, "ShaderNodeMath", "First")
    second = add_node(tree, "ShaderNodeMath", "Second", Value=first.outputs[0])
    link(tree, second.outputs[0], first.inputs[0])
    glowing(material, Strength=second.outputs[0], Color=menu_switch(tree).outputs[0])
    graph, warnings = export_graph(scene, material)
    assert any('node "Switch" (Menu Switch)' in text for text in warnings)
    assert graph.nodes[graph.surface.node].kind == "emission"


def test_passes_of_groups_are_kept(scene, material, tree):
    glowing(material, Color=menu_switch(tree, "B").outputs[0])
    _, group = add_group(tree)
    noise = add_node(group, "ShaderNodeTexNoise")
    add_node(group, "ShaderNodeOutputAOV", aov_name="Height", Value=noise.outputs[0])
    graph, warnings = export_graph(scene, material)
    (output,) = graph.aovs
    assert output.name == "Height" and graph.nodes[output.value.node].kind == "tex_noise"
    assert not warnings


@pytest.mark.parametrize(("output", "value"), [("Frame", 12.0), ("Seconds", 0.4)])
def test_scene_time_of_blender_5_2(scene, output, value):
    """With a stand-in for the node, which this Blender may not have; what reads it is read again at other frames."""
    scene.frame_set(12)
    scene.render.fps = 30
    exporter = GraphExporter("Material", ExportContext(Report(), owners=(None, scene, None)))
    found = HANDLERS["INPUT_SCENE_TIME"](exporter, None, SimpleNamespace(identifier=output), ())
    assert found == pytest.approx(value) and exporter.context.untracked_reads == 1

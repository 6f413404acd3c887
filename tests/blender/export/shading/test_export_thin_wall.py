# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin Wall of the Principled BSDF, a socket of Blender 5.2: a boolean socket of another node stands in where it is
missing."""

import pytest
from node_trees import add_node, constant, link, node_group

from rppm_addon.blender.export.common.report import Report
from rppm_addon.blender.export.context import ExportContext
from rppm_addon.blender.export.shading.nodes import surface_nodes as nodes  # noqa: F401  registers the handler
from rppm_addon.blender.export.shading.nodes.graphs import HANDLERS, GraphExporter
from rppm_addon.materials.compiler.compiler import compile_graph


class Disguised:
    """A node or socket of Blender with some attributes replaced."""

    def __init__(self, real, **replaced):
        self._real = real
        self.__dict__.update(replaced)

    def __getattr__(self, name):
        return getattr(self._real, name)


def principled(tree):
    """A Principled node with Thin Wall, and that socket."""
    node = add_node(tree, "ShaderNodeBsdfPrincipled")
    if "Thin Wall" in node.inputs:
        return node, node.inputs["Thin Wall"]
    group, _, _ = node_group([("Wall", "Bool")])
    other = add_node(tree, "ShaderNodeGroup", node_tree=group)
    wall = Disguised(other.inputs[0], identifier="Thin Wall")
    return Disguised(node, inputs=[*node.inputs, wall]), wall


def exported(node):
    exporter = GraphExporter('Material "Wall"', ExportContext(Report()))
    exporter.graph.surface = HANDLERS["BSDF_PRINCIPLED"](exporter, node, node.outputs[0], ())
    return exporter.graph


@pytest.mark.parametrize("checked", [False, True])
def test_a_checked_box_is_an_option(scene, tree, checked):
    node, wall = principled(tree)
    wall.default_value = checked
    node.inputs[0].default_value = (0.5, 0.25, 0.125, 1.0)
    graph = exported(node)
    (shader,) = graph.nodes
    assert shader.options["thin_wall"] is checked and shader.inputs["base_color"] == (0.5, 0.25, 0.125)
    assert "thin_wall" not in shader.inputs


def test_no_box_is_no_thin_wall(scene, tree):
    node = add_node(tree, "ShaderNodeBsdfPrincipled")
    visible = Disguised(node, inputs=[socket for socket in node.inputs if socket.identifier != "Thin Wall"])
    (shader,) = exported(visible).nodes
    assert shader.options["thin_wall"] is False


@pytest.mark.parametrize("number", [-1.0, 0.0, 0.5])
def test_a_linked_number_is_an_option(scene, tree, number):
    node, wall = principled(tree)
    link(tree, constant(tree, number), getattr(wall, "_real", wall))
    (shader,) = exported(node).nodes
    assert shader.options["thin_wall"] is (number > 0.0)


def test_what_varies_chooses_one_of_two_surfaces(scene, tree):
    node, wall = principled(tree)
    link(tree, add_node(tree, "ShaderNodeTexNoise").outputs[0], getattr(wall, "_real", wall))
    graph = exported(node)
    mix = graph.nodes[graph.surface.node]
    thick, thin = graph.nodes[mix.inputs["shader"].node], graph.nodes[mix.inputs["shader_001"].node]
    whole = graph.nodes[mix.inputs["fac"].node]
    cut = graph.nodes[whole.inputs["value"].node]
    assert mix.kind == "mix_shader"
    assert (cut.options["operation"], whole.options["operation"]) == ("TRUNC", "ABSOLUTE")
    assert (thick.options["thin_wall"], thin.options["thin_wall"]) == (False, True)
    assert thick.inputs == thin.inputs
    assert compile_graph(graph).text.count("node_bsdf_principled(") == 2

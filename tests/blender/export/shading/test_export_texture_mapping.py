# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture mapping of texture nodes, and skies in materials."""

import pytest
from blender_scenes import export, export_graph, set_world
from node_trees import add_node, link, surface


@pytest.fixture
def texture(material):
    """An image-less texture that an emission shows."""
    _, glow = surface("ShaderNodeEmission", material=material)
    made = add_node(material.node_tree, "ShaderNodeTexNoise")
    link(material.node_tree, made.outputs[0], glow.inputs["Color"])
    return made


def kinds_of(graph):
    return [node.kind for node in graph.nodes]


def test_a_mapping_that_does_nothing_is_no_node(scene, material, texture):
    graph, warnings = export_graph(scene, material)
    assert "mapping" not in kinds_of(graph) and not warnings


def test_a_texture_is_placed_by_its_own_mapping(scene, material, texture):
    texture.texture_mapping.translation, texture.texture_mapping.vector_type = (1.0, 2.0, 3.0), "TEXTURE"
    graph, warnings = export_graph(scene, material)
    noise = next(node for node in graph.nodes if node.kind == "tex_noise")
    mapping = graph.nodes[noise.inputs["vector"].node]
    assert mapping.kind == "mapping" and mapping.options["vector_type"] == "TEXTURE" and not warnings
    assert mapping.inputs["location"] == (1.0, 2.0, 3.0) and mapping.inputs["scale"] == (1.0, 1.0, 1.0)
    assert graph.nodes[mapping.inputs["vector"].node].kind == "generated_coord"


def test_axes_are_exchanged_before(scene, material, texture):
    texture.texture_mapping.mapping_x, texture.texture_mapping.mapping_z = "Y", "NONE"
    graph, _ = export_graph(scene, material)
    combine = next(node for node in graph.nodes if node.kind == "combine_xyz")
    assert [combine.inputs[axis].output for axis in "xy"] == ["y", "y"] and combine.inputs.get("z", 0.0) == 0.0


def test_the_sun_of_a_sky_in_a_material_is_named(scene, material):
    """In a world it is a light, and nothing is left out."""
    _, glow = surface("ShaderNodeEmission", material=material)
    sky = add_node(material.node_tree, "ShaderNodeTexSky")
    link(material.node_tree, sky.outputs[0], glow.inputs["Color"])
    world = set_world(scene)
    outside = add_node(world.node_tree, "ShaderNodeTexSky")
    link(world.node_tree, outside.outputs[0], world.node_tree.nodes["Background"].inputs["Color"])
    _, (warning,) = export_graph(scene, material)
    assert 'node "Sky Texture" has a sun' in warning and "left out" in warning
    sky.sun_disc = False
    assert not export(scene).warnings

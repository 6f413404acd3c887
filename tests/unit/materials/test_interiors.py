# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes' node graphs taken apart."""

from rppm_addon.materials.traits.interiors import Interior
from rppm_addon.scene import NodeGraph


def volume(density=1.0, strength=1.0):
    """Absorption and emission, added."""
    graph = NodeGraph()
    absorption = graph.add("volume_absorption", "volume", color=(0.5, 0.5, 0.5), density=density)
    emission = graph.add("emission", "emission", strength=strength)
    graph.surface = graph.add("add_shader", "shader", shader=absorption, shader_001=emission)
    return graph


def inputs(graph):
    return {node.kind: node.inputs for node in graph.nodes}


def test_nothing_is_in_a_body_without_a_volume():
    assert Interior.of(None) == Interior()


def test_each_part_is_without_the_other():
    interior = Interior.of(volume())
    assert inputs(interior.absorption)["volume_absorption"]["density"] == 1.0
    assert inputs(interior.absorption)["emission"]["strength"] == 0.0
    assert inputs(interior.emission)["volume_absorption"]["density"] == 0.0
    assert inputs(interior.emission)["emission"]["strength"] == 1.0
    assert not interior.varies


def test_what_is_zero_is_no_part():
    assert Interior.of(volume(strength=0.0)).emission is None
    assert Interior.of(volume(density=0.0)).absorption is None


def test_textures_vary():
    graph = NodeGraph()
    place = graph.add("tex_coord", "object")
    noise = graph.add("tex_noise", "fac", vector=place)
    graph.surface = graph.add("volume_absorption", "volume", density=noise)
    assert Interior.of(graph).varies

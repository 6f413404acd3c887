# SPDX-License-Identifier: GPL-3.0-or-later
"""Constants of node graphs, by their places."""

import pytest

from rppm_addon.materials.compiler.compiled_graph import GraphError, Resource
from rppm_addon.materials.compiler.graph_constants import GraphConstants, socket_constants
from rppm_addon.materials.nodes.node_kinds import COLOR, FLOAT
from rppm_addon.scene.node_graphs import ShaderNode


def test_a_key_has_one_place():
    constants = GraphConstants()
    assert constants.place((0, "color"), [0.1, 0.2, 0.3]) == 0
    assert constants.index((0, "<image>"), Resource("image", 0)) == "constant_index(first + 3u)"
    assert constants.place((0, "color"), [0.1, 0.2, 0.3]) == 0
    assert constants.append([0.5]) == 4 and len(constants.values) == 5


@pytest.mark.parametrize(
    ("value", "kind", "expected"),
    [
        (2.0, FLOAT, [2.0]),
        ((1.0, 1.0, 1.0), FLOAT, [1.0]),
        (2.0, COLOR, [2.0, 2.0, 2.0]),
        ((1.0, 2.0, 3.0, 4.0), COLOR, [1.0, 2.0, 3.0]),
    ],
)
def test_numbers_become_what_the_socket_takes(value, kind, expected):
    assert socket_constants(ShaderNode("emission", "Lamp"), "color", value, kind) == pytest.approx(expected)


@pytest.mark.parametrize("value", ["normals", (1.0, 2.0), None])
def test_other_values_are_refused_by_name(value):
    with pytest.raises(GraphError, match='node "Lamp"'):
        socket_constants(ShaderNode("emission", "Lamp"), "color", value, FLOAT)

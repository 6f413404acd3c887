# SPDX-License-Identifier: GPL-3.0-or-later
"""Random node trees: whatever is linked to whatever, the picture is finite and nothing raises.

RPPM_FUZZ_EXAMPLES sets how many trees are tried, which then differ from run to run.
"""

import os

import bpy
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from material_rendering import picture, stage
from node_trees import new_material, shader_nodes

EXAMPLES = int(os.environ.get("RPPM_FUZZ_EXAMPLES", "0"))


NUMBERS = st.one_of(
    st.sampled_from([0.0, 1.0, -1.0, 0.5, 1e38, -1e38, 1e-38, 1e6, float("nan"), float("inf"), -float("inf")]),
    st.floats(-10.0, 10.0, width=32),
)
NODE_TYPES = [node.bl_idname for node in shader_nodes(new_material().node_tree)]
SMALL = st.integers(0, 63)
TREES = st.fixed_dictionaries(
    {
        "nodes": st.lists(st.sampled_from(NODE_TYPES), min_size=1, max_size=8),
        "links": st.lists(st.tuples(SMALL, SMALL, SMALL, SMALL), max_size=20),
        "values": st.lists(st.tuples(SMALL, SMALL, NUMBERS), max_size=12),
        "choices": st.lists(st.tuples(SMALL, SMALL, SMALL), max_size=12),
        "surface": st.tuples(SMALL, SMALL),
        "displacement": st.none() | st.tuples(SMALL, SMALL),
    }
)


def choose(node, number: int, choice: int) -> None:
    """Set one of the enumerations and switches that only this type of node has."""
    common = set(bpy.types.ShaderNode.bl_rna.properties.keys())
    own = [p for p in node.bl_rna.properties if p.identifier not in common and p.type in {"ENUM", "BOOLEAN"}]
    own = [p for p in own if not p.is_readonly]
    if not own:
        return
    chosen = own[number % len(own)]
    values = [item.identifier for item in chosen.enum_items] if chosen.type == "ENUM" else [False, True]
    if values:
        setattr(node, chosen.identifier, values[choice % len(values)])


def grow(tree, drawn: dict) -> None:
    """The drawn tree; indices count round."""
    nodes = [tree.nodes.new(name) for name in drawn["nodes"]]

    def output(which: int, number: int):
        sockets = nodes[which % len(nodes)].outputs
        return sockets[number % len(sockets)] if len(sockets) else None

    for which, number, choice in drawn["choices"]:
        choose(nodes[which % len(nodes)], number, choice)
    for which, number, value in drawn["values"]:
        sockets = [s for s in nodes[which % len(nodes)].inputs if hasattr(s, "default_value")]
        if sockets:
            socket = sockets[number % len(sockets)]
            stored = socket.default_value
            if isinstance(stored, float):
                socket.default_value = value
            elif not isinstance(stored, str) and hasattr(stored, "__len__"):
                socket.default_value = [value] * len(stored)
    for source, number, target, place in drawn["links"]:
        inputs = nodes[target % len(nodes)].inputs
        found = output(source, number)
        if found is not None and len(inputs):
            tree.links.new(found, inputs[place % len(inputs)])
    for name in ("Surface", "Displacement"):
        shown = drawn[name.lower()]
        found = None if shown is None else output(*shown)
        if found is not None:
            tree.links.new(found, tree.nodes["Output"].inputs[name])


@pytest.mark.long
@settings(
    max_examples=EXAMPLES or 20,
    derandomize=not EXAMPLES,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(TREES)
def test_random_trees_give_finite_pictures(scene, renderer, drawn):
    for name in ("objects", "materials", "worlds", "meshes", "lights"):
        for block in list(getattr(bpy.data, name)):
            if block.name != "Camera":
                getattr(bpy.data, name).remove(block)
    material = new_material()
    grow(material.node_tree, drawn)
    stage(scene, material, 8)
    _, warnings, exported = picture(renderer, scene)
    for warning in warnings:
        assert warning.startswith('Material "Material"') or "photons" in warning, warning
        assert "it is gray" not in warning, warning

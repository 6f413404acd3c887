# SPDX-License-Identifier: GPL-3.0-or-later
"""All kinds of nodes that give values, in the program that resolves hits."""

import numpy as np
import pytest

from rppm_addon.materials.compiler import BUMP, compile_graph
from rppm_addon.materials.nodes import KINDS
from rppm_addon.scene.node_graphs import NodeGraph

VALUES = [name for name, kind in KINDS.items() if not kind.is_shader and name != BUMP]
SOURCES = sorted({KINDS[name].source for name in VALUES})


def graph_of(names: list[str]) -> NodeGraph:
    """Every kind once, and every function of it, each fed by the one before through all of its inputs, and all of them shown."""
    graph = NodeGraph()
    value = graph.add("new_geometry", "position")
    for name in names:
        kind = KINDS[name]
        output = next(iter(kind.outputs))
        for choice in kind.options.get(kind.function_option, (None,)):
            options = {} if choice is None else {kind.function_option: choice}
            inputs = dict.fromkeys(kind.inputs, value)
            value = graph.add(name, output, table=np.zeros((257, 4)), options=options, **inputs)
    graph.surface = graph.add("emission", "emission", color=value)
    return graph


@pytest.mark.parametrize("source", SOURCES)
def test_kinds_of_a_file_compile(library, source):
    text = compile_graph(graph_of([name for name in VALUES if KINDS[name].source == source])).text
    library.compute("resolve/resolve.comp", inserts={"materials/generated.glsl": text})


def test_kinds_have_no_names_in_common(library):
    """All files in one program: no function or constant may have the name of another's."""
    text = "".join(f'#include "materials/nodes/{source}"\n' for source in SOURCES)
    text += "void evaluate_material(Surface surface, uint first, inout ClosureBuilder builder) {}\n"
    library.compute("resolve/resolve.comp", inserts={"materials/generated.glsl": text})

# SPDX-License-Identifier: GPL-3.0-or-later
"""Graphs with every kind of node, and every GLSL function of it."""

import numpy as np

from rppm_addon.materials.compiler.compiler import ADD_SHADER, MIX_SHADER, compile_displacement, compile_graph
from rppm_addon.materials.nodes import KINDS
from rppm_addon.scene.node_graphs import NodeGraph

SOURCES = sorted({kind.source for kind in KINDS.values()})
"""The files that the functions are in."""


def graph_of(names: list[str]) -> NodeGraph:
    """Every kind and every function of it, each fed by the one before through all of its inputs, all of them shown."""
    graph = NodeGraph()
    value = graph.add("new_geometry", "position")
    shaders = []
    for name in names:
        kind = KINDS[name]
        output = next(iter(kind.outputs))
        for choice in kind.options.get(kind.function_option, (None,)):
            options = {} if choice is None else {kind.function_option: choice}
            inputs = dict.fromkeys(kind.inputs, value)
            made = graph.add(name, output, table=np.zeros((257, 4)), options=options, **inputs)
            if kind.is_shader:
                shaders.append(made)
            else:
                value = made
    graph.surface, graph.displacement = graph.add("emission", "emission", color=value), value
    for shader in shaders:
        if graph.nodes[shader.node].kind not in (MIX_SHADER, ADD_SHADER):
            both = graph.add(ADD_SHADER, "shader", shader=graph.surface, shader_001=shader)
            graph.surface = graph.add(MIX_SHADER, "shader", fac=value, shader=both)
    return graph


def programs(traces_rays: bool = True) -> dict[str, str]:
    """The text of a graph for each file of kinds, and of one whose light is dispersed; traces_rays: of a surface."""
    graphs = {source: graph_of([name for name, kind in KINDS.items() if kind.source == source]) for source in SOURCES}
    texts = {source: compile_graph(graph, traces_rays=traces_rays).text for source, graph in graphs.items()}
    return texts | {"dispersion": compile_graph(graph_of(["bsdf_glass", "bsdf_refraction"]), abbe_number=64.0).text}


def displacements() -> dict[str, str]:
    """The text of what displaces a surface for each file of kinds."""
    return {
        source: compile_displacement(graph_of([name for name, kind in KINDS.items() if kind.source == source])).text
        for source in SOURCES
    }

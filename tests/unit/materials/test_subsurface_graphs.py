# SPDX-License-Identifier: GPL-3.0-or-later
"""Which materials send light below the surface."""

import pytest
from support.graphs import surface_graph

from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.materials.traits.subsurface import has_subsurface
from rppm_addon.scene import NodeGraph


def principled(varies: bool = False, thin_wall: bool = False, **inputs: object) -> NodeGraph:
    graph = NodeGraph()
    if varies:
        inputs["subsurface_weight"] = graph.add("fresnel", "fac")
    graph.surface = graph.add("bsdf_principled", "bsdf", options={"thin_wall": thin_wall}, **inputs)
    return graph


def unused_subsurface() -> NodeGraph:
    graph = surface_graph("bsdf_diffuse")
    graph.add("subsurface_scattering", "bssrdf")
    return graph


@pytest.mark.parametrize(
    "graph", [principled(subsurface_weight=0.1), principled(varies=True), surface_graph("subsurface_scattering")]
)
def test_light_goes_below(graph):
    assert has_subsurface(graph)
    assert "materials/subsurface.glsl" in compile_graph(graph).text


@pytest.mark.parametrize(
    "graph", [NodeGraph(), principled(), principled(thin_wall=True, subsurface_weight=1.0), unused_subsurface()]
)
def test_light_stays_above(graph):
    assert not has_subsurface(graph)
    assert "materials/subsurface.glsl" not in compile_graph(graph).text

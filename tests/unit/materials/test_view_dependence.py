# SPDX-License-Identifier: GPL-3.0-or-later
"""Which materials scatter by shares that depend on the viewer."""

import pytest
from support.lobes import Lobe, LobeKind, material

from rppm_addon.materials.traits.view_dependence import depends_on_view
from rppm_addon.scene import NodeGraph


def mixed_by(kind: str, output: str) -> NodeGraph:
    graph = material("lobes", Lobe(LobeKind.DIFFUSE)).graph
    graph.surface = graph.add("mix_shader", "shader", fac=graph.add(kind, output), shader=graph.surface)
    return graph


@pytest.mark.parametrize(
    "graph",
    [
        mixed_by("fresnel", "fac"),
        mixed_by("layer_weight", "facing"),
        mixed_by("new_geometry", "incoming"),
        mixed_by("new_geometry", "backfacing"),
        material("layers", Lobe(LobeKind.PRINCIPLED)).graph,
        material("restored", Lobe(LobeKind.GLASS, roughness=0.3)).graph,
        material("coated", Lobe(LobeKind.GLASS, thin_film_thickness=300.0)).graph,
    ],
)
def test_views_from_both_sides_differ(graph):
    assert depends_on_view(graph)


@pytest.mark.parametrize(
    "graph",
    [
        NodeGraph(),
        mixed_by("new_geometry", "position"),
        material("clear", Lobe(LobeKind.GLASS)).graph,
        material("single", Lobe(LobeKind.GLASS, roughness=0.3, multiscatter=False)).graph,
        material("plain", Lobe(LobeKind.DIFFUSE), Lobe(LobeKind.GLOSSY, roughness=0.3, multiscatter=False)).graph,
    ],
)
def test_views_from_both_sides_agree(graph):
    assert not depends_on_view(graph)


def test_nodes_that_nothing_uses_do_not_matter():
    graph = material("plain", Lobe(LobeKind.DIFFUSE)).graph
    graph.add("fresnel", "fac")
    assert not depends_on_view(graph)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Which materials shadow rays may pass."""

import pytest
from support.graphs import surface_graph

from rppm_addon.materials.traits.transparency import asks_for_shadow_rays, passes_shadow_rays
from rppm_addon.scene.node_graphs import NodeGraph


def mixed_by_shadow_rays(shader: str) -> NodeGraph:
    graph = NodeGraph()
    asked = graph.add("light_path", "is_shadow_ray")
    first, second = graph.add(shader, "bsdf"), graph.add("bsdf_transparent", "bsdf")
    graph.surface = graph.add("mix_shader", "shader", fac=asked, shader=first, shader_001=second)
    return graph


@pytest.mark.parametrize(
    ("inputs", "passes"), [({}, False), ({"alpha": 1.0}, False), ({"alpha": 0.5}, True), ({"alpha": 0.0}, True)]
)
def test_a_principled_surface_passes_light_by_its_alpha(inputs, passes):
    graph = surface_graph("bsdf_principled", **inputs)
    assert passes_shadow_rays(graph) is passes
    assert not asks_for_shadow_rays(graph)


def test_a_card_that_is_transparent_to_shadow_rays_passes_light():
    graph = mixed_by_shadow_rays("bsdf_diffuse")
    assert passes_shadow_rays(graph)
    assert asks_for_shadow_rays(graph)


@pytest.mark.parametrize("shader", ["bsdf_glass", "bsdf_refraction"])
def test_photons_bring_light_through_glass_that_is_transparent_to_shadow_rays(shader):
    graph = mixed_by_shadow_rays(shader)
    assert not passes_shadow_rays(graph)
    assert not asks_for_shadow_rays(graph)

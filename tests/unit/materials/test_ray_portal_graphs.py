# SPDX-License-Identifier: GPL-3.0-or-later
"""Which materials have ray portals."""

import numpy as np
import pytest
from support.graphs import surface_graph

from rppm_addon.integrator.common.shader_features import ShaderFeatures
from rppm_addon.integrator.common.viewport_demands import NO_DEMANDS, ViewportDemands
from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.materials.traits.ray_portals import has_ray_portals
from rppm_addon.scene import Camera, Material, NodeGraph, Scene


def mixed() -> NodeGraph:
    graph = surface_graph("bsdf_ray_portal")
    other = graph.add("bsdf_diffuse", "bsdf")
    graph.surface = graph.add("mix_shader", "shader", shader=graph.surface, shader_001=other)
    return graph


def unused() -> NodeGraph:
    graph = surface_graph("bsdf_diffuse")
    graph.add("bsdf_ray_portal", "bsdf")
    return graph


@pytest.mark.parametrize("graph", [surface_graph("bsdf_ray_portal"), mixed()])
def test_paths_go_on_elsewhere(graph):
    assert has_ray_portals(graph)
    assert "materials/ray_portals.glsl" in compile_graph(graph).text


@pytest.mark.parametrize("graph", [NodeGraph(), surface_graph("bsdf_transparent"), unused()])
def test_paths_stay(graph):
    assert not has_ray_portals(graph)
    assert "materials/ray_portals.glsl" not in compile_graph(graph).text


def test_programs_know_ray_portals_where_a_material_has_one():
    scene = Scene(
        Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 4, 4),
        materials=[Material("window", surface_graph("bsdf_ray_portal"))],
    )
    assert "RAY_PORTALS" in ShaderFeatures.of(scene, NO_DEMANDS).defines
    scene.materials = [Material("plain", surface_graph("bsdf_diffuse"))]
    assert "RAY_PORTALS" not in ShaderFeatures.of(scene, NO_DEMANDS).defines
    assert "RAY_PORTALS" in ShaderFeatures.of(scene, ViewportDemands(has_ray_portals=True)).defines

# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs know thin films where a material may have one."""

import numpy as np
import pytest
from support.graphs import surface_graph

from rppm_addon.integrator.common.shader_features import ShaderFeatures
from rppm_addon.integrator.common.viewport_demands import NO_DEMANDS, ViewportDemands
from rppm_addon.materials.traits.thin_films import has_thin_film
from rppm_addon.scene import Camera, Material, NodeGraph, Scene


def linked() -> NodeGraph:
    """Glass whose film is as thick as a node says."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_glass", "bsdf", thin_film_thickness=graph.add("new_geometry", "random_per_island"))
    return graph


@pytest.mark.parametrize("graph", [surface_graph("bsdf_metallic", thin_film_thickness=300.0), linked()])
def test_films(graph):
    assert has_thin_film(graph)


@pytest.mark.parametrize("graph", [NodeGraph(), surface_graph("bsdf_principled"), surface_graph("bsdf_diffuse")])
def test_bare_surfaces(graph):
    assert not has_thin_film(graph)


def defines(graph: NodeGraph, space: str, demands: ViewportDemands = NO_DEMANDS) -> dict[str, object]:
    camera = Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 4, 4)
    scene = Scene(camera, materials=[Material("surface", graph)], working_space=space)
    return ShaderFeatures.of(scene, demands).defines


def test_programs_have_the_colors_of_films():
    """In the scene's space, which the defaults of shaders are for Rec.709."""
    film, bare = surface_graph("bsdf_glass", thin_film_thickness=300.0), surface_graph("bsdf_glass")
    assert defines(film, "Linear Rec.709") == {"THIN_FILM_LOBES": 1}
    assert {"THIN_FILM_LOBES", "XYZ_TO_WORKING"} <= defines(film, "ACEScg").keys()
    assert defines(bare, "ACEScg") == {}
    assert "THIN_FILM_LOBES" in defines(bare, "ACEScg", ViewportDemands(has_thin_film=True))

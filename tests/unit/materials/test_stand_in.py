# SPDX-License-Identifier: GPL-3.0-or-later
"""Stand-ins for materials whose programs are not compiled yet."""

import numpy as np
import pytest
from support.graphs import surface_graph

from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.materials.placeholders.plain_surface import plain_surface
from rppm_addon.materials.placeholders.stand_in import stand_in_graph
from rppm_addon.materials.traits.emitted import Emits, emits
from rppm_addon.scene import Image, NodeGraph

RED = (1.0, 0.0, 0.0)
IMAGES = [Image("half", np.full((2, 2, 4), 0.5, np.float32)), Image("quarter", np.full((2, 2, 4), 0.25, np.float32))]


def painted(start: str = "tex_coord", **mapping: object) -> NodeGraph:
    """A Principled surface with the second image, tinted."""
    graph = NodeGraph()
    place = graph.add(start, "uv" if start == "tex_coord" else "position")
    if mapping:
        place = graph.add("mapping", "vector", vector=place, **mapping)
    image = graph.add("tex_image", "color", image=1, vector=place)
    color = graph.add("mix_color", "result_color", factor_float=0.5, a_color=RED, b_color=image)
    graph.surface = graph.add("bsdf_principled", "bsdf", base_color=color, metallic=0.25)
    return graph


def test_all_stand_ins_share_a_program():
    graphs = [
        painted(),
        painted("new_geometry"),
        surface_graph("bsdf_glass"),
        surface_graph("emission", strength=3.0),
        NodeGraph(),
    ]
    assert len({compile_graph(stand_in_graph(graph, IMAGES)).text for graph in graphs}) == 1


@pytest.mark.parametrize(
    "graph",
    [
        surface_graph("bsdf_diffuse", color=RED),
        surface_graph("bsdf_glossy", color=RED, roughness=0.25),
        surface_graph("bsdf_glass", color=RED),
        surface_graph("bsdf_transparent"),
        surface_graph("bsdf_principled", base_color=RED, alpha=0.5, emission_color=RED, emission_strength=2.0),
    ],
)
def test_a_stand_in_is_as_plain_as_what_it_stands_for(graph):
    expected, made = plain_surface(graph, []), stand_in_graph(graph, [])
    (found,) = (node.inputs for node in made.nodes if node.kind == "plain_surface")
    assert (found["color"], found["emission"]) == (tuple(expected.color), tuple(expected.emission))
    assert (found["metallic"], found["roughness"]) == (expected.metallic, expected.roughness)
    assert found["transparent"] == expected.transparent
    assert found["glass"] * (1.0 - found["transparent"]) == pytest.approx(expected.glass)
    assert (emits(made) is Emits.NOTHING) == (emits(graph) is Emits.NOTHING)


def test_what_gives_no_light_goes_on_giving_none():
    assert emits(stand_in_graph(painted(), IMAGES)) is Emits.NOTHING


def image_of(graph: NodeGraph) -> tuple[int, dict]:
    (image,) = (node for node in graph.nodes if node.kind == "tex_image")
    (place,) = (node for node in graph.nodes if node.kind == "vector_math")
    return image.image, place.inputs


def test_the_image_of_the_color_lies_where_it_lay():
    image, place = image_of(stand_in_graph(painted(scale=(2.0, 3.0, 1.0), location=0.5), IMAGES))
    assert (image, place["vector_001"], place["vector_002"]) == (1, (2.0, 3.0, 1.0), (0.5, 0.5, 0.5))
    (surface,) = (node for node in stand_in_graph(painted(), IMAGES).nodes if node.kind == "plain_surface")
    np.testing.assert_allclose(surface.inputs["color"], (2.5, 0.5, 0.5))  # times 0.25: the mean of both


@pytest.mark.parametrize("graph", [painted("new_geometry"), painted(rotation=(0.0, 0.0, 1.0)), NodeGraph()])
def test_images_that_lie_elsewhere_count_by_their_mean(graph):
    assert image_of(stand_in_graph(graph, IMAGES))[0] == -1

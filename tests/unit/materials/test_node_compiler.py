# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs to GLSL: what is part of the text, what is a constant, and what is refused."""

import re

import numpy as np
import pytest
from support.every_node import programs
from support.graphs import chain, surface_graph

from rppm_addon.materials.compiler.compiled_graph import MAX_NODE_RAYS, GraphError, NodeRayCounts, Resource
from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.scene import AovOutput, Link, NodeGraph
from rppm_addon.scene.passes import aov_passes


def textured(scale=5.0, color=(0.8, 0.2, 0.1), table=None, image=0, attribute="UVMap", operation="ADD", roughness=0.5):
    graph = NodeGraph()
    place = graph.add("uvmap", "uv", attribute=attribute)
    picture = graph.add("tex_image", "color", image=image, vector=place)
    table = np.zeros((257, 4), np.float32) if table is None else table
    ramp = graph.add("val_to_rgb", "color", table=table, fac=picture)
    math = graph.add("math", "value", options={"operation": operation}, value=ramp, value_001=scale)
    mixed = graph.add("mix_color", "result_color", factor_float=math, a_color=color, b_color=ramp)
    graph.surface = graph.add("bsdf_principled", "bsdf", base_color=mixed, roughness=roughness)
    return graph


@pytest.mark.parametrize(
    "change",
    [
        {"scale": 7.0}, {"color": (0.0, 1.0, 0.5)}, {"table": np.ones((33, 4), np.float32)}, {"image": 3},
        {"attribute": "Other"}, {"roughness": 0.0}, {"scale": float("nan")}, {"scale": 1e300},
    ],
)  # fmt: skip
def test_constants_leave_the_text_as_it_is(change):
    assert compile_graph(textured(**change)).text == compile_graph(textured()).text


def test_constants_come_in_the_order_of_use():
    constants = compile_graph(textured(7.0, (0.25, 0.5, 0.75), roughness=0.125)).constants
    numbers = [constant for constant in constants if not isinstance(constant, Resource)]
    assert {7.0, 0.125} <= set(numbers)
    first = numbers.index(0.25)
    assert numbers[first : first + 3] == [0.25, 0.5, 0.75]
    assert sorted(resource.what for resource in constants if isinstance(resource, Resource)) == [
        "attribute", "image", "table",
    ]  # fmt: skip


def test_numbers_are_finite_in_single_precision():
    for value in (float("nan"), float("inf"), -float("inf"), 1e300, -1e300, (float("nan"), 1e300, 0.0)):
        graph = surface_graph("emission", color=value, strength=value)
        assert np.isfinite(np.array(compile_graph(graph).constants, np.float32)).all()


def other_structures():
    yield "another operation", textured(operation="SINE")
    graph = textured()
    graph.nodes[graph.surface.node].inputs["roughness"] = Link(1, "color")
    yield "another link", graph
    graph = textured()
    graph.nodes[1].options["interpolation"] = "Closest"
    yield "another option", graph
    graph = textured()
    graph.surface = graph.add("add_shader", "shader", shader=graph.surface)
    yield "another shader", graph
    graph = textured()
    graph.normal = graph.add("bump", "normal")
    yield "another normal", graph


@pytest.mark.parametrize(("name", "graph"), list(other_structures()))
def test_other_structures_are_other_texts(name, graph):
    assert compile_graph(graph).text != compile_graph(textured()).text


def test_nodes_that_nothing_uses_leave_the_text_as_it_is():
    graph = NodeGraph()
    for _ in range(3):
        graph.add("tex_noise", "color")
    color = graph.add("combine_color", "color", red=0.5)
    graph.add("tex_voronoi", "color")
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=color)
    plain = NodeGraph()
    plain.surface = plain.add("bsdf_diffuse", "bsdf", color=plain.add("combine_color", "color", red=0.25))
    assert compile_graph(graph).text == compile_graph(plain).text


def test_shared_nodes_are_emitted_once():
    """A value that doubles thirty times, and a shader that all of its mixes share."""
    graph = NodeGraph()
    value = graph.add("tex_coord", "uv")
    for _ in range(30):
        value = graph.add("vector_math", "vector", vector=value, vector_001=value)
    shader = graph.add("bsdf_diffuse", "bsdf", color=value)
    for _ in range(30):
        shader = graph.add("mix_shader", "shader", fac=value, shader=shader, shader_001=shader)
    graph.surface = shader
    text = compile_graph(graph).text
    assert text.count("node_vector_math_add(") == 30 and text.count("node_bsdf_diffuse(") == 1
    assert text.count("node_tex_coord(") == 1


def bumped():
    graph = NodeGraph()
    place = graph.add("tex_coord", "uv")
    noise = graph.add("tex_noise", "fac", vector=place)
    normal = graph.add("bump", "normal", height=noise)
    graph.surface = graph.add(
        "bsdf_diffuse", "bsdf", color=graph.add("tex_noise", "color", vector=place), normal=normal
    )
    return graph


def test_bump_asks_for_its_height_at_three_places():
    text = compile_graph(bumped()).text
    (name,) = {word.split("(")[0] for word in text.split() if word.startswith("height_") and "(Surface" in word}
    assert text.count(f"{name}(surface_beside(surface, way), first)") == 1 and "k < 3" in text
    body = text.split(f"float {name}(")[1].split("}")[0]
    assert body.count("node_tex_noise(") == 1 and text.count("node_tex_noise(") == 2


@pytest.mark.parametrize("depth", [3, 100])
def test_bumps_within_heights_end(depth):
    """The height of each bump depends on the normal of the one before: 3^depth evaluations if taken at their word; of
    two bumps there are 3^2."""
    graph = NodeGraph()
    normal = graph.add("new_geometry", "normal")
    for _ in range(depth):
        normal = graph.add("bump", "normal", height=graph.add("fresnel", "fac", normal=normal))
    graph.surface = graph.add("bsdf_diffuse", "bsdf", normal=normal)
    text = compile_graph(graph).text
    assert text.count("node_bump(") == 2 and text.count("node_fresnel(") == 2
    assert len(text) < 5000


def test_bumps_one_after_the_other_are_all_there():
    graph = NodeGraph()
    normal = graph.add("new_geometry", "normal")
    for _ in range(100):
        normal = graph.add("bump", "normal", height=graph.add("tex_noise", "fac"), normal=normal)
    graph.surface = graph.add("bsdf_diffuse", "bsdf", normal=normal)
    assert compile_graph(graph).text.count("node_bump(") == 100


def test_a_normal_of_the_whole_surface_shares_nodes_with_it():
    graph = bumped()
    graph.normal = graph.nodes[graph.surface.node].inputs["normal"]
    text = compile_graph(graph).text
    main = text.split("void evaluate_material")[1]
    assert main.count("material_normal(surface, first)") == 1
    declared = [line.strip() for line in main.splitlines() if line.strip().startswith(("vec3 ", "float "))]
    assert len(declared) == len(set(declared))


def with_surface(kind, output, name="", **inputs):
    graph = NodeGraph()
    graph.surface = graph.add(kind, output, name=name, **inputs)
    return graph


def glowing(kind, output, name, **options):
    """A surface whose emission has the color of a node."""
    graph = NodeGraph()
    graph.surface = graph.add("emission", "emission", color=graph.add(kind, output, name=name, **options))
    return graph


def circle():
    graph = glowing("math", "value", "First", value=Link(2, "value"))
    graph.add("math", "value", name="Second", value=Link(0, "value"))
    return graph


BAD = {
    "unknown kind": (with_surface("bsdf_of_tomorrow", "bsdf", "New"), "New.*unknown kind"),
    "link to nowhere": (with_surface("bsdf_diffuse", "bsdf", "Lost", color=Link(7, "color")), "Lost"),
    "surface nowhere": (NodeGraph(surface=Link(3, "bsdf")), "node 3 of 0"),
    "link to itself": (with_surface("bsdf_diffuse", "bsdf", "Loop", color=Link(0, "bsdf")), "Loop"),
    "circle": (circle(), "First"),
    "shader as a color": (glowing("bsdf_diffuse", "bsdf", "Shader"), "Shader"),
    "number as a surface": (with_surface("math", "value", "Number"), "Number.*no shader"),
    "unknown output": (glowing("tex_noise", "smell", "Noise"), "Noise.*smell"),
    "unknown option": (glowing("math", "value", "Sum", options={"operation": "INTEGRATE"}), "Sum.*INTEGRATE"),
    "two numbers": (with_surface("emission", "emission", "Odd", color=(1.0, 2.0)), "Odd.*color"),
    "a text": (with_surface("emission", "emission", "Odd", color="red"), "Odd"),
}


@pytest.mark.parametrize(("graph", "message"), BAD.values(), ids=BAD)
def test_bad_graphs_are_refused_by_name(graph, message):
    with pytest.raises(GraphError, match=message):
        compile_graph(graph)


def test_a_chain_of_five_thousand_nodes():
    graph = NodeGraph()
    graph.surface = graph.add("emission", "emission", color=chain(graph, 5000))
    text = compile_graph(graph).text
    assert text.count("node_math_add(") == 5000 and len(text) < 200 * 5000


def test_more_nodes_than_drivers_compile_are_refused(monkeypatch):
    """Only nodes that are in use count: others cost nothing."""
    monkeypatch.setattr("rppm_addon.materials.compiler.compiler.MAX_CALLS", 50)
    graph = NodeGraph()
    for count in (30, 60):
        surface = graph.add("emission", "emission", color=chain(graph, count))
        graph.surface = graph.surface or surface
    compile_graph(graph)
    graph.surface = surface
    with pytest.raises(GraphError, match="more than 50 nodes, which drivers compile for many minutes; bake them"):
        compile_graph(graph)


def test_the_same_graph_gives_the_same_text_each_time():
    assert programs() == programs()


def test_aov_outputs_are_in_the_text_only_where_their_pass_is_rendered():
    plain, with_aovs = textured(), textured()
    with_aovs.aovs = [AovOutput("Mask", value=Link(3, "value")), AovOutput("Tint", color=(0.1, 0.2, 0.3))]
    expected = compile_graph(plain)
    for graph, names in ((plain, ("Mask.X", "Tint.RGBA")), (with_aovs, ()), (with_aovs, ("Other.X",))):
        assert compile_graph(graph, aov_passes(names)) == expected
    compiled = compile_graph(with_aovs, aov_passes(("Tint.RGBA", "Mask.X")))
    assert compiled.text.startswith(expected.text) and compiled.constants[-3:] == pytest.approx([0.1, 0.2, 0.3])
    assert "add_aov(5u * path + 0u, constant_vec3" in compiled.text and "add_aov(5u * path + 4u, n" in compiled.text


def test_aov_outputs_that_are_malformed_are_refused():
    graph = textured()
    for color in (Link(99, "value"), Link(3, "nothing"), "red"):
        graph.aovs = [AovOutput("Tint", color=color)]
        with pytest.raises(GraphError):
            compile_graph(graph, aov_passes(("Tint.RGBA",)))


def occluded(*normals: str) -> NodeGraph:
    """Ambient Occlusion about a chain of normals."""
    graph, inputs = NodeGraph(), {}
    for kind in normals:
        inputs = {"normal": graph.add(kind, "normal", **inputs)}
    shade = graph.add("ambient_occlusion", "color", samples=5.0, **inputs)
    graph.surface = graph.add("emission", "emission", color=shade)
    return graph


@pytest.mark.parametrize(
    ("normals", "expected"),
    [
        ((), NodeRayCounts(1, 1, 5)),
        (("bevel",), NodeRayCounts(2, 2, 5)),
        (("bevel", "bump"), NodeRayCounts(2, 2, 5)),
        (("bevel", "bump", "bevel"), NodeRayCounts(3, 3, 5)),
    ],
)
def test_rays_that_depend_on_others_are_traced_after_them(normals, expected):
    compiled = compile_graph(occluded(*normals))
    assert compiled.rays == expected
    assert '#include "materials/node_rays.glsl"' in compiled.text
    calls = re.findall(r"node_(?:bevel|ambient_occlusion)\(.*", compiled.text)
    levels = re.findall(r"(\d+)u, (\d+)u, ", "".join(calls))
    assert levels == [(str(place), str(place)) for place in range(expected.places)]


@pytest.mark.parametrize(
    ("samples", "expected"), [(None, 16), (-3.0, 1), (4.9, 4), (1e9, MAX_NODE_RAYS), ("linked", MAX_NODE_RAYS)]
)
def test_no_node_asks_for_more_rays_than_are_traced(samples, expected):
    """Rays that are not traced would count as met."""
    graph = NodeGraph()
    inputs = {} if samples is None else {"samples": samples}
    if samples == "linked":
        inputs = {"samples": graph.add("math", "value", value=9.0)}
    graph.surface = graph.add("emission", "emission", color=graph.add("ambient_occlusion", "color", **inputs))
    assert compile_graph(graph).rays.samples == expected


def test_nodes_about_a_normal_of_rays_ask_after_it():
    """Bump that belongs to the surface itself changes the normal of all of its nodes."""
    graph = occluded()
    graph.normal = graph.add("bevel", "normal")
    compiled = compile_graph(graph)
    assert compiled.rays == NodeRayCounts(2, 2, 5)
    assert "node_bevel(surface, 0u, 0u," in compiled.text
    assert "node_ambient_occlusion(surface, 0, 0, 1u, 1u," in compiled.text


def test_a_ray_from_anywhere_takes_two_places_of_what_is_found():
    """And has the program that traces it know of such rays, which that of others does not."""
    graph = occluded()
    graph.normal = graph.add("raycast", "hit_normal")
    compiled = compile_graph(graph)
    assert compiled.rays == NodeRayCounts(3, 2, 5, True) and not compile_graph(occluded()).rays.casts
    assert "node_raycast(surface, 0, 0u, 0u, world_position(surface), surface.normal," in compiled.text
    assert "node_ambient_occlusion(surface, 0, 0, 2u, 1u," in compiled.text


def test_worlds_trace_no_rays():
    compiled = compile_graph(occluded("bevel"), traces_rays=False)
    assert compiled.rays == NodeRayCounts() and "node_rays.glsl" not in compiled.text
    assert compile_graph(textured()).rays == NodeRayCounts()

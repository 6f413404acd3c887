# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes' node graphs taken apart."""

import numpy as np
import pytest
from support.graphs import surface_graph

from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.materials.compiler.scene_graphs import SceneGraphs
from rppm_addon.materials.nodes import KINDS
from rppm_addon.materials.records import PhaseFunctionKind
from rppm_addon.materials.traits.interiors import Interior, Variation
from rppm_addon.scene import Camera, Link, Material, NodeGraph, Scene

KIND = PhaseFunctionKind


def sum_of(graph: NodeGraph, *shaders: Link) -> NodeGraph:
    """The graph with the sum of shaders as its volume."""
    graph.surface = shaders[0]
    for shader in shaders[1:]:
        graph.surface = graph.add("add_shader", "shader", shader=graph.surface, shader_001=shader)
    return graph


def volume(density=1.0, strength=1.0):
    """Absorption and emission, added."""
    graph = NodeGraph()
    absorption = graph.add("volume_absorption", "volume", color=(0.5, 0.5, 0.5), density=density)
    return sum_of(graph, absorption, graph.add("emission", "emission", strength=strength))


def shaders(graph: NodeGraph) -> list[tuple[int, dict[str, object]]]:
    """Numbers and options of the shaders that a graph adds up."""
    found, pending = [], [graph.surface]
    while pending:
        link = pending.pop()
        node = graph.nodes[link.node]
        inputs = [node.inputs[name] for name in ("shader", "shader_001") if name in node.inputs]
        pending += inputs
        if node.kind not in ("mix_shader", "add_shader"):
            found.append((link.node, node.options))
    compile_graph(graph)
    return sorted(found, key=lambda entry: entry[0])


def value_of(*values: float):
    """An evaluation of graphs that gives the same for each."""
    return lambda graph: np.array([[values]], np.float32)


def test_nothing_is_in_a_body_without_a_volume():
    assert Interior.of(None) == Interior()


def test_each_part_is_without_the_other():
    interior = Interior.of(volume())
    assert [number for number, _ in shaders(interior.absorption)] == [0]
    assert [number for number, _ in shaders(interior.emission)] == [1]
    assert not interior.varies and not interior.scattering


def test_what_is_zero_is_no_part():
    assert Interior.of(volume(strength=0.0)).emission is None
    assert Interior.of(volume(density=0.0)).absorption is None
    assert Interior.of(surface_graph("volume_scatter", color=0.0)) == Interior()
    assert Interior.of(surface_graph("volume_principled", density=0.0)) == Interior()


def test_surfaces_say_nothing_of_a_volume():
    glowing = surface_graph("bsdf_principled", emission_strength=1.0)
    assert Interior.of(glowing) == Interior()
    graph = NodeGraph()
    fog = graph.add("volume_scatter", "volume")
    interior = Interior.of(sum_of(graph, fog, graph.add("bsdf_diffuse", "bsdf")))
    assert [number for number, _ in shaders(interior.scattering[0].coefficient)] == [0]


@pytest.mark.parametrize("kind", ["volume_coefficients", "volume_principled"])
def test_a_node_of_all_parts_is_in_each_by_an_option(kind):
    given = {"emission_coefficients": 1.0} if kind == "volume_coefficients" else {"emission_strength": 1.0}
    interior = Interior.of(surface_graph(kind, **given))
    graphs = {
        "ABSORPTION": interior.absorption,
        "EMISSION": interior.emission,
        "SCATTERING": interior.scattering[0].coefficient,
    }
    for coefficient, graph in graphs.items():
        ((_, options),) = shaders(graph)
        assert options["coefficient"] == coefficient


def test_gas_glows_by_its_temperature():
    assert Interior.of(surface_graph("volume_principled")).emission is None
    assert Interior.of(surface_graph("volume_principled", blackbody_intensity=1.0)).emission is not None


@pytest.mark.parametrize(
    ("phase", "inputs", "kinds", "parameters"),
    [
        ("HENYEY_GREENSTEIN", {"anisotropy": 0.25}, [KIND.HENYEY_GREENSTEIN], [(0.25,)]),
        ("HENYEY_GREENSTEIN", {"anisotropy": -1.0}, [KIND.HENYEY_GREENSTEIN], [(-0.999,)]),
        ("DRAINE", {"anisotropy": 0.5, "alpha": 2.0}, [KIND.DRAINE], [(0.5, 2.0)]),
        ("RAYLEIGH", {}, [KIND.RAYLEIGH], [()]),
        ("FOURNIER_FORAND", {"ior": 1.33, "backscatter": 0.1}, [KIND.FOURNIER_FORAND], [(1.33, -0.3892)]),
        ("MIE", {"diameter": 20.0}, [KIND.HENYEY_GREENSTEIN, KIND.DRAINE], [(0.99461,), (0.59379, 27.1137)]),
    ],
)
def test_phase_functions(phase, inputs, kinds, parameters):
    graph = NodeGraph()
    graph.surface = graph.add("volume_scatter", "volume", options={"phase": phase}, **inputs)
    parts = Interior.of(graph).scattering
    assert [part.kind for part in parts] == kinds
    for part, expected in zip(parts, parameters, strict=True):
        found = part.parameters(value_of(np.nan))
        np.testing.assert_allclose(found[: len(expected)], expected, rtol=1e-3)
        assert [number for number, _ in shaders(part.coefficient)] == [0]


def test_the_lobes_of_droplets_share_the_coefficient():
    graph = NodeGraph()
    graph.surface = graph.add("volume_scatter", "volume", options={"phase": "MIE"})
    lobes = [shaders(part.coefficient)[0][1]["mie_lobe"] for part in Interior.of(graph).scattering]
    assert lobes == ["HENYEY_GREENSTEIN", "DRAINE"]


def test_each_node_scatters_by_its_own_phase_function():
    graph = NodeGraph()
    forward = graph.add("volume_scatter", "volume", anisotropy=0.9)
    backward = graph.add("volume_scatter", "volume", anisotropy=-0.5)
    graph.surface = graph.add("mix_shader", "shader", fac=0.25, shader=forward, shader_001=backward)
    parts = Interior.of(graph).scattering
    assert [part.parameters(value_of(0.0))[0] for part in parts] == [0.9, -0.5]
    assert [[number for number, _ in shaders(part.coefficient)] for part in parts] == [[0], [1]]


def test_linked_inputs_of_phase_functions_are_evaluated():
    graph = NodeGraph()
    double = graph.add("math", "value", value=0.1, value_001=0.2)
    graph.surface = graph.add("volume_scatter", "volume", options={"phase": "DRAINE"}, anisotropy=double, alpha=7.0)
    interior = Interior.of(graph)
    (part,) = interior.scattering
    assert part.inputs in interior.graphs and part.inputs not in interior.coefficients
    compile_graph(part.inputs)
    assert part.parameters(value_of(0.3, 7.0, 0.0))[:2] == pytest.approx((0.3, 7.0))


def test_textures_vary():
    for kind in ("volume_absorption", "volume_scatter", "volume_principled"):
        graph = NodeGraph()
        place = graph.add("tex_coord", "object")
        noise = graph.add("tex_noise", "fac", vector=place)
        graph.surface = graph.add(kind, "volume", density=noise)
        assert Interior.of(graph).varies
        assert not Interior.of(surface_graph(kind)).varies


@pytest.mark.parametrize("linked", ["density", "anisotropy"])
def test_phase_functions_that_vary_are_named(linked):
    fog = NodeGraph()
    noise = fog.add("tex_noise", "fac", vector=fog.add("tex_coord", "object"))
    fog.surface = fog.add("volume_scatter", "volume", **{linked: noise})
    scene = Scene(Camera(np.eye(4), (-1, 1, -1, 1), 1, 1), materials=[Material("Fog", interior=fog)])
    SceneGraphs(scene, scene.materials)
    told = {
        "density": [],
        "anisotropy": ['The volume of material "Fog" has a phase function that varies from place to place'],
    }[linked]
    assert len(scene.warnings) == len(told)
    assert all(warning.startswith(start) for warning, start in zip(scene.warnings, told, strict=True))


def test_grids_that_are_not_there_do_not_vary():
    graph = NodeGraph()
    density = graph.add("grid_attribute", "fac", attribute="density")
    graph.surface = graph.add("volume_principled", "volume", density_grid=density)
    assert not Interior.of(graph).varies
    assert Interior.of(graph, reads_grids=True).variation is Variation.PLACE_IN_OBJECT


@pytest.mark.parametrize(
    ("kind", "output", "expected"),
    [
        ("tex_coord", "object", Variation.PLACE_IN_OBJECT),
        ("generated_coord", "generated", Variation.PLACE_IN_OBJECT),
        ("new_geometry", "position", Variation.PLACE),
        ("object_info", "color", Variation.OBJECT),
        ("light_path", "ray_length", Variation.NOTHING),
    ],
)
def test_variables_of_a_volume(kind, output, expected):
    graph = NodeGraph()
    density = graph.add(kind, output)
    graph.surface = graph.add("volume_absorption", "volume", density=density)
    assert Interior.of(graph).variation is expected


def test_all_volume_kinds_compile():
    for kind, declared in KINDS.items():
        if declared.source == "volumes.glsl":
            compile_graph(surface_graph(kind))

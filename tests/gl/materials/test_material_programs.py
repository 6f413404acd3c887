# SPDX-License-Identifier: GPL-3.0-or-later
"""When programs of materials are compiled, and what stands in for those that cannot be."""

import copy
import dataclasses
import logging

import numpy as np
import pytest
import scenes
from rendering import iterated, radiance_of
from support import every_node

from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.materials.compiler import compiler
from rppm_addon.materials.nodes import KINDS
from rppm_addon.scene import AttributeDomain, Image, Material, MeshAttribute, NodeGraph, Scene


def shown(*graphs: NodeGraph) -> Scene:
    """The room, its floor and walls of the given graphs in turn."""
    scene = scenes.room(16, iterations=1, photons=1024, cubemap_resolution=16)
    scene.materials += [Material(f"graph {k}", graph) for k, graph in enumerate(graphs)]
    first = len(scene.materials) - len(graphs)
    for k, instance in enumerate(scene.instances[:5]):
        instance.materials = [first + k % len(graphs)]
    scene.images = [
        Image("a", np.full((2, 2, 4), 128, np.uint8), "SRGB"),
        Image("b", np.full((4, 4, 4), 0.25, np.float32)),
    ]
    for mesh in scene.meshes:
        for name in ("heat", "cold"):
            mesh.attributes[name] = MeshAttribute(
                AttributeDomain.POINT, np.full((len(mesh.positions), 1), 0.5, np.float32)
            )
    return scene


def picture(mapper: ProgressivePhotonMapper, scene: Scene) -> np.ndarray:
    radiance = radiance_of(mapper, scene)
    assert np.isfinite(radiance).all()
    return radiance[..., :3]


def painted(scale=5.0, color=(0.8, 0.2, 0.1), image=0, attribute="heat", table=None) -> NodeGraph:
    graph = NodeGraph()
    heat = graph.add("attribute", "fac", attribute=attribute)
    table = np.full((257, 4), 0.5, np.float32) if table is None else table
    ramp = graph.add("val_to_rgb", "color", table=table, fac=heat)
    place = graph.add("tex_coord", "uv")
    picture = graph.add("tex_image", "color", image=image, vector=place)
    position = graph.add("new_geometry", "position")
    noise = graph.add("tex_noise", "fac", options={"noise_dimensions": "3D", "noise_type": "FBM"}, vector=position,
                      scale=scale)  # fmt: skip
    mixed = graph.add("mix_color", "result_color", factor_float=noise, a_color=ramp, b_color=picture)
    both = graph.add("mix_color", "result_color", options={"blend_type": "MULTIPLY"}, factor_float=1.0, a_color=mixed,
                     b_color=color)  # fmt: skip
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=both)
    return graph


@pytest.mark.parametrize(
    "change",
    [
        {"scale": 2.0}, {"color": (0.1, 0.3, 0.9)}, {"image": 1}, {"attribute": "cold"},
        {"table": np.full((257, 4), 0.9, np.float32)},
    ],
)  # fmt: skip
def test_moving_a_slider_compiles_nothing(mapper, library, change):
    before = picture(mapper, shown(painted()))
    made = library.made
    after = picture(mapper, shown(painted(**change)))
    assert library.made == made
    if "attribute" not in change:  # whose values are the same
        assert np.abs(after - before).max() > 1e-3 * before.mean()


def test_moving_sliders_of_worlds_and_lights_compiles_nothing(mapper, library):
    def lit(strength: float) -> Scene:
        scene = shown(gray())
        for owner, kind in ((scene.world, "background"), (scene.lights[0], "emission")):
            owner.graph = NodeGraph()
            owner.graph.surface = owner.graph.add(kind, kind, color=(strength, 0.5, 0.5), strength=strength)
        return scene

    before = picture(mapper, lit(1.0))
    made = library.made
    after = picture(mapper, lit(2.0))
    assert library.made == made and after.mean() > 1.2 * before.mean()


def test_another_structure_compiles_one_program(mapper, library):
    picture(mapper, shown(painted()))
    made = library.made
    graph = painted()
    graph.nodes[-1].kind, graph.nodes[-1].inputs["roughness"] = "bsdf_diffuse", graph.nodes[-1].inputs["color"]
    picture(mapper, shown(graph))
    assert library.made == made + 1


def test_materials_of_one_structure_share_a_program(mapper, library):
    picture(mapper, shown(painted()))
    made = library.made
    picture(mapper, shown(*(painted(color=(k / 5, 0.5, 0.5)) for k in range(5))))
    assert library.made == made


def test_the_programs_of_a_scene_are_its_structures(mapper):
    mapper.build(shown(painted(), painted(scale=3.0), NodeGraph()))
    # The room's own diffuse, glass and mirror; the painted and the black one.
    assert len(mapper.device_scene.materials.programs) == 5


@pytest.mark.parametrize("count", [100, pytest.param(500, marks=pytest.mark.long)])
def test_a_long_chain_of_nodes(mapper, count):
    graph = NodeGraph()
    value = graph.add("attribute", "fac", attribute="heat")
    for _ in range(count):
        value = graph.add("math", "value", options={"operation": "ADD"}, value=value, value_001=0.5 / count)
    graph.surface = graph.add("emission", "emission", color=value)
    scene = shown(graph)
    radiance = picture(mapper, scene)
    assert radiance.max() > 0.9 and scene.warnings == []


def test_pieces_of_a_long_function_compute_the_same_bits(mapper, monkeypatch):
    graph = NodeGraph()
    value = graph.add("attribute", "fac", attribute="heat")
    for number in range(70):
        operation = ("ADD", "MULTIPLY", "SINE")[number % 3]
        value = graph.add("math", "value", options={"operation": operation}, value=value, value_001=0.7 + 0.01 * number)
        if number % 10 == 9:
            value = graph.add("mix_rgb", "color", fac=0.3, color1=(0.9, 0.2, 0.1), color2=value)
    graph.surface = graph.add("emission", "emission", color=value)
    made = picture(mapper, shown(graph))
    monkeypatch.setattr(compiler, "in_pieces", list)
    np.testing.assert_array_equal(made, picture(mapper, shown(graph)))
    assert np.ptp(made) > 0.1


def unknown() -> NodeGraph:
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_of_tomorrow", "bsdf", name="New")
    return graph


def gray() -> NodeGraph:
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=0.8)
    return graph


def test_an_unknown_kind_is_gray(mapper, caplog):
    expected = picture(mapper, shown(gray()))
    scene = shown(unknown())
    with caplog.at_level(logging.WARNING):
        np.testing.assert_allclose(picture(mapper, scene), expected, rtol=1e-4, atol=1e-6)
    (warning,) = scene.warnings
    assert 'Material "graph 0"' in warning and '"New"' in warning and warning in caplog.messages
    mapper.build(scene)
    assert scene.warnings == [warning]  # said once


def test_what_the_driver_refuses_is_gray(mapper, monkeypatch):
    """A node whose GLSL calls a function that is not there."""
    expected = picture(mapper, shown(gray()))
    broken = copy.copy(KINDS["gamma"])
    monkeypatch.setitem(KINDS, "broken", broken)
    graph = NodeGraph()
    color = graph.add("broken", "color", name="Broken", color=0.5, gamma=2.0)
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=color)
    scene = shown(graph, gray())
    np.testing.assert_allclose(picture(mapper, scene), expected, rtol=1e-4, atol=1e-6)
    (warning,) = scene.warnings
    assert 'Material "graph 0"' in warning and "node_broken" in warning and "\n" not in warning


def test_bad_graphs_of_worlds_and_lights_give_nothing(mapper):
    scene = shown(gray())
    scene.world.graph = unknown()
    scene.lights.append(dataclasses.replace(scene.lights[0], name="refused", graph=unknown()))
    scene.materials[0].interior = unknown()
    expected = picture(mapper, shown(gray()))
    np.testing.assert_allclose(picture(mapper, scene).mean(), expected.mean(), rtol=0.2)
    assert len(scene.warnings) == 3
    assert any("The world" in text for text in scene.warnings)
    assert any('Light "refused"' in text for text in scene.warnings)


def test_bump_turns_the_normal_by_the_slope_of_its_height(mapper):
    """A height of 0.3 x: the normal of a floor is that of a plane of this slope."""
    slope = 0.3
    graph = NodeGraph()
    x = graph.add("separate_xyz", "x", vector=graph.add("new_geometry", "position"))
    height = graph.add("math", "value", options={"operation": "MULTIPLY"}, value=x, value_001=slope)
    normal = graph.add("bump", "normal", height=height)
    shown_normal = graph.add("vector_math", "vector", options={"operation": "MULTIPLY_ADD"}, vector=normal,
                             vector_001=0.5, vector_002=0.5)  # fmt: skip
    graph.surface = graph.add("emission", "emission", color=shown_normal)
    scene = shown(graph)
    scene.settings.filter_width = 0.0
    floor = scene.instances[0]
    scene.instances, floor.materials = [floor], [len(scene.materials) - 1]
    iterated(mapper, scene)
    depth, normals = mapper.film.read_passes().values()
    seen = (normals[..., 2] > 0.99) & (depth < 1e9)
    found = 2.0 * mapper.film.read_radiance()[seen][:, :3] - 1.0
    assert seen.sum() > 10
    np.testing.assert_allclose(found, np.tile([-slope, 0.0, 1.0] / np.hypot(1.0, slope), (seen.sum(), 1)), atol=2e-3)


NODES = every_node.programs()


@pytest.mark.parametrize("source", every_node.SOURCES)
def test_kinds_of_a_file_compile(library, source):
    library.compute("surfaces/resolve/resolve.comp", inserts={"materials/generated.glsl": NODES[source]})


def test_kinds_have_no_names_in_common(library):
    """All files in one program: no function or constant may have the name of another's."""
    text = "".join(f'#include "materials/nodes/{source}"\n' for source in every_node.SOURCES)
    text += "void evaluate_material(Surface surface, uint first, inout ClosureBuilder builder) {}\n"
    library.compute("surfaces/resolve/resolve.comp", inserts={"materials/generated.glsl": text})

# SPDX-License-Identifier: GPL-3.0-or-later
"""Media whose coefficients vary from place to place, or from object to object: closed forms of what they leave of the
light behind them, and of what they emit."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Instance, Light, LightKind, Material, NodeGraph, RenderSettings, Scene, World

SIZE = 8
COLOR = np.array([0.2, 0.5, 1.0])
"""Absorption of a density of 1, 1/m."""


def body_of(density=None, strength=None, place=("tex_coord", "object"), color=COLOR) -> Material:
    """A medium whose density and emission are functions of a place: each adds math nodes to a graph and returns the
    last."""
    graph = NodeGraph()
    at = graph.add(place[0], place[1])
    graph.surface = graph.add(
        "volume_absorption", "volume", color=tuple(1.0 - color), density=0.0 if density is None else density(graph, at)
    )
    if strength is not None:
        emission = graph.add("emission", "emission", color=(1.0, 1.0, 1.0), strength=strength(graph, at))
        graph.surface = graph.add("add_shader", "shader", shader=graph.surface, shader_001=emission)
    return Material("body", material("body", Lobe(LobeKind.TRANSPARENT)).graph, graph)


def linear(axis: int, slope: float, offset: float):
    """slope times a coordinate plus offset."""

    def function(graph: NodeGraph, at):
        parts = graph.add("separate_xyz", "xyz"[axis], vector=at)
        options = {"operation": "MULTIPLY_ADD"}
        return graph.add("math", "value", options=options, value=parts, value_001=slope, value_002=offset)

    return function


def scene_of(body: Material, matrix: np.ndarray | None = None, camera: Camera | None = None, **settings) -> Scene:
    """A cube of side 2 before a white world, seen from above in parallel rays."""
    camera = camera or scenes.camera((0, 0, 5), (0, 0, 0), 0.5, SIZE, orthographic=True)
    settings = {"iterations": 16, "photons": 16, "filter_width": 0.0} | settings
    instance = Instance(0, np.eye(4) if matrix is None else matrix, [0])
    return Scene(
        camera, [scenes.box("box")], [instance], [body], [], World(np.ones(3)), settings=RenderSettings(**settings)
    )


def picture(renderer, scene: Scene) -> np.ndarray:
    frame = renderer.render(scene).frame
    assert scene.warnings == []
    return frame.combined[..., :3]


def pixels() -> np.ndarray:
    return ((np.arange(SIZE) + 0.5) / SIZE - 0.5)[None, :, None]


def test_an_even_slab(renderer):
    seen = picture(renderer, scene_of(body_of(linear(0, 0.0, 0.7)), iterations=1))
    np.testing.assert_allclose(seen, np.broadcast_to(np.exp(-0.7 * COLOR * 2.0), seen.shape), rtol=1e-3)


@pytest.mark.parametrize("slope", [0.5, -2.0])
def test_a_slab_graded_across_the_rays(renderer, slope):
    seen = picture(renderer, scene_of(body_of(linear(0, slope, 2.0)), iterations=64))
    np.testing.assert_allclose(
        seen, np.broadcast_to(np.exp(-(2.0 + slope * pixels()) * COLOR * 2.0), seen.shape), rtol=1.5e-2
    )


def test_a_slab_graded_along_the_rays(renderer):
    """A density of 1 + z, of which half lies behind a card in the middle."""
    scene = scene_of(body_of(linear(2, 1.0, 1.0)))
    np.testing.assert_allclose(picture(renderer, scene)[0, 0], np.exp(-2.0 * COLOR), rtol=3e-3)
    scenes.add(scene, scenes.square("card", 0.9), material("glow", Lobe(LobeKind.EMISSION)))
    np.testing.assert_allclose(picture(renderer, scene)[0, 0], np.exp(-1.5 * COLOR), rtol=1e-2)


def test_a_body_turned_and_scaled(renderer):
    """Densities are those by length in the world, at places in the object."""
    scene = scene_of(body_of(linear(0, 0.5, 1.0)), scenes.placed(0.1, 0.0, 0.0, 2.0) @ np.diag([-1.0, -1.0, 0.5, 1.0]))
    seen = picture(renderer, scene)
    density = 1.0 - 0.5 * (pixels() - 0.1) / 2.0
    np.testing.assert_allclose(seen, np.broadcast_to(np.exp(-density * COLOR * 2.0), seen.shape), rtol=2e-2)


def test_the_place_in_the_world(renderer):
    body = body_of(linear(0, 0.5, 1.0), place=("new_geometry", "position"))
    seen = picture(renderer, scene_of(body, scenes.placed(0.1, 0.0, 0.0)))
    np.testing.assert_allclose(
        seen, np.broadcast_to(np.exp(-(1 + 0.5 * pixels()) * COLOR * 2.0), seen.shape), rtol=1e-2
    )


def test_each_instance_has_its_own_medium(renderer):
    """Two cubes of one material beside each other, of the colors of their objects; then one that moves."""
    graph = NodeGraph()
    color = graph.add("object_info", "color")
    graph.surface = graph.add("volume_absorption", "volume", color=color, density=1.0)
    scene = scene_of(Material("body", material("body", Lobe(LobeKind.TRANSPARENT)).graph, graph))
    colors = (0.5, 0.75, 1.0), (1.0, 0.5, 0.25)
    scene.instances = [
        Instance(0, scenes.placed(x, 0.0, 0.0, 0.25), [0], color=(*color, 1.0))
        for x, color in zip((-0.25, 0.25), colors, strict=True)
    ]
    for first, second in (colors, colors[::-1]):
        seen = picture(renderer, scene)
        left, right = (np.exp(-(1.0 - np.array(color)) * 0.5) for color in (first, second))
        np.testing.assert_allclose(seen[3, :4], np.broadcast_to(left, (4, 3)), rtol=1e-3)
        np.testing.assert_allclose(seen[3, 4:], np.broadcast_to(right, (4, 3)), rtol=1e-3)
        moved = [dataclasses.replace(instance, matrix=scenes.placed(-x, 0.0, 0.0, 0.25))
                 for instance, x in zip(scene.instances, (-0.25, 0.25), strict=True)]  # fmt: skip
        scene = dataclasses.replace(scene, instances=moved)


def test_emission_of_a_graded_medium(renderer):
    """Emission grows downward, where more of it is absorbed on the way up."""
    scene = scene_of(body_of(linear(2, 0.0, 0.8), linear(2, -0.5, 1.0)))
    scene.world = World(np.zeros(3))
    t = 2.0 * (np.arange(4000) + 0.5) / 4000
    emission = 1.0 - 0.5 * (1.0 - t)
    expected = (emission[:, None] * np.exp(-0.8 * COLOR * t[:, None])).mean(axis=0) * 2.0
    np.testing.assert_allclose(picture(renderer, scene)[0, 0], expected, rtol=5e-3)


def test_a_world_that_varies_is_rendered_around_the_scene(renderer):
    scene = scene_of(material("clear", Lobe(LobeKind.TRANSPARENT)))
    scene.world = dataclasses.replace(
        scene.world, volume=body_of(linear(0, 0.5, 1.0), place=("new_geometry", "position")).interior
    )
    seen = renderer.render(scene).frame.combined[..., :3]
    assert any("around the scene only" in warning for warning in scene.warnings)
    length = 5.0 - scene.camera.clip_start + 1.0 + 1.0  # down to the margin of half of the cube's side below the cube
    np.testing.assert_allclose(
        seen, np.broadcast_to(np.exp(-(1.0 + 0.5 * pixels()) * COLOR * length), seen.shape), rtol=1e-1
    )


def test_a_camera_within_a_medium(renderer):
    camera = scenes.camera((0, 0, 0.5), (0, 0, -1), 0.5, SIZE, orthographic=True)
    seen = picture(renderer, scene_of(body_of(linear(2, 1.0, 1.0)), camera=camera))
    z = 0.5 - camera.clip_start
    length = (0.5 * z**2 + z) + 0.5  # of densities 1 + z, from the camera down to -1
    np.testing.assert_allclose(seen, np.broadcast_to(np.exp(-COLOR * length), seen.shape), rtol=1e-2)


def scattering(varies: bool) -> Scene:
    """Fog in a cube over a floor, beside a lamp, whose density nodes may give."""
    graph = NodeGraph()
    at = graph.add("tex_coord", "object")
    density = linear(0, 0.0, 1.0)(graph, at) if varies else 1.0
    graph.surface = graph.add("volume_scatter", "volume", color=(0.9, 0.6, 0.3), density=density, anisotropy=0.3)
    fog = Material("fog", material("clear", Lobe(LobeKind.TRANSPARENT)).graph, graph)
    scene = scene_of(fog, camera=scenes.camera((0, 0, 5), (0, 0, 0), 0.3, SIZE), iterations=4, photons=4000)
    scenes.add(scene, scenes.square("floor", 4.0, -1.2), scenes.diffuse(0.7, 0.6, 0.5))
    scene.lights.append(Light("lamp", LightKind.POINT, scenes.placed(1.5, 0.5, 1.5), np.full(3, 20.0)))
    return scene


@pytest.mark.long
def test_fog_scatters_on_a_grid_as_without_one(renderer):
    """The same random numbers give the same places where light is scattered."""
    even, on_a_grid = (picture(renderer, scattering(varies)) for varies in (False, True))
    np.testing.assert_allclose(on_a_grid, even, rtol=1e-3, atol=1e-4)


def infinite(graph: NodeGraph, at):
    large = linear(0, 0.0, 1e38)(graph, at)
    return graph.add("math", "value", options={"operation": "MULTIPLY"}, value=large, value_001=large)


def no_number(graph: NodeGraph, at):
    infinity = infinite(graph, at)
    return graph.add("math", "value", options={"operation": "SUBTRACT"}, value=infinity, value_001=infinity)


@pytest.mark.parametrize("density", [infinite, no_number, linear(0, 0.0, -3.0)])
def test_a_density_that_cannot_be_rendered_counts_as_none(renderer, density):
    seen = picture(renderer, scene_of(body_of(density), iterations=1))
    np.testing.assert_array_equal(seen, 1.0)


def test_a_density_of_a_million_leaves_nothing(renderer):
    seen = picture(renderer, scene_of(body_of(linear(0, 0.0, 1e6)), iterations=1))
    np.testing.assert_array_equal(seen, 0.0)


def test_grids_larger_than_memory_have_larger_voxels(renderer, monkeypatch):
    monkeypatch.setattr("rppm_addon.materials.media.grids.MAX_GRID_BYTES", 1 << 16)
    scene = scene_of(body_of(linear(0, 0.5, 2.0)))
    seen = renderer.render(scene).frame.combined[..., :3]
    assert len(scene.warnings) == 1 and "voxels are made larger" in scene.warnings[0]
    np.testing.assert_allclose(
        seen, np.broadcast_to(np.exp(-(2.0 + 0.5 * pixels()) * COLOR * 2.0), seen.shape), rtol=3e-2
    )


@pytest.mark.parametrize("matrix", [np.zeros((4, 4)), np.full((4, 4), np.nan), np.diag([1.0, 1.0, 0.0, 1.0])])
def test_a_body_without_a_place(renderer, matrix):
    """It is a picture of the world."""
    frame = renderer.render(scene_of(body_of(linear(0, 0.5, 2.0)), matrix, iterations=1)).frame
    assert np.isfinite(frame.combined).all()

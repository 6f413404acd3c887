# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights in smooth surfaces that reflect little: they are found in every iteration, and once."""

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Light, LightKind, Material, Mesh, NodeGraph, RayVisibility, Scene
from rppm_addon.scene.settings import DirectLight

RADIANCE = 7.0
GLASS = material("glass", Lobe(LobeKind.GLASS, ior=1.5))
NORMAL_REFLECTANCE = 0.04
VARNISH = material(
    "varnish", Lobe(LobeKind.DIFFUSE, color=(0.5, 0.5, 0.5)), Lobe(LobeKind.GLOSSY, color=(NORMAL_REFLECTANCE,) * 3)
)
SHINING = material("shining", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0), strength=RADIANCE))
SHEET = scenes.square("sheet", 1.0)
"""2 m wide."""


def light(height: float) -> Light:
    """2 m wide, shines down on the floor."""
    return Light("light", LightKind.AREA, scenes.placed(0, 0, height), np.full(3, RADIANCE), size=(2.0, 2.0))


def reflecting_floor(surface, *lights: Light, occluder: bool = False, **settings: object) -> Scene:
    """Seen from 1 m above it, at right angles; what it reflects is above the camera, which hides nothing.

    occluder: a black sheet over the half with x > 0, between camera and lights.
    """
    over_half = scenes.rectangle("sheet", (0, -2, 1.5), (2, -2, 1.5), (2, 2, 1.5), (0, 2, 1.5))
    parts = [(scenes.square("floor", 2.0), surface), *[(over_half, scenes.diffuse(0, 0, 0))] * occluder]
    camera = Camera(scenes.placed(0, 0, 1), (-0.02, 0.02, -0.02, 0.02), 16, 16)
    return scenes.scene_of(camera, *parts, lights=lights, **{"photons": 64, "iterations": 1} | settings)


def seen(renderer, scene: Scene) -> np.ndarray:
    return renderer.render(scene).frame.combined[..., :3]


def assert_found_by_paths(picture: np.ndarray) -> None:
    """The mean is right: in 64 iterations one path in 25 reflects, each with a deviation of its own size."""
    assert abs(picture.mean() / (NORMAL_REFLECTANCE * RADIANCE) - 1.0) < 5 / np.sqrt(64 * 256 * NORMAL_REFLECTANCE)


def add_object(
    scene: Scene, mesh: Mesh, surface: Material, height: float, visibility: RayVisibility = RayVisibility.ALL
) -> None:
    scenes.add(scene, mesh, surface, scenes.placed(0, 0, height), visibility=visibility)


def shining_by(kind: str, output: str, operation: str, **inputs: float) -> Material:
    """Emits RADIANCE times a value of a node."""
    graph = NodeGraph()
    value = graph.add(kind, output, **({"vector": graph.add("new_geometry", "position")} if output == "x" else {}))
    strength = graph.add("math", "value", options={"operation": operation}, value=value, value_001=RADIANCE, **inputs)
    graph.surface = graph.add("emission", "emission", color=(1.0, 1.0, 1.0), strength=strength)
    return Material("shining", graph)


def light_irradiance(height: float) -> float:
    """In the middle of the floor, W/m^2."""
    x = (np.arange(200) + 0.5) / 100 - 1.0
    distance2 = x[:, None] ** 2 + x**2 + height**2
    return float(RADIANCE * (height**2 / distance2**2).sum() * 0.01**2)


def test_glass_reflects_a_light_in_each_iteration(renderer):
    picture = seen(renderer, reflecting_floor(GLASS, light(2.0)))
    # Fresnel's reflectance is flat where light comes at right angles.
    np.testing.assert_allclose(picture, NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)


@pytest.mark.parametrize("by_mesh", [False, True])
def test_what_is_hidden_is_not_reflected(renderer, by_mesh):
    scene = reflecting_floor(GLASS, *([] if by_mesh else [light(2.0)]), occluder=True)
    if by_mesh:
        add_object(scene, SHEET, SHINING, 2.0)
    picture = seen(renderer, scene)
    np.testing.assert_allclose(picture[:, :7], NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)
    np.testing.assert_array_equal(picture[:, 9:], 0.0)


@pytest.mark.parametrize("by_mesh", [False, True])
def test_lights_behind_each_other_are_all_reflected(renderer, by_mesh):
    scene = reflecting_floor(GLASS, light(2.0), *([] if by_mesh else [light(3.0)]))
    if by_mesh:
        add_object(scene, SHEET, SHINING, 3.0)
    # Equal ones: whichever is chosen.
    np.testing.assert_allclose(seen(renderer, scene), 2 * NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)


def test_one_shadow_ray_serves_reflection_and_diffuse_light(renderer):
    picture = seen(renderer, reflecting_floor(VARNISH, light(2.0), iterations=16))
    expected = 0.5 / np.pi * light_irradiance(2.0) + NORMAL_REFLECTANCE * RADIANCE
    deviation = picture.mean(-1).std() / expected
    assert abs(picture.mean() / expected - 1.0) < 5 * deviation / np.sqrt(picture[..., 0].size) + 1e-4
    assert deviation < 0.02  # the reflection alone, found by one path in 12, would make 0.25 of it


def test_lit_by_photons_paths_find_the_light(renderer):
    scene = reflecting_floor(GLASS, light(2.0), direct_light=DirectLight.PHOTONS, iterations=64)
    assert_found_by_paths(seen(renderer, scene))


def test_glass_reflects_an_emissive_mesh_in_each_iteration(renderer):
    scene = reflecting_floor(GLASS)
    add_object(scene, scenes.box("cube"), SHINING, 3.0)  # its upper side is hidden by the lower one
    np.testing.assert_allclose(seen(renderer, scene), NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)


def test_a_reflected_mesh_may_shine_differently_from_place_to_place(renderer):
    """By RADIANCE (1 + x)."""
    scene = reflecting_floor(GLASS)
    add_object(scene, SHEET, shining_by("separate_xyz", "x", "MULTIPLY_ADD", value_002=RADIANCE), 2.0)
    # Rays from 1 m above the floor, by it to 2 m above: three times as far off the axis as on the floor.
    x = 3 * 0.02 * ((np.arange(16) + 0.5) / 8 - 1)
    expected = np.broadcast_to(NORMAL_REFLECTANCE * RADIANCE * (1 + x), (16, 16))
    np.testing.assert_allclose(seen(renderer, scene)[..., 0], expected, rtol=0.012)  # a pixel is 0.0075 wide


def test_meshes_that_reflections_do_not_see_are_not_reflected(renderer):
    scene = reflecting_floor(GLASS)
    add_object(scene, SHEET, SHINING, 2.0, RayVisibility.ALL & ~RayVisibility.GLOSSY)
    np.testing.assert_array_equal(seen(renderer, scene), 0.0)


@pytest.mark.parametrize(
    ("surface", "visibility"),
    [
        (SHINING, RayVisibility.ALL & ~RayVisibility.SHADOW),
        (shining_by("light_path", "is_glossy_ray", "MULTIPLY"), RayVisibility.ALL),
    ],
    ids=["hides nothing from shadow rays", "shines by the path that comes to it"],
)
def test_meshes_that_are_left_to_paths_are_reflected_once(renderer, surface, visibility):
    scene = reflecting_floor(GLASS, iterations=64)
    add_object(scene, SHEET, surface, 2.0, visibility)
    assert_found_by_paths(seen(renderer, scene))

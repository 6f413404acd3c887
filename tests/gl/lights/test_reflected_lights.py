# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights in smooth surfaces that reflect little: they are found in every iteration, and once."""

import numpy as np
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import (
    Camera,
    DirectLight,
    Instance,
    Light,
    LightKind,
    Material,
    Mesh,
    NodeGraph,
    RayVisibility,
    RenderSettings,
    Scene,
)

RADIANCE = 7.0
GLASS = material("glass", Lobe(LobeKind.GLASS, ior=1.5))
NORMAL_REFLECTANCE = 0.04
VARNISH = material(
    "varnish", Lobe(LobeKind.DIFFUSE, color=(0.5, 0.5, 0.5)), Lobe(LobeKind.GLOSSY, color=(NORMAL_REFLECTANCE,) * 3)
)
SHINING = material("shining", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0), strength=RADIANCE))
CUBE = scenes.polygons(
    "cube",
    np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (0, 2)]),
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)],
)


def sheet() -> Mesh:
    """2 m wide."""
    return scenes.rectangle("sheet", (-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0))


def light(height: float) -> Light:
    """2 m wide, shines down on the floor."""
    return Light("light", LightKind.AREA, scenes.placed(0, 0, height), np.full(3, RADIANCE), size=(2.0, 2.0))


def reflecting_floor(surface, *lights: Light, occluder: bool = False, **settings: object) -> Scene:
    """Seen from 1 m above it, at right angles; what it reflects is above the camera, which hides nothing.

    occluder: a black sheet over the half with x > 0, between camera and lights.
    """
    meshes = [scenes.rectangle("floor", (-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0))]
    instances = [Instance(0, np.eye(4), [0])]
    if occluder:
        meshes.append(scenes.rectangle("sheet", (0, -2, 1.5), (2, -2, 1.5), (2, 2, 1.5), (0, 2, 1.5)))
        instances.append(Instance(1, np.eye(4), [1]))
    camera = Camera(scenes.placed(0, 0, 1), (-0.02, 0.02, -0.02, 0.02), 16, 16)
    settings = RenderSettings(photons=64, iterations=1, **settings)
    return Scene(camera, meshes, instances, [surface, scenes.diffuse(0, 0, 0)], list(lights), settings=settings)


def add_object(
    scene: Scene, mesh: Mesh, surface: Material, height: float, visibility: RayVisibility = RayVisibility.ALL
) -> None:
    scene.meshes.append(mesh)
    scene.materials.append(surface)
    placed = scenes.placed(0, 0, height)
    scene.instances.append(Instance(len(scene.meshes) - 1, placed, [len(scene.materials) - 1], visibility=visibility))


def shining_by_place() -> Material:
    """Emits RADIANCE (1 + x)."""
    graph = NodeGraph()
    place = graph.add("new_geometry", "position")
    x = graph.add("separate_xyz", "x", vector=place)
    strength = graph.add("math", "value", options={"operation": "MULTIPLY_ADD"}, value=x, value_001=RADIANCE,
                         value_002=RADIANCE)  # fmt: skip
    graph.surface = graph.add("emission", "emission", color=(1.0, 1.0, 1.0), strength=strength)
    return Material("shining by place", graph)


def shining_by_path() -> Material:
    """Emits RADIANCE to reflections and nothing else."""
    graph = NodeGraph()
    reflected = graph.add("light_path", "is_glossy_ray")
    strength = graph.add("math", "value", options={"operation": "MULTIPLY"}, value=reflected, value_001=RADIANCE)
    graph.surface = graph.add("emission", "emission", color=(1.0, 1.0, 1.0), strength=strength)
    return Material("shining by path", graph)


def light_irradiance(height: float) -> float:
    """In the middle of the floor, W/m^2."""
    x = (np.arange(200) + 0.5) / 100 - 1.0
    distance2 = x[:, None] ** 2 + x**2 + height**2
    return float(RADIANCE * (height**2 / distance2**2).sum() * 0.01**2)


def test_glass_reflects_a_light_in_each_iteration(renderer):
    seen = renderer.render(reflecting_floor(GLASS, light(2.0))).frame.combined[..., :3]
    # Fresnel's reflectance is flat where light comes at right angles.
    np.testing.assert_allclose(seen, NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)


def test_what_is_hidden_is_not_reflected(renderer):
    seen = renderer.render(reflecting_floor(GLASS, light(2.0), occluder=True)).frame.combined[..., :3]
    np.testing.assert_allclose(seen[:, :7], NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)
    np.testing.assert_array_equal(seen[:, 9:], 0.0)


def test_lights_behind_each_other_are_all_reflected(renderer):
    scene = reflecting_floor(GLASS, light(2.0), light(3.0))
    seen = renderer.render(scene).frame.combined[..., :3]
    np.testing.assert_allclose(seen, 2 * NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)  # equal ones: whichever is chosen


def test_one_shadow_ray_serves_reflection_and_diffuse_light(renderer):
    scene = reflecting_floor(VARNISH, light(2.0))
    scene.settings.iterations = 16
    seen = renderer.render(scene).frame.combined[..., :3]
    expected = 0.5 / np.pi * light_irradiance(2.0) + NORMAL_REFLECTANCE * RADIANCE
    deviation = seen.mean(-1).std() / expected
    assert abs(seen.mean() / expected - 1.0) < 5 * deviation / np.sqrt(seen[..., 0].size) + 1e-4
    assert deviation < 0.02  # the reflection alone, found by one path in 12, would make 0.25 of it


def test_lit_by_photons_paths_find_the_light(renderer):
    scene = reflecting_floor(GLASS, light(2.0), direct_light=DirectLight.PHOTONS)
    scene.settings.iterations = 64
    seen = renderer.render(scene).frame.combined[..., :3]
    # One path in 25 reflects, each with a deviation of its own size.
    assert abs(seen.mean() / (NORMAL_REFLECTANCE * RADIANCE) - 1.0) < 5 / np.sqrt(64 * 256 * NORMAL_REFLECTANCE)


def test_glass_reflects_an_emissive_mesh_in_each_iteration(renderer):
    scene = reflecting_floor(GLASS)
    add_object(scene, CUBE, SHINING, 2.0)  # its upper side is hidden by the lower one
    seen = renderer.render(scene).frame.combined[..., :3]
    np.testing.assert_allclose(seen, NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)


def test_a_reflected_mesh_may_shine_differently_from_place_to_place(renderer):
    scene = reflecting_floor(GLASS)
    add_object(scene, sheet(), shining_by_place(), 2.0)
    seen = renderer.render(scene).frame.combined[..., :3]
    # Rays from 1 m above the floor, by it to 2 m above: three times as far off the axis as on the floor.
    x = 3 * 0.02 * ((np.arange(16) + 0.5) / 8 - 1)
    expected = NORMAL_REFLECTANCE * RADIANCE * (1 + x)
    np.testing.assert_allclose(seen[..., 0], np.broadcast_to(expected, (16, 16)), rtol=0.012)  # a pixel is 0.0075 wide


def test_meshes_that_are_hidden_or_unseen_are_not_reflected(renderer):
    scene = reflecting_floor(GLASS, occluder=True)
    add_object(scene, sheet(), SHINING, 2.0)
    seen = renderer.render(scene).frame.combined[..., :3]
    np.testing.assert_allclose(seen[:, :7], NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)
    np.testing.assert_array_equal(seen[:, 9:], 0.0)
    scene = reflecting_floor(GLASS)
    add_object(scene, sheet(), SHINING, 2.0, RayVisibility.ALL & ~RayVisibility.GLOSSY)
    np.testing.assert_array_equal(renderer.render(scene).frame.combined[..., :3], 0.0)


def test_a_light_in_front_of_an_emissive_mesh(renderer):
    scene = reflecting_floor(GLASS, light(2.0))
    add_object(scene, sheet(), SHINING, 3.0)
    seen = renderer.render(scene).frame.combined[..., :3]
    np.testing.assert_allclose(seen, 2 * NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)  # equal ones: whichever is chosen


def test_meshes_that_are_left_to_paths_are_reflected_once(renderer):
    """One mesh hides nothing from shadow rays, and the other shines by the path that comes to it."""
    for surface, visibility in (
        (SHINING, RayVisibility.ALL & ~RayVisibility.SHADOW),
        (shining_by_path(), RayVisibility.ALL),
    ):
        scene = reflecting_floor(GLASS)
        add_object(scene, sheet(), surface, 2.0, visibility)
        scene.settings.iterations = 64
        seen = renderer.render(scene).frame.combined[..., :3]
        # One path in 25 reflects, each with a deviation of its own size.
        assert abs(seen.mean() / (NORMAL_REFLECTANCE * RADIANCE) - 1.0) < 5 / np.sqrt(64 * 256 * NORMAL_REFLECTANCE)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights in smooth surfaces that reflect little: they are found in every iteration, and once."""

import numpy as np
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, DirectLight, Instance, Light, LightKind, RenderSettings, Scene

RADIANCE = 7.0
GLASS = material("glass", Lobe(LobeKind.GLASS, ior=1.5))
NORMAL_REFLECTANCE = 0.04
VARNISH = material(
    "varnish", Lobe(LobeKind.DIFFUSE, color=(0.5, 0.5, 0.5)), Lobe(LobeKind.GLOSSY, color=(NORMAL_REFLECTANCE,) * 3)
)


def lamp(height: float) -> Light:
    """2 m wide, shines down on the floor."""
    return Light("lamp", LightKind.AREA, scenes.placed(0, 0, height), np.full(3, RADIANCE), size=(2.0, 2.0))


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


def lamp_irradiance(height: float) -> float:
    """In the middle of the floor, W/m^2."""
    x = (np.arange(200) + 0.5) / 100 - 1.0
    distance2 = x[:, None] ** 2 + x**2 + height**2
    return float(RADIANCE * (height**2 / distance2**2).sum() * 0.01**2)


def test_glass_reflects_a_lamp_in_each_iteration(renderer):
    seen = renderer.render(reflecting_floor(GLASS, lamp(2.0))).frame.combined[..., :3]
    # Fresnel's reflectance is flat where light comes at right angles.
    np.testing.assert_allclose(seen, NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)


def test_what_is_hidden_is_not_reflected(renderer):
    seen = renderer.render(reflecting_floor(GLASS, lamp(2.0), occluder=True)).frame.combined[..., :3]
    np.testing.assert_allclose(seen[:, :7], NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)
    np.testing.assert_array_equal(seen[:, 9:], 0.0)


def test_lamps_behind_each_other_are_all_reflected(renderer):
    scene = reflecting_floor(GLASS, lamp(2.0), lamp(3.0))
    seen = renderer.render(scene).frame.combined[..., :3]
    np.testing.assert_allclose(seen, 2 * NORMAL_REFLECTANCE * RADIANCE, rtol=2e-3)  # equal ones: whichever is chosen


def test_one_shadow_ray_serves_reflection_and_diffuse_light(renderer):
    scene = reflecting_floor(VARNISH, lamp(2.0))
    scene.settings.iterations = 16
    seen = renderer.render(scene).frame.combined[..., :3]
    expected = 0.5 / np.pi * lamp_irradiance(2.0) + NORMAL_REFLECTANCE * RADIANCE
    deviation = seen.mean(-1).std() / expected
    assert abs(seen.mean() / expected - 1.0) < 5 * deviation / np.sqrt(seen[..., 0].size) + 1e-4
    assert deviation < 0.02  # the reflection alone, found by one path in 12, would make 0.25 of it


def test_lit_by_photons_paths_find_the_lamp(renderer):
    scene = reflecting_floor(GLASS, lamp(2.0), direct_light=DirectLight.PHOTONS)
    scene.settings.iterations = 64
    seen = renderer.render(scene).frame.combined[..., :3]
    # One path in 25 reflects, each with a deviation of its own size.
    assert abs(seen.mean() / (NORMAL_REFLECTANCE * RADIANCE) - 1.0) < 5 / np.sqrt(64 * 256 * NORMAL_REFLECTANCE)

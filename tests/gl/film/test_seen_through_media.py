# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of first surfaces behind media that scatter light: mist, and the guides of denoisers."""

import numpy as np
import pytest
import scenes

from rppm_addon.scene import Camera, Instance, Material, Mist, NodeGraph, Scene, World
from rppm_addon.scene.settings import RenderSettings

SCATTERING, ABSORPTION = np.array([0.8, 0.4, 0.2]), np.array([0.2, 0.1, 0.3])
PASSES = ("Mist", "Normal", "Denoising Albedo", "Denoising Normal", "Denoising Depth", "Emission", "Environment")


def _cloud(glow: float) -> Material:
    surface, volume = NodeGraph(), NodeGraph()
    surface.surface = surface.add("volume_boundary", "bsdf")
    volume.surface = volume.add(
        "volume_coefficients",
        "volume",
        scatter_coefficients=tuple(SCATTERING),
        absorption_coefficients=tuple(ABSORPTION),
        emission_coefficients=(glow, glow, glow),
    )
    return Material("cloud", surface, volume)


def _passes(renderer, floor: bool, glow: float = 0.0, film: bool = False):
    """Passes in the middle of a picture of a cloud of 1 m, from above, over a gray floor or the world; and Combined."""
    camera = Camera(scenes.looking((0.0, 0.001, 2.0), (0.0, 0.0, 0.0)), (-0.01, 0.01, -0.01, 0.01), 8, 8)
    settings = RenderSettings(
        iterations=1,
        photons=64,
        passes=PASSES,
        light_groups=("world",),
        filter_width=0.0,
        film_transparent=film,
        use_final_gather=False,
    )
    world = World(np.ones(3), mist=Mist(0.0, 10.0, 1.0), light_group="world")
    scene = Scene(camera, [scenes.box("cloud", 0.5)], [], [_cloud(glow)], world=world, settings=settings)
    scene.instances.append(Instance(0, scenes.placed(0.0, 0.0, 0.5), [0]))
    if floor:
        scenes.add(scene, scenes.square("floor", 3.0), scenes.diffuse(0.5, 0.5, 0.5), scenes.placed(0.0, 0.0, -1.0))
    frame = renderer.render(scene).frame
    return {name: values[4, 4] for name, values in frame.passes.items()}, frame.combined[4, 4]


TRANSMITTANCE = np.exp(-(SCATTERING + ABSORPTION))
ALBEDO = SCATTERING / (SCATTERING + ABSORPTION)


def test_a_floor_behind_a_cloud(renderer):
    passes, _ = _passes(renderer, floor=True)
    seen = TRANSMITTANCE.mean()
    np.testing.assert_allclose(passes["Mist"], 1.0 - seen * (1.0 - 0.3), rtol=1e-3)
    np.testing.assert_allclose(passes["Normal"], (0.0, 0.0, 1.0), atol=1e-3)
    np.testing.assert_allclose(
        passes["Denoising Albedo"], ALBEDO * (1.0 - TRANSMITTANCE) + 0.5 * TRANSMITTANCE, rtol=1e-3
    )
    np.testing.assert_allclose(passes["Denoising Normal"], (0.0, 0.0, -1.0), atol=1e-3)
    np.testing.assert_allclose(passes["Denoising Depth"], seen, rtol=1e-3)  # from the cloud's bottom on


def test_a_cloud_before_the_world(renderer):
    passes, _ = _passes(renderer, floor=False)
    np.testing.assert_allclose(passes["Denoising Albedo"], ALBEDO * (1.0 - TRANSMITTANCE) + TRANSMITTANCE, rtol=1e-3)
    np.testing.assert_allclose(passes["Denoising Normal"], (0.0, 0.0, TRANSMITTANCE.mean() - 1.0), atol=1e-3)
    np.testing.assert_allclose(passes["Environment"], TRANSMITTANCE, rtol=1e-3)
    assert passes["Mist"] == 1.0


@pytest.mark.parametrize("floor", [True, False])
def test_a_cloud_that_glows_is_emission(renderer, floor):
    passes, combined = _passes(renderer, floor=floor, glow=0.2)
    extinction = SCATTERING + ABSORPTION
    np.testing.assert_allclose(passes["Emission"], 0.2 * (1.0 - np.exp(-extinction)) / extinction, rtol=1e-3)
    # It is in no light group, nor is its light on the floor, while all else is in the world's.
    others = combined[:3] - passes["Emission"]
    if floor:
        assert (others > 0.0).all() and (passes["Combined_world"] < others).all()
    else:
        np.testing.assert_allclose(passes["Combined_world"], others, rtol=1e-5)


def test_alpha_of_a_transparent_film_is_what_the_cloud_hides(renderer):
    _, combined = _passes(renderer, floor=False, film=True)
    np.testing.assert_allclose(combined[3], 1.0 - TRANSMITTANCE.mean(), rtol=1e-3)

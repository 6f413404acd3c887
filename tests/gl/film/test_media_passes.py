# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes and light groups of light that media scatter: they are parts of Combined."""

import numpy as np
import pytest
import scenes

from rppm_addon.integrator.common import band
from rppm_addon.scene import Instance, Light, LightKind, Material, NodeGraph, Scene, World
from rppm_addon.scene.passes import SCATTERED_LIGHT, VOLUME_LIGHT
from rppm_addon.scene.settings import DensityEstimation, DirectLight

KINDS = ("Diffuse", "Glossy", "Transmission")
VOLUME = tuple(entry.name for entry in VOLUME_LIGHT)
LIGHT = (*(entry.name for entry in SCATTERED_LIGHT), *VOLUME, "Emission", "Environment", "Caustics")
ROUNDING = {"rtol": 1e-5, "atol": 2e-6}
"""Tolerances for sums of some thousand floats that take turns in being large."""
RASTERIZED = {"use_final_gather": False, "density_estimation": DensityEstimation.RASTERIZED}
BY_PHOTONS = {"direct_light": DirectLight.PHOTONS, "use_final_gather": False}


def volume(scattering: float, emission: float = 0.0) -> NodeGraph:
    """The graph of an even medium: coefficient, 1/m, and emission, W/(m^3 sr)."""
    graph = NodeGraph()
    graph.surface = graph.add(
        "volume_coefficients",
        "volume",
        scatter_coefficients=(scattering, 0.5 * scattering, 0.7 * scattering),
        absorption_coefficients=(0.05, 0.1, 0.0),
        emission_coefficients=(emission, emission, 0.5 * emission),
        anisotropy=0.3,
    )
    return graph


def foggy(size: int = 24, glow: float = 0.1, **settings: object) -> Scene:
    """The room of all kinds of surfaces with a cloud that glows, in a world of thin fog."""
    settings = {"iterations": 2, "photons": 4096, "passes": LIGHT, "volume_bounces": 8} | settings
    scene = scenes.crowded_room(size, **settings)
    surface = NodeGraph()
    surface.surface = surface.add("volume_boundary", "bsdf")
    scene.materials.append(Material("cloud", surface, volume(2.0, glow)))
    scene.meshes.append(scenes.box("cloud"))
    matrix = scenes.placed(0.1, 0.0, 0.6, 0.3)
    scene.instances.append(Instance(len(scene.meshes) - 1, matrix, [len(scene.materials) - 1]))
    scene.world = World(np.array([0.2, 0.3, 0.6]), volume=volume(0.1, 0.2 * glow))
    return scene


def recombined(passes: dict[str, np.ndarray]) -> np.ndarray:
    """(H, W, 3) of what Combined is made of."""
    parts = (passes[f"{kind} Color"] * (passes[f"{kind} Direct"] + passes[f"{kind} Indirect"]) for kind in KINDS)
    return sum(parts) + sum(passes[name] for name in (*VOLUME, "Emission", "Environment"))


@pytest.mark.parametrize(
    "settings", [{}, RASTERIZED, {**BY_PHOTONS, "use_splat_roulette": True}], ids=["gathered", "rasterized", "photons"]
)
def test_passes_add_up_to_combined(renderer, settings):
    names = (*LIGHT, *(f"{kind} Color" for kind in KINDS))
    frame = renderer.render(foggy(**settings | {"passes": names})).frame
    np.testing.assert_allclose(recombined(frame.passes), frame.combined[..., :3], **ROUNDING)
    assert not frame.passes["Environment"].any()  # behind fog without end
    for name in set(LIGHT) - {"Environment"}:
        assert frame.passes[name].max() > 0.0, name
        assert frame.passes[name].min() > -1e-4, name


@pytest.mark.parametrize("settings", [{}, BY_PHOTONS], ids=["rays", "photons"])
def test_light_groups_add_up_to_combined(renderer, settings):
    """The lamp is red, the sun green, and the world blue."""
    scene = foggy(glow=0.0, **settings | {"passes": (), "light_groups": ("lamps", "suns", "world")})
    scene.lights[0].strength, scene.lights[0].light_group = scene.lights[0].strength * (1.0, 0.0, 0.0), "lamps"
    scene.lights[1].strength, scene.lights[1].light_group = scene.lights[1].strength * (0.0, 1.0, 0.0), "suns"
    scene.world.radiance, scene.world.light_group = np.array([0.0, 0.0, 0.6]), "world"
    scene.world.volume = None  # neither the sun nor the world shines through endless fog
    for material in scene.materials:
        for node in material.graph.nodes:
            if node.kind == "emission":
                node.inputs["color"] = (0.0, 0.0, 0.0)
    frame = renderer.render(scene).frame
    for channel, group in enumerate(("lamps", "suns", "world")):
        light = frame.passes[f"Combined_{group}"]
        np.testing.assert_allclose(light[..., channel], frame.combined[..., channel], **ROUNDING, err_msg=group)
        assert light[..., channel].max() > 0.0
        assert np.abs(np.delete(light, channel, axis=-1)).max() <= 1e-5 * light.max(), group


def test_bands_of_rows_give_the_same_passes(renderer, monkeypatch):
    whole = renderer.render(foggy(**BY_PHOTONS)).frame
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", 24 * 10)
    parts = renderer.render(foggy(**BY_PHOTONS, seed=0)).frame
    np.testing.assert_array_equal(whole.combined, parts.combined)
    for name in LIGHT:
        np.testing.assert_array_equal(whole.passes[name], parts.passes[name], name)


def test_combined_is_the_same_with_the_passes_and_without(renderer):
    scene = foggy()
    with_passes = renderer.render(scene).frame
    scene.settings = scene.settings.with_values(passes=("Volume Direct",))
    alone = renderer.render(scene).frame
    np.testing.assert_array_equal(alone.combined, with_passes.combined)
    np.testing.assert_array_equal(alone.passes["Volume Direct"], with_passes.passes["Volume Direct"])
    scene.settings = scene.settings.with_values(passes=())
    np.testing.assert_array_equal(renderer.render(scene).frame.combined, with_passes.combined)


def test_single_scattering_is_direct(renderer):
    """A lamp lights a cloud directly; what is scattered again is indirect."""
    scene = foggy(glow=0.0, iterations=8, photons=2048)
    del scene.instances[:-1]
    scene.lights = [Light("lamp", LightKind.POINT, scenes.placed(0.0, -1.0, 0.6), np.full(3, 3.0))]
    scene.world = World(np.zeros(3))
    once = renderer.render(scene).frame.passes
    assert not any(once[name].any() for name in LIGHT if name not in VOLUME)
    scene.settings = scene.settings.with_values(volume_bounces=0)
    single = renderer.render(scene).frame.passes
    np.testing.assert_array_equal(single["Volume Direct"], once["Volume Direct"])
    assert single["Volume Indirect"].max() == 0.0
    assert once["Volume Indirect"].min() >= 0.0 < once["Volume Indirect"].max()
    scene.settings = scene.settings.with_values(direct_light=DirectLight.PHOTONS)
    photons = renderer.render(scene).frame
    assert photons.passes["Volume Indirect"].max() == 0.0
    np.testing.assert_allclose(photons.passes["Volume Direct"], photons.combined[..., :3], **ROUNDING)

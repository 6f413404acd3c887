# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of what first surfaces make of light, and of caustics: they are parts of Combined."""

import numpy as np
import pytest
import scenes
from path_glass import panes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common import band
from rppm_addon.scene import Light, LightKind, Material, Mesh, NodeGraph
from rppm_addon.scene.passes import SCATTERED_LIGHT
from rppm_addon.scene.settings import DensityEstimation, DirectLight

KINDS = ("Diffuse", "Glossy", "Transmission")
LIGHT = (*(entry.name for entry in SCATTERED_LIGHT), "Emission", "Environment", "Caustics")
RASTERIZED = {"use_final_gather": False, "density_estimation": DensityEstimation.RASTERIZED}
BY_PHOTONS = {"direct_light": DirectLight.PHOTONS, "use_final_gather": False}
ROUNDING = {"rtol": 2e-6, "atol": 2e-6}
"""Tolerances for sums of some thousand floats that take turns in being large."""


def everything(size: int = 24, **settings: object):
    return scenes.crowded_room(size, iterations=2, photons=4096, passes=LIGHT, **settings)


def recombined(passes: dict[str, np.ndarray]) -> np.ndarray:
    """(H, W, 3) of what Combined is made of."""
    parts = (passes[f"{kind} Color"] * (passes[f"{kind} Direct"] + passes[f"{kind} Indirect"]) for kind in KINDS)
    return sum(parts) + passes["Emission"] + passes["Environment"]


@pytest.mark.parametrize(
    "settings", [{}, RASTERIZED, {**BY_PHOTONS, "use_splat_roulette": True}], ids=["gathered", "rasterized", "photons"]
)
def test_passes_add_up_to_combined(renderer, settings):
    scene = everything(**settings)
    scene.settings = scene.settings.with_values(passes=(*LIGHT, *(f"{kind} Color" for kind in KINDS)))
    frame = renderer.render(scene).frame
    np.testing.assert_allclose(recombined(frame.passes), frame.combined[..., :3], **ROUNDING)
    for name in LIGHT:
        assert frame.passes[name].max() > 0.0, name
        assert frame.passes[name].min() > -1e-4, name


def test_routes_of_photons_give_the_same_passes(renderer):
    frames = [
        renderer.render(everything(density_estimation=route, **BY_PHOTONS)).frame
        for route in (DensityEstimation.RASTERIZED, DensityEstimation.GRID)
    ]
    for name in LIGHT:
        np.testing.assert_array_equal(frames[0].passes[name], frames[1].passes[name], name)


def test_bands_of_rows_give_the_same_passes(renderer, monkeypatch):
    whole = renderer.render(everything(**BY_PHOTONS)).frame
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", 24 * 10)
    parts = renderer.render(everything(**BY_PHOTONS, seed=0)).frame
    np.testing.assert_array_equal(whole.combined, parts.combined)
    for name in LIGHT:
        np.testing.assert_array_equal(whole.passes[name], parts.passes[name], name)


def test_combined_is_the_same_with_the_passes_and_without(renderer):
    scene = everything()
    with_passes = renderer.render(scene).frame
    scene.settings = scene.settings.with_values(passes=())
    np.testing.assert_array_equal(renderer.render(scene).frame.combined, with_passes.combined)
    scene.settings = scene.settings.with_values(passes=("Caustics",))
    alone = renderer.render(scene).frame
    np.testing.assert_array_equal(alone.combined, with_passes.combined)
    np.testing.assert_array_equal(alone.passes["Caustics"], with_passes.passes["Caustics"])


def test_what_is_handed_out_is_exposed_and_without_color(renderer):
    scene = scenes.room(16, iterations=1, photons=256, passes=LIGHT)
    plain = renderer.render(scene).frame.passes
    assert "Diffuse Color" not in plain
    scene.exposure = 4.0
    exposed = renderer.render(scene).frame.passes
    np.testing.assert_allclose(exposed["Diffuse Direct"], 4.0 * plain["Diffuse Direct"], rtol=1e-6)
    red, green = plain["Diffuse Direct"][8, 1], plain["Diffuse Direct"][8, -2]
    assert np.ptp(red) < 1e-4 * red.max()  # of a red wall under white light
    assert np.ptp(green) < 1e-4 * green.max()


def below_glass(*others: tuple[Mesh, Lobe], **settings: object):
    """A floor below a slab, lit by a light above it, and seen from below it."""
    parts = [(scenes.square("floor", 1.0), Lobe(LobeKind.DIFFUSE)), *panes(slab=True), *others]
    return scenes.scene_of(
        scenes.camera((0, -0.5, 0.5), (0, 0, 0), 0.4, 16), *((mesh, material(mesh.name, lobe)) for mesh, lobe in parts),
        lights=[Light("light", LightKind.POINT, scenes.placed(0, 0, 1.4), np.full(3, 5.0))],
        iterations=4, photons=16384, passes=LIGHT, **settings,
    )  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize(
    ("kind", "node", "options"),
    [
        ("Transmission", "bsdf_hair", {"component": "Transmission"}),
        ("Glossy", "bsdf_hair_principled", {"model": "CHIANG", "parametrization": "COLOR"}),
    ],
)
def test_light_of_fibers_is_glossy_but_for_the_transmission_of_the_hair_bsdf(renderer, kind, node, options):
    """As Cycles has it, from wherever light comes: here from behind."""
    graph = NodeGraph()
    graph.surface = graph.add(node, "bsdf", options=options, color=(0.8, 0.5, 0.2))
    sun = Light("sun", LightKind.SUN, scenes.looking((0.5, 0.5, -2), (0, 0, 0)), np.full(3, 3.0))
    camera, passes = scenes.camera((0, 0, 2), (0, 0.001, 0), 0.4, 12), (*LIGHT, *(f"{kind} Color" for kind in KINDS))
    sheet = scenes.square("sheet", 1.0), Material(node, graph)
    frame = renderer.render(scenes.scene_of(camera, sheet, lights=[sun], iterations=4, photons=64, passes=passes)).frame
    assert frame.passes[f"{kind} Direct"].mean() > 0.01
    np.testing.assert_allclose(recombined(frame.passes), frame.combined[..., :3], **ROUNDING)
    assert not any(frame.passes[f"{other} Direct"].any() for other in KINDS if other != kind)


@pytest.mark.parametrize("gathers", [True, False])
def test_light_through_glass_is_a_caustic(renderer, gathers):
    passes = renderer.render(below_glass(use_final_gather=gathers)).frame.passes
    assert passes["Diffuse Direct"].max() == 0.0
    assert passes["Caustics"].min() > 0.0
    np.testing.assert_allclose(passes["Caustics"], passes["Diffuse Indirect"], **ROUNDING)  # of a white floor


def test_light_of_diffuse_surfaces_is_no_caustic(renderer):
    scene = scenes.room(16, iterations=2, photons=2048, passes=LIGHT)
    scene.instances = scene.instances[:5]
    passes = renderer.render(scene).frame.passes
    assert passes["Caustics"].max() == 0.0
    assert passes["Diffuse Indirect"].max() > 0.0


def test_what_a_mirror_shows_is_indirect_but_for_lights(renderer):
    """And a caustic that is seen in it still is one."""
    scene = below_glass((scenes.square("mirror", 0.2, 0.35), Lobe(LobeKind.GLOSSY)))
    scene.camera.matrix = scenes.looking((0, -0.5, 0.1), (0, 0, 0.35))
    passes = renderer.render(scene).frame.passes
    mirrored = passes["Glossy Indirect"][6:10, 6:10]
    assert mirrored.min() > 0.0
    np.testing.assert_allclose(passes["Caustics"][6:10, 6:10], mirrored, **ROUNDING)
    for name in ("Diffuse Direct", "Diffuse Indirect", "Glossy Direct"):
        assert passes[name][6:10, 6:10].max() == 0.0, name

# SPDX-License-Identifier: GPL-3.0-or-later
"""Translucent, rough diffuse, white and held out surfaces through all stages, against closed forms."""

import dataclasses
import itertools

import numpy as np
import pytest
import scenes
from support.families import some_each_time
from support.lobes import Lobe, LobeKind
from support.lobes import material as lobe_material

from rppm_addon.scene import DirectLight, Light, LightKind, Material, Mesh, Scene, World

MODES = DirectLight.RAYS, DirectLight.PHOTONS
COLOR = (0.8, 0.5, 0.3)


def material(kind: LobeKind, **parameters) -> Material:
    return lobe_material(kind.name, Lobe(kind, **parameters))


def under_a_sun(surface: Material, sun_from: tuple[float, float, float], mode: DirectLight, **settings) -> Scene:
    """A sheet seen from straight above, with a sun of 3 W/m^2 (on a plane that faces it)."""
    sun = Light("sun", LightKind.SUN, scenes.looking(sun_from, (0, 0, 0)), np.full(3, 3.0))
    camera = scenes.camera((0, 0, 3), (0, 0, 0), 0.1, 16)
    fixed = {
        "iterations": 16, "photons": 64 if mode is DirectLight.RAYS else 16384, "direct_light": mode,
        "photon_path_length": 2, "camera_path_length": 2,
        "radius_minimum": 0.1, "radius_maximum": 0.1, "filter_width": 0.0,
    }  # fmt: skip
    return scenes.scene_of(camera, (scenes.square("sheet", 2.0), surface), lights=[sun], **fixed | settings)


def mean(renderer, scene: Scene) -> np.ndarray:
    return renderer.render(scene).frame.combined[..., :3].mean(axis=(0, 1), dtype=np.float64)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("side", [1, -1])
def test_translucent_sheets_shine_on_the_other_side(renderer, mode, side):
    """albedo E cos / pi on the side that the light does not come from, nothing on its own."""
    scene = under_a_sun(material(LobeKind.TRANSLUCENT, color=COLOR), (0.6, 0.0, 0.8 * side), mode)
    seen = mean(renderer, scene)
    expected = np.array(COLOR) * 3.0 * 0.8 / np.pi if side < 0 else np.zeros(3)
    np.testing.assert_allclose(seen, expected, rtol=1e-4 if mode is DirectLight.RAYS else 0.02, atol=1e-9)


def oren_nayar(color: np.ndarray, sigma: float, nv: float, nl: float, vl: float) -> np.ndarray:
    """Fujii's improved Oren-Nayar BSDF with Cycles' compensation, 1/sr."""
    a = 1 / (np.pi + (np.pi / 2 - 2 / 3) * sigma)
    b = a * sigma

    def albedo(cosine: float) -> float:
        sine = np.sqrt(1 - cosine**2)
        rise = sine * (np.arccos(cosine) - 2 / 3 - sine * cosine) + 2 / 3 * sine / cosine * (1 - sine**3)
        return a * np.pi + b * rise

    t = vl - nl * nv
    single = a + b * (t / max(nl, nv) if t > 0 else t)
    average = a * np.pi + (2 * np.pi - 5.6) / 3 * b
    multiple = color**2 / np.pi * (1 - albedo(nv)) * (1 - albedo(nl)) * average / (1 - average)
    return color * (single + multiple / (1 - color * (1 - average)))


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("sun_from", [(0.6, 0.0, 0.8), (0.9539392, 0.0, 0.3)])
def test_rough_diffuse_surfaces(renderer, mode, sun_from):
    scene = under_a_sun(material(LobeKind.DIFFUSE, color=COLOR, roughness=1.0), sun_from, mode)
    seen, cosine = mean(renderer, scene), sun_from[2]
    expected = oren_nayar(np.array(COLOR), 1.0, 1.0, cosine, cosine) * 3.0 * cosine
    np.testing.assert_allclose(seen, expected, rtol=3e-3 if mode is DirectLight.RAYS else 0.02)


def divided_furnace(mode: DirectLight, seed: int, final_gather: bool) -> Scene:
    """A cube that emits radiance 1 and has albedo 0.6, and a sheet across it that shares its albedo between reflecting
    and letting through, which the camera looks at."""
    glow = Lobe(LobeKind.EMISSION)
    walls = lobe_material("walls", Lobe(LobeKind.DIFFUSE, color=(0.6,) * 3), glow)
    sheet = lobe_material(
        "sheet", Lobe(LobeKind.DIFFUSE, color=(0.2,) * 3), Lobe(LobeKind.TRANSLUCENT, color=(0.4,) * 3), glow
    )
    across = scenes.rectangle("sheet", (-1, 0.2, -1), (1, 0.2, -1), (1, 0.2, 1), (-1, 0.2, 1))
    return scenes.scene_of(
        scenes.camera((0, -0.8, 0), (0, 1, 0), 0.5, 16), (scenes.box("cube"), walls), (across, sheet),
        iterations=6, photons=16384, direct_light=mode, photon_path_length=14, camera_path_length=3, seed=seed,
        filter_width=0.0, use_final_gather=final_gather, radius_minimum=0.1, radius_maximum=0.1,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("final_gather", "mode"),
    some_each_time(
        itertools.product([True, False], MODES), lambda final_gather, mode: final_gather == (mode is DirectLight.RAYS)
    ),
)
def test_a_furnace_with_a_translucent_sheet(renderer, mode, final_gather):
    """L = Le / (1 - albedo) wherever one looks, as if the sheet were not there."""
    seen = [mean(renderer, divided_furnace(mode, seed, final_gather))[0] for seed in range(4)]
    error = np.std(seen, ddof=1) / 2
    assert error < 0.02
    assert abs(np.mean(seen) - 2.5) < 4 * error + 0.01


@pytest.mark.parametrize("film_transparent", [True, False])
def test_holdouts_cut_the_picture(renderer, film_transparent):
    """Alpha falls by the holdout's weight; what is left of the surface shines on."""
    scene = under_a_sun(material(LobeKind.DIFFUSE, color=COLOR), (0, 0, 1), DirectLight.RAYS, iterations=2)
    whole = renderer.render(scene).frame.combined.astype(np.float64)
    held = lobe_material("held", Lobe(LobeKind.HOLDOUT, weight=0.75), Lobe(LobeKind.DIFFUSE, weight=0.25, color=COLOR))
    settings = dataclasses.replace(scene.settings, film_transparent=film_transparent)
    cut = renderer.render(dataclasses.replace(scene, materials=[held], settings=settings)).frame.combined
    np.testing.assert_allclose(whole[..., 3], 1.0)
    np.testing.assert_allclose(cut[..., 3], 0.25, atol=1e-4)
    np.testing.assert_allclose(cut[..., :3].mean((0, 1)), 0.25 * whole[..., :3].mean((0, 1)), rtol=1e-4)


def seen(renderer, mesh: Mesh, lobe: Lobe, eye: tuple, iterations: int) -> np.ndarray:
    """(H, W) radiance of a white surface alone in a sky of radiance 1: whatever scatters there, its radiance is 1."""
    scene = scenes.scene_of(
        scenes.camera(eye, (0, 0, 0), 0.3, 16), (mesh, lobe_material("white", lobe)), world=World(np.ones(3)),
        iterations=iterations, photons=64, photon_path_length=2, camera_path_length=8, filter_width=0.0,
        specular_roughness=1.0,
    )  # fmt: skip
    return renderer.render(scene).frame.combined[..., 0].astype(np.float64)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("roughness", [0.0, 0.4])
def test_a_pane_without_an_inside_shows_the_sky(renderer, side, roughness):
    """From either side, though what is seen through it is of another index."""
    pane = scenes.square("pane", 9.0)
    lobe = Lobe(LobeKind.GLASS, roughness=roughness)
    picture = seen(renderer, pane, lobe, (0, -1, 2 * side), 64 if roughness else 2)
    error = picture.std() / np.sqrt(picture.size)
    assert error < 2e-3
    assert abs(picture.mean() - 1.0) < 4 * error + 2e-3  # the tables of albedos


def test_smooth_normals_of_few_faces_lose_no_reflection(renderer):
    """Mirrored directions that smooth normals send below the surface are lifted above it, as in Cycles."""
    ball = scenes.sphere("ball", 8, 6)
    picture = seen(renderer, ball, Lobe(LobeKind.GLOSSY), (0, -5, 1), 2)
    np.testing.assert_allclose(picture, 1.0, atol=1e-5)

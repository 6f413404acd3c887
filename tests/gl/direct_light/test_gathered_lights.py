# SPDX-License-Identifier: GPL-3.0-or-later
"""Gathering rays that find lights: they share them with shadow rays, so that each light is counted once."""

import dataclasses
import itertools

import numpy as np
import pytest
import scenes
from rendering import radiance_of
from support.families import some_each_time
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.lights import lights
from rppm_addon.scene import Camera, Light, LightKind, RayVisibility, Scene
from rppm_addon.self_test.meshes import looking, placed, sphere

PIXELS, SEEDS, ITERATIONS = 12, 16, 8
FLOORS = {
    "diffuse": Lobe(LobeKind.DIFFUSE, color=(0.8, 0.6, 0.4)),
    "rough diffuse": Lobe(LobeKind.DIFFUSE, color=(0.8, 0.6, 0.4), roughness=0.8),
    "rough metal": Lobe(LobeKind.PRINCIPLED, color=(0.9, 0.4, 0.1), roughness=0.7, metallic=1.0),
    "plastic": Lobe(LobeKind.PRINCIPLED, color=(0.5, 0.3, 0.2), roughness=0.55),
}
DOWN = looking((0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
LAMPS = {
    "area": Light("lamp", LightKind.AREA, DOWN, np.full(3, 2.0), size=(2.0, 2.0)),
    "disk": Light("lamp", LightKind.AREA, DOWN, np.full(3, 2.0), shape="DISK", size=(1.5, 1.5)),
    "ball": Light("lamp", LightKind.POINT, placed(0.2, 0.0, 0.8), np.full(3, 2.0), radius=0.4),
    "soft ball": Light("lamp", LightKind.POINT, placed(0.2, 0.0, 0.8), np.full(3, 2.0), radius=0.4, soft_falloff=True),
    "sun": Light("lamp", LightKind.SUN, DOWN, np.full(3, 2.0), sun_angle=0.9),
}


def lit_floor(floor: str, lamp: str, **settings: object) -> Scene:
    """A floor with a ball on it under a lamp, or under a shining sheet and a small shining ball beside a small lamp."""
    camera = Camera(looking((0.0, -2.5, 0.7), (0.0, 0.0, 0.0)), (-0.4, 0.4, -0.25, 0.25), PIXELS, PIXELS)
    lower = scenes.square("floor", 2.0), material("floor", FLOORS[floor])
    fixed = {"camera_path_length": 3, "photon_path_length": 2, "photons": 64}
    scene = scenes.scene_of(camera, lower, lights=[LAMPS[lamp]] if lamp in LAMPS else [], **fixed | settings)
    scenes.add(scene, sphere("ball"), scenes.diffuse(0.5, 0.5, 0.5), placed(-0.3, 0.1, 0.2, 0.2))
    if lamp == "sheet":
        glow = material("glow", Lobe(LobeKind.EMISSION, color=(2.0, 1.5, 1.0)))
        scenes.add(scene, scenes.square("sheet", 1.0, 1.0), glow)
        scenes.add(scene, sphere("ball"), glow, placed(0.5, 0.4, 0.15, 0.1))
        scene.lights = [dataclasses.replace(LAMPS["ball"], radius=0.1, strength=np.full(3, 0.2))]
    return scene


def pictures(mapper, scene: Scene, iterations: int = ITERATIONS) -> np.ndarray:
    """(SEEDS, H, W, 3) radiance, by seed."""
    found = []
    mapper.build(scene)
    for seed in range(SEEDS):
        mapper.update(dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, seed=seed)))
        for _ in range(iterations):
            mapper.iterate()
        found.append(mapper.film.read_radiance()[..., :3].astype(float))
    return np.array(found)


def assert_same_mean(found: np.ndarray, expected: np.ndarray) -> None:
    """Assert that the means of each quarter agree within four standard errors of both, from the spread over seeds."""
    half = PIXELS // 2
    a, b = (each.reshape(SEEDS, 2, half, 2, half, 3).mean(axis=(2, 4, 5)) for each in (found, expected))
    error = np.sqrt((a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1)) / SEEDS)
    assert (abs(a.mean(axis=0) - b.mean(axis=0)) <= 4.0 * error + 1e-4 * b.mean(axis=0)).all()
    assert (error < 0.05 * b.mean(axis=0)).all()


EACH_TIME = {
    ("area", "diffuse"), ("disk", "rough diffuse"), ("ball", "plastic"), ("sun", "diffuse"), ("sheet", "rough metal")
}  # fmt: skip


@pytest.mark.parametrize(
    ("lamp", "floor"), some_each_time(itertools.product([*LAMPS, "sheet"], FLOORS), lambda *pair: pair in EACH_TIME)
)
def test_light_is_counted_once(mapper, monkeypatch, lamp, floor):
    """By shadow rays alone, and by these and gathering rays."""
    scene = lit_floor(floor, lamp)
    shared = pictures(mapper, scene)
    monkeypatch.setattr(lights, "shadows_are_of_all", lambda _: False)
    assert_same_mean(shared, pictures(mapper, scene))


@pytest.mark.parametrize(("floor", "variance"), [("diffuse", 0.85), ("rough metal", 0.7)])
def test_large_lights_are_less_noisy(mapper, monkeypatch, floor, variance):
    """Shadow rays to a large near light mostly go where the surface scatters little."""
    scene = lit_floor(floor, "sheet")
    shared = pictures(mapper, scene).var(axis=0, ddof=1).mean()
    monkeypatch.setattr(lights, "shadows_are_of_all", lambda _: False)
    assert shared < variance * pictures(mapper, scene).var(axis=0, ddof=1).mean()


def all_kept(mapper, scene: Scene, monkeypatch) -> None:
    """Assert that the scene's picture has the same bits with gathering rays that share no light."""
    found = radiance_of(mapper, scene)
    monkeypatch.setattr(lights, "shadows_are_of_all", lambda _: False)
    np.testing.assert_array_equal(found, radiance_of(mapper, scene))


@pytest.mark.parametrize("hidden", [RayVisibility.SHADOW, RayVisibility.DIFFUSE])
def test_what_shadow_rays_see_otherwise_leaves_lights_to_them(mapper, monkeypatch, hidden):
    scene = lit_floor("diffuse", "area")
    scene.instances[1] = dataclasses.replace(scene.instances[1], visibility=RayVisibility.ALL & ~hidden)
    assert not lights.shadows_are_of_all(scene)
    all_kept(mapper, scene, monkeypatch)


def test_lamps_without_shadows_are_left_to_shadow_rays(mapper, monkeypatch):
    scene = lit_floor("diffuse", "area")
    scene.lights[0] = dataclasses.replace(scene.lights[0], casts_shadow=False)
    all_kept(mapper, scene, monkeypatch)


@pytest.mark.parametrize("bounces", [0, 1])
def test_limits_of_bounces_hold(mapper, monkeypatch, bounces):
    """At each bounce that a lamp may light, and at none beyond."""
    scene = lit_floor("diffuse", "area")
    scene.lights[0] = dataclasses.replace(scene.lights[0], max_bounces=bounces)
    shared = pictures(mapper, scene)
    monkeypatch.setattr(lights, "shadows_are_of_all", lambda _: False)
    assert_same_mean(shared, pictures(mapper, scene))


@pytest.mark.parametrize("lamp", ["area", "sheet"])
def test_passes_add_up(renderer, lamp):
    names = ("Diffuse", "Glossy", "Transmission")
    passes = tuple(f"{name} {part}" for name in names for part in ("Direct", "Indirect", "Color"))
    scene = lit_floor("plastic", lamp, iterations=4, passes=(*passes, "Emission", "Environment"))
    frame = renderer.render(scene).frame
    parts = [[frame.passes[f"{name} {part}"] for part in ("Color", "Direct", "Indirect")] for name in names]
    seen = sum(color * (direct + indirect) for color, direct, indirect in parts)
    seen += frame.passes["Emission"] + frame.passes["Environment"]
    np.testing.assert_allclose(seen, frame.combined[..., :3], rtol=2e-4, atol=2e-4)
    assert frame.passes["Diffuse Direct"].mean() > 5.0 * frame.passes["Diffuse Indirect"].mean()


@pytest.mark.parametrize("lamp", ["area", "ball", "sheet"])
def test_light_groups_have_what_gathering_rays_find(renderer, lamp):
    scene = lit_floor("diffuse", lamp, iterations=4, light_groups=("lamps", "shining"))
    scene.lights = [dataclasses.replace(light, light_group="lamps") for light in scene.lights]
    for instance in scene.instances[2:]:
        instance.light_group = "shining"
    frame = renderer.render(scene).frame
    groups = [frame.passes[f"Combined_{group}"] for group in ("lamps", "shining")]
    np.testing.assert_allclose(sum(groups)[..., :3], frame.combined[..., :3], rtol=1e-5, atol=1e-5)
    assert (groups[1].max() > 0.0) == (lamp == "sheet")

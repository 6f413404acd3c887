# SPDX-License-Identifier: GPL-3.0-or-later
"""Every kind of light: flux of its photons, and light on a floor by photons, by rays and in closed form."""

import math

import numpy as np
import pytest
import scenes
from support.families import some_each_time
from support.lobes import Lobe, LobeKind, image_world, material

from rppm_addon.scene import DirectLight, Light, LightKind, NodeGraph, World
from rppm_addon.scene.images import Image


def down(z: float) -> np.ndarray:
    return scenes.placed(0, 0, z)


def by(kind: str, output: str) -> NodeGraph:
    """Emission of a coordinate: 1 at its -1, 0 at its 1."""
    graph = NodeGraph()
    coordinate = graph.add(kind, output)
    color = graph.add(
        "vector_math", "vector", options={"operation": "MULTIPLY_ADD"},
        vector=coordinate, vector_001=(-0.5, -0.5, -0.5), vector_002=(0.5, 0.5, 0.5),
    )  # fmt: skip
    graph.surface = graph.add("emission", "emission", color=color)
    return graph


ONE, PANEL = np.ones(3), scenes.square("glow", 0.4, 2.0)
BY_NORMAL, BY_PLACE, BY_DIRECTION = by("tex_coord", "normal"), by("tex_coord", "object"), by("new_geometry", "incoming")
LIGHTS = {
    "point": Light("point", LightKind.POINT, down(2), 3 * ONE),
    "sphere": Light("sphere", LightKind.POINT, down(2), 3 * ONE, radius=0.5),
    "soft": Light("soft", LightKind.POINT, down(2), 3 * ONE, radius=0.5, soft_falloff=True),
    "spot": Light("spot", LightKind.SPOT, down(2), 3 * ONE, spot_angle=1.6, spot_blend=0.6),
    "sun": Light("sun", LightKind.SUN, down(2), 2 * ONE),
    "wide sun": Light("wide sun", LightKind.SUN, down(2), 2 * ONE, sun_angle=0.3),
    "square": Light("square", LightKind.AREA, down(2), 5 * ONE, size=(0.8, 0.8)),
    "disk": Light("disk", LightKind.AREA, down(2), 5 * ONE, shape="DISK", size=(0.8, 0.8)),
    "spread": Light("spread", LightKind.AREA, down(2), 5 * ONE, size=(0.3, 0.3), spread=1.0),
    "mapped point": Light("mapped point", LightKind.POINT, down(2), 3 * ONE, graph=BY_NORMAL),
    "mapped sphere": Light("mapped sphere", LightKind.POINT, down(2), 3 * ONE, radius=0.5, graph=BY_NORMAL),
    "mapped spot": Light("mapped spot", LightKind.SPOT, down(2), 3 * ONE, spot_angle=1.6, graph=BY_NORMAL),
    "mapped sun": Light("mapped sun", LightKind.SUN, down(2), 2 * ONE, sun_angle=0.6, graph=BY_DIRECTION),
    "mapped square": Light("mapped square", LightKind.AREA, down(2), 5 * ONE, size=(1.6, 1.6), graph=BY_PLACE),
    "mapped disk": Light(
        "mapped disk", LightKind.AREA, down(2), 5 * ONE, shape="DISK", size=(0.8, 0.8), graph=BY_DIRECTION
    ),
}
IRRADIANCE = {  # on the floor straight below, W/m^2
    **dict.fromkeys(["point", "sphere", "spot"], 3 / 4),
    **dict.fromkeys(["sun", "wide sun"], 2.0),
    "soft": 3 / (4 + 0.25),
    "disk": 5 * math.pi * 0.16 / (4 + 0.16),
    # Straight down, the mean of the colors 0.5, 0.5 and 1 is 2/3.
    **dict.fromkeys(["mapped point", "mapped spot"], 3 / 4 * 2 / 3),
}


def floor_scene(light, mode, world=None, albedo=0.5, size=32, h=2.0, window=0.6):
    floor = scenes.square("floor", h), scenes.diffuse(albedo, albedo, albedo)
    # Shadow rays need no photons; those of a light tell 0.4 % of the mean in four iterations, the world's in sixteen.
    iterations = 4 if mode is DirectLight.PHOTONS and world is None else 16
    photons = 64 if mode is DirectLight.RAYS and world is None else 32768
    return scenes.scene_of(
        scenes.camera((0, 0, 1.2), (0, 0, 0), window, size), floor, lights=[light] if light else [], world=world,
        iterations=iterations, photons=photons, direct_light=mode, photon_path_length=2, camera_path_length=2,
        radius_minimum=0.05, radius_maximum=0.05, filter_width=0.0,
    )  # fmt: skip


def assert_balanced(flux):
    assert flux["absorbed"] + flux["deposited"] + flux["escaped"] == pytest.approx(flux["emitted"], rel=1e-4)
    assert abs(flux["lost"]) <= 1e-4 * flux["emitted"]


@pytest.mark.parametrize("name", LIGHTS)
def test_rays_and_photons_light_the_floor_alike(renderer, name):
    means = {}
    for mode in DirectLight:
        frame = renderer.render(floor_scene(LIGHTS[name], mode)).frame
        means[mode] = frame.combined[..., :3].mean()
        if mode is DirectLight.RAYS:
            middle = frame.combined[14:18, 14:18, :3].mean()  # 18 cm around the point straight below
    expected = IRRADIANCE.get(name)
    closed = None if expected is None else 0.5 * expected / math.pi
    assert means[DirectLight.PHOTONS] == pytest.approx(means[DirectLight.RAYS], rel=0.02)
    if closed is not None:
        assert middle == pytest.approx(closed, rel=0.012)


def test_a_constant_world_lights_evenly(renderer):
    for mode in DirectLight:
        frame = renderer.render(floor_scene(None, mode, World(np.array([1.0, 2.0, 3.0])))).frame
        np.testing.assert_allclose(frame.combined[..., :3].mean((0, 1)), [0.5, 1.0, 1.5], rtol=0.02)


def test_a_world_image_lights_by_direction(renderer):
    v, u = np.meshgrid((np.arange(64) + 0.5) / 64, (np.arange(128) + 0.5) / 128, indexing="ij")
    sun = 30 * np.exp(-((u - 0.3) ** 2 + (v - 0.75) ** 2) / 0.004)
    pixels = np.stack([1 + np.sin(6 * u) + sun, 1 + v + sun, 1.5 - v + sun, np.ones_like(u)], -1).astype(np.float32)
    theta = np.pi * (1 - v)
    solid_angle = np.sin(theta) * (np.pi / 64) * (2 * np.pi / 128) * np.maximum(np.cos(theta), 0)
    expected = 0.5 / np.pi * (pixels[..., :3] * solid_angle[..., None]).sum((0, 1))
    for mode in DirectLight:
        scene = floor_scene(None, mode, image_world(0), h=0.5, window=0.15)
        scene.images = [Image("sky", pixels)]
        mean = renderer.render(scene).frame.combined[..., :3].mean((0, 1))
        np.testing.assert_allclose(mean, expected, rtol=0.02)


@pytest.mark.parametrize("lobe", [
    Lobe(LobeKind.EMISSION, color=(5, 5, 5)),
    Lobe(LobeKind.PRINCIPLED, color=(0, 0, 0), specular_ior_level=0, emission_color=(5, 5, 5), emission_strength=1.0),
], ids=["emission", "principled"])  # fmt: skip
def test_an_emissive_mesh_lights_as_an_area_light(renderer, lobe):
    reference = renderer.render(floor_scene(LIGHTS["square"], DirectLight.RAYS)).frame.combined[..., :3].mean()
    for mode in DirectLight:
        scene = floor_scene(None, mode)
        scenes.add(scene, PANEL, material("light", lobe))
        assert renderer.render(scene).frame.combined[..., :3].mean() == pytest.approx(reference, rel=0.02)


@pytest.mark.parametrize("name", LIGHTS)
def test_photons_carry_the_power(renderer, name):
    scene = floor_scene(LIGHTS[name], DirectLight.PHOTONS)
    scene.settings.iterations = 1
    balance = renderer.render(scene).statistics.flux_watts
    radius = 2 * math.sqrt(2) * 1.001  # of the floor's bounding sphere
    power = {
        "point": 12 * math.pi, "sphere": 12 * math.pi,
        "sun": 2 * math.pi * radius**2, "wide sun": 2 * math.pi * radius**2 * 2 / (1 + math.cos(0.15)),
        "square": 5 * math.pi * 0.64, "disk": 5 * math.pi**2 * 0.16, "spread": 5 * math.pi * 0.09,
    }  # fmt: skip
    if name in power:
        assert balance["emitted"] == pytest.approx(3 * power[name], rel=2e-3)
    assert_balanced(balance)


AIMED_EACH_TIME = ("sun", "disk", "spread", "mapped spot", "mapped square", "world", "mesh")


@pytest.mark.parametrize("name", some_each_time([*LIGHTS, "world", "mesh"], lambda name: name in AIMED_EACH_TIME))
def test_aiming_moves_no_energy(renderer, name):
    """A ball of no refraction changes nothing but where photons are sent."""
    world = World(np.array([1.0, 2.0, 3.0])) if name == "world" else None

    scene = floor_scene(LIGHTS.get(name), DirectLight.PHOTONS, world)
    scene.settings.photon_path_length = scene.settings.camera_path_length = 4
    if name == "mesh":
        scenes.add(scene, PANEL, material("light", Lobe(LobeKind.EMISSION, color=(5, 5, 5))))
    plain = renderer.render(scene).frame.combined[..., :3].mean()
    air = material("air", Lobe(LobeKind.REFRACTION, ior=1.0))
    scenes.add(scene, scenes.sphere("ball"), air, scenes.placed(0.2, 0.1, 0.5, 0.2))
    result = renderer.render(scene)
    assert result.frame.combined[..., :3].mean() == pytest.approx(plain, rel=0.02)
    assert_balanced(result.statistics.flux_watts)

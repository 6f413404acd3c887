# SPDX-License-Identifier: GPL-3.0-or-later
"""Guided photons: any guide leaves the emitted light as it is, and learning sends photons to what is seen."""

import itertools
import math

import numpy as np
import pytest
import scenes
from rendering import iterated
from support.families import some_each_time
from support.lobes import Lobe, LobeKind, image_world, material
from test_light_sources import LIGHTS, floor_scene

from rppm_addon.integrator.common import iteration
from rppm_addon.integrator.common.iteration import Iteration
from rppm_addon.integrator.common.records.photon_paths import PHOTON_PATH
from rppm_addon.integrator.common.records.photons import PHOTON_CONTRIBUTED
from rppm_addon.integrator.common.records.rays import RAY
from rppm_addon.integrator.lights import guide
from rppm_addon.scene import DirectLight, Instance, Light, LightKind, Scene, World


def lit_floor(name: str, aimed: bool) -> Scene:
    """A floor below one light, and where photons are to be aimed a ball that refracts nothing."""
    world = World(np.array([1.0, 2.0, 3.0])) if name == "world" else None
    scene = floor_scene(LIGHTS.get(name), DirectLight.PHOTONS, world)
    if name == "image":
        scene.images = [scenes.sky_with_a_sun(16, 0.02)]
        scene.world = image_world(0)
    if name == "mesh":
        glow = material("light", Lobe(LobeKind.EMISSION, color=(5, 5, 5)))
        scenes.add(scene, scenes.sphere("light", 8, 4), glow, scenes.placed(0, 0, 2, 0.3))
    if aimed:
        scene.materials.append(material("air", Lobe(LobeKind.REFRACTION, ior=1.0)))
        scene.meshes.append(scenes.sphere("ball"))
        ball, air = len(scene.meshes) - 1, len(scene.materials) - 1
        scene.instances.append(Instance(ball, scenes.placed(0.2, 0.1, 0.5, 0.2), [air]))
    return scene


def emitted_moments(mapper, iterations: int) -> np.ndarray:
    """(iterations, 19) sums of flux, of flux times origin, direction, and both, over the photons of an iteration."""
    moments = []
    for number in range(iterations):
        scene = mapper.scene
        iteration = Iteration(number, scene.settings.seed, scene.photon_count)
        context = mapper.device_scene.context
        context.begin(iteration)
        mapper.stages.photons.emit(context, iteration)
        count = mapper.stages.photons.photon_count
        flux = mapper.stages.photons._paths.read(PHOTON_PATH.dtype, count)["flux"][:, 0].astype(np.float64)
        rays = mapper.stages.photons._rays.read(RAY.dtype, count)
        used = flux > 0
        o, d = rays["origin"][used].astype(np.float64), rays["direction"][used].astype(np.float64)
        terms = [np.ones((len(o), 1)), o, d, (o[:, :, None] * d[:, None, :]).reshape(-1, 9), d * d]
        moments.append(flux[used] @ np.concatenate(terms, axis=1))
    return np.array(moments)


AIMED_EACH_TIME = ("sun", "mapped spot", "world", "image", "mesh")


@pytest.mark.parametrize(
    ("name", "aimed"),
    some_each_time(
        itertools.product([*LIGHTS, "world", "image", "mesh"], [False, True]),
        lambda name, aimed: not aimed or name in AIMED_EACH_TIME,
    ),
)
def test_any_guide_emits_the_same_light(mapper, name, aimed):
    """Cells chosen at random a hundred times more or less often: the light field's moments stay."""
    mapper.build(lit_floor(name, aimed))
    plain = emitted_moments(mapper, 8)
    count = int(np.prod(mapper.device_scene.lights.guide._cells[0]))
    assert len(mapper.device_scene.lights.guide._cells) == 1 and count >= 1024
    estimate = 10.0 ** np.random.default_rng(3).uniform(-4, 0, count)
    mapper.device_scene.lights.guide._starts.upload(guide.starts(guide.probabilities(estimate)))
    guided = emitted_moments(mapper, 8)
    error = np.sqrt((plain.var(axis=0, ddof=1) + guided.var(axis=0, ddof=1)) / 8)
    difference = guided.mean(axis=0) - plain.mean(axis=0)
    limit = 5 * error + 1e-5 * plain[:, 0].mean()  # a point light's origin does not vary but for rounding
    worst = (abs(difference) / limit).max()
    assert (error < 0.02 * plain[:, 0].mean() * np.maximum(1.0, abs(plain.mean(axis=0) / plain[:, 0].mean()))).all()
    assert worst < 1


def lit_through_a_hole() -> Scene:
    """A closed room of side 2 in the sun, with a hole of 2 % of its ceiling: few photons get in."""
    scene = scenes.room(16, photons=16384, iterations=32, radius_minimum=0.05, radius_maximum=0.05, filter_width=0.0)
    scene.instances = scene.instances[:5]
    h = math.sqrt(0.02)
    corners = [(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1), (-h, -h, 1), (h, -h, 1), (h, h, 1), (-h, h, 1)]
    faces = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    scene.meshes[1] = scenes.polygons("ceiling", np.array(corners), faces)
    scene.lights = [Light("sun", LightKind.SUN, np.eye(4), np.full(3, 100.0))]
    front = scenes.rectangle("front", (-1, -1, -1), (-1, -1, 1), (1, -1, 1), (1, -1, -1))
    scene.meshes.append(front)
    scene.instances.append(Instance(len(scene.meshes) - 1, np.eye(4), [0]))
    scene.camera.matrix = scenes.looking((0, -0.9, 0), (0, 1, 0))
    scene.camera.window = (-1.0, 1.0, -1.0, 1.0)
    return scene


@pytest.mark.long
def test_photons_learn_to_find_a_hole(mapper, monkeypatch):
    """The picture's mean stays, its variance falls, and so does the radius that the global photons need."""
    results = {}
    for learning in (0, iteration.LEARNING_ITERATIONS):
        monkeypatch.setattr(iteration, "LEARNING_ITERATIONS", learning)
        means, useful = [], 0.0
        for seed in range(4):
            scene = lit_through_a_hole()
            scene.settings.seed = seed
            iterated(mapper, scene, 32)
            photons = mapper.read_photons()
            useful += float((photons["depth"] & PHOTON_CONTRIBUTED != 0).any(axis=0).mean()) / 4
            means.append(mapper.film.read_radiance()[..., :3].mean(dtype=np.float64))
        radius = mapper.learning.radius_schedule.wide_radius
        results[learning] = np.mean(means), np.std(means, ddof=1) / 2, useful, radius
    (plain, plain_error, plain_useful, plain_radius), (guided, guided_error, useful, radius) = results.values()
    assert abs(guided - plain) < 4 * math.hypot(plain_error, guided_error) + 0.01 * plain
    assert useful > 5 * plain_useful
    assert radius < plain_radius

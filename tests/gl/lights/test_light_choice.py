# SPDX-License-Identifier: GPL-3.0-or-later
"""The light that a shadow ray goes to: its probability, what must not be left out, and the noise that is left."""

from pathlib import Path

import numpy as np
import pytest
import scenes
from rendering import radiance_of
from support.lobes import Lobe, LobeKind, material
from test_light_sampling import light_samples
from test_light_sources import floor_scene

from rppm_addon.gl.buffers.records import Record
from rppm_addon.integrator.common.iteration import Iteration
from rppm_addon.scene import DirectLight, Light, LightKind, World

Record(
    "LightChoicesParameters", count="uint", point="vec3", normal="vec3", both_sides="uint", looks_at_lights="uint",
    reach="float",
)  # fmt: skip
SHADER = str(Path(__file__).parent / "light_choices.comp")
CHOICES = 1 << 14


def turned(generator) -> np.ndarray:
    """A random place within 2 m, turned at random."""
    matrix = np.eye(4)
    matrix[:3, :3] = np.linalg.qr(generator.normal(size=(3, 3)))[0]
    matrix[:3, 3] = generator.uniform(-2, 2, 3)
    return matrix


def lights_of_all_kinds(count: int) -> list[Light]:
    """Suns, and ``count`` of other kinds, of powers over three decades."""
    generator = np.random.default_rng(11)
    lights = [
        Light("sun", LightKind.SUN, turned(generator), np.full(3, 0.2), sun_angle=0.1),
        Light("other sun", LightKind.SUN, turned(generator), np.full(3, 0.02)),
    ]
    for k in range(count):
        strength = np.full(3, 10 ** generator.uniform(-2, 1))
        kinds = [
            {"kind": LightKind.POINT, "radius": 0.1 * (k % 2)},
            {"kind": LightKind.SPOT, "radius": 0.05, "spot_angle": generator.uniform(0.2, 3.0), "spot_blend": 0.3},
            {"kind": LightKind.AREA, "shape": "RECTANGLE", "size": (0.6, 0.2)},
            {"kind": LightKind.AREA, "shape": "ELLIPSE", "size": (0.3, 0.5), "spread": 1.2},
        ]
        lights.append(Light(f"light {k}", matrix=turned(generator), strength=strength, **kinds[k % 4]))
    return lights


def crowded_scene(count: int, world: float = 0.1):
    """A floor under many lights and an emissive ball of triangles."""
    scene = floor_scene(None, DirectLight.RAYS, World(np.full(3, world)))
    scene.lights = lights_of_all_kinds(count)
    glow = material("shining", Lobe(LobeKind.EMISSION, color=(1, 1, 1)))
    scenes.add(scene, scenes.sphere("ball", 8, 4), glow, scenes.placed(0.4, 0.3, 0.9, 0.2))
    return scene


def run(mapper, library, **parameters) -> np.ndarray:
    """(CHOICES, 4) float32 of light_choices.comp."""
    results = mapper.context.moderngl.buffer(reserve=16 * CHOICES)
    context = mapper.device_scene.context
    context.begin(Iteration(1, seed=3))
    unset = {"point": np.zeros(3), "normal": np.zeros(3), "both_sides": 0, "looks_at_lights": 0, "reach": 0.0}
    blocks, values = {**context.blocks, "Results": results}, {"count": CHOICES, **unset, **parameters}
    library.compute(SHADER).run(CHOICES, blocks, values)
    table = np.frombuffer(results.read(), np.float32).reshape(CHOICES, 4).copy()
    results.release()
    return table


@pytest.mark.parametrize("count", [0, 1, 2, 37])
@pytest.mark.parametrize("both_sides", [False, True])
def test_choices_come_as_often_as_they_say(mapper, library, count, both_sides):
    """Numbers of even spacing fall into one interval of each light and triangle, as long as its probability."""
    mapper.build(crowded_scene(count))
    generator = np.random.default_rng(count)
    for _ in range(6):
        normal = generator.normal(size=3)
        point = {"point": generator.uniform(-1.5, 1.5, 3), "normal": normal / np.linalg.norm(normal)}
        table = run(mapper, library, **point, both_sides=both_sides)
        chosen, probability = table[:, :2].view(np.uint32), table[:, 2]
        assert (probability > 0).any() and (probability <= 1).all()
        _, first, counts = np.unique(chosen[probability > 0], axis=0, return_index=True, return_counts=True)
        # An interval's ends take or leave one number each, and rounding on the way down the tree another.
        np.testing.assert_allclose(counts, probability[probability > 0][first] * CHOICES, atol=3)
        # Rays that meet a light know it.
        np.testing.assert_allclose(table[probability > 0, 3], probability[probability > 0], rtol=1e-5)


def test_no_light_that_reaches_a_point_is_left_out(mapper, library):
    """One light at a time, at points all around: where a sample of it brings light, it can be chosen."""
    lit = 0
    for light in lights_of_all_kinds(4):
        mapper.build(floor_scene(light, DirectLight.RAYS))
        generator = np.random.default_rng(5)
        for place in range(8):
            normal = generator.normal(size=3)
            normal /= np.linalg.norm(normal)
            point = generator.uniform(-2.5, 2.5, 3)
            sample = light_samples(mapper, library, point, count=256)
            cosine = sample["direction"] @ normal
            for both_sides in (False, True):
                reaches = (sample["weight"].max(axis=1) > 0) & ((np.abs(cosine) if both_sides else cosine) > 0)
                table = run(mapper, library, point=point, normal=normal, both_sides=both_sides)
                assert not reaches.any() or (table[:, 2] > 0).all(), (light.name, place)
                lit += reaches.any()
    assert lit > 40


@pytest.mark.parametrize("reach", [1.5, 1e30])
def test_rays_see_the_lights_that_they_pass(mapper, library, reach):
    mapper.build(crowded_scene(37))
    table = run(mapper, library, looks_at_lights=1, reach=reach)
    assert (table[:, 2] > 0).sum() > 100
    np.testing.assert_allclose(table[:, :2], table[:, 2:], rtol=1e-5)


def errors(mapper, scene, iterations: int, runs: int) -> float:
    """Relative variance of a pixel, the mean over the picture, of ``iterations`` by as many seeds as ``runs``."""
    pictures = []
    for seed in range(runs):
        scene.settings = scene.settings.with_values(seed=seed, radius_maximum=0.05, photons=256)
        pictures.append(radiance_of(mapper, scene, iterations)[..., :3].mean(axis=-1))
    pictures = np.array(pictures, np.float64)
    return float((pictures.var(axis=0, ddof=1) / pictures.mean(axis=0) ** 2).mean())


LIGHT = Light("light", LightKind.POINT, scenes.placed(0.4, 0.2, 1.0), 2 * np.ones(3), radius=0.2)


def test_a_faint_world_adds_no_noise(mapper):
    """Beside a light; chosen with half of the shadow rays it made the variance forty times as large."""
    dark, gray = (
        errors(mapper, floor_scene(LIGHT, DirectLight.RAYS, World(np.full(3, radiance)), size=16), 8, 8)
        for radiance in (0.0, 0.05)
    )
    assert gray < 2 * dark + 1e-6


def test_points_on_a_light_keep_their_order_over_the_iterations(mapper):
    """Owen-scrambled points in two dimensions: the variance falls faster than with N^-1.4, at random N^-1."""
    few, many = (errors(mapper, floor_scene(LIGHT, DirectLight.RAYS, size=16), n, 8) for n in (4, 32))
    assert many < few * 8**-1.4

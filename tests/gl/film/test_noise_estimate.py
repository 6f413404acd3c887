# SPDX-License-Identifier: GPL-3.0-or-later
"""The noise of a picture, told by half of its iterations, and renders that end by it."""

import dataclasses
import math

import numpy as np
import pytest
import scenes
from support.render_states import assert_same_array, assert_same_state

from rppm_addon.gl.buffers.buffers import SMALLEST
from rppm_addon.integrator.common import band
from rppm_addon.integrator.film.noise_estimate import BLOCK, LEAST_MEASURED, MEASURED_EVERY, is_in_half
from rppm_addon.integrator.memory import expected_memory
from rppm_addon.scene.errors import CheckpointError
from rppm_addon.session.checkpoints.continuation import Continuation

WIDTH, HEIGHT, EXPOSURE, THRESHOLD = 40, 24, 1.5, 0.06


def noisy_room(**settings):
    """Blocks that are whole, and blocks that are not."""
    values = {"photons": 1024, "camera_path_length": 4, "photon_path_length": 4, "use_adaptive_sampling": True}
    scene = scenes.room(WIDTH, **values | settings)
    return dataclasses.replace(
        scene, camera=dataclasses.replace(scene.camera, width=WIDTH, height=HEIGHT), exposure=EXPOSURE
    )


def errors_of(radiance, half):
    """(height, width) noise of each pixel of equal halves, as Cycles has it."""
    mean, half = EXPOSURE * radiance[..., :3].astype(np.float64), EXPOSURE * half.astype(np.float64)
    total = mean.sum(axis=-1)
    return abs(mean - half).sum(axis=-1) / (1e-4 + np.where(total < 1.0, np.sqrt(total), total))


def iterated(mapper, scene, iterations):
    """The means after each iteration."""
    mapper.build(scene)
    means = []
    for _ in range(iterations):
        mapper.iterate()
        means.append(mapper.film.read_radiance())
    return means


def test_the_half_is_the_mean_of_its_iterations(mapper, other_mapper, monkeypatch):
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", WIDTH * 13)
    scene = noisy_room()
    means = iterated(mapper, scene, 32)
    sums = np.array([number * mean.astype(np.float64) for number, mean in enumerate(means, 1)])
    estimates = np.diff(sums, axis=0, prepend=0.0)[..., :3]
    wanted = np.mean([estimate for number, estimate in enumerate(estimates, 1) if is_in_half(number)], axis=0)
    half = mapper.state().half
    np.testing.assert_allclose(half, wanted, rtol=1e-4, atol=1e-5 * wanted.mean())
    errors = errors_of(means[-1], half)
    blocks = [
        errors[y : y + BLOCK, x : x + BLOCK].mean() for y in range(0, HEIGHT, BLOCK) for x in range(0, WIDTH, BLOCK)
    ]
    assert mapper.measure_noise() == pytest.approx(max(blocks), rel=1e-4)
    assert max(blocks) > 1.2 * np.mean(blocks)
    # The picture is the same without.
    scene.settings = dataclasses.replace(scene.settings, use_adaptive_sampling=False)
    assert_same_array(iterated(other_mapper, scene, 32)[-1], means[-1], "radiance")
    assert other_mapper.state().half is None
    with pytest.raises(ValueError, match="off"):
        other_mapper.measure_noise()


def test_light_that_is_taken_away_is_as_noisy(mapper):
    told = []
    for sign in (1.0, -1.0):
        scene = noisy_room(filter_width=0.0)
        scene.lights = [dataclasses.replace(light, strength=sign * light.strength) for light in scene.lights]
        iterated(mapper, scene, 32)
        told.append(mapper.measure_noise())
    assert told[1] == pytest.approx(told[0], rel=1e-3) and told[0] < 1.0


def test_the_noise_told_is_that_there_is(mapper):
    """Or more: where points fill their space evenly, the error of n of them falls with between the root of n and n, and
    what two runs tell is once to sqrt(2) times that of all. Beside that 15 %, for distances of 1000 pixels of 12 seeds.
    Radii do not shrink: there is no blur."""
    seeds, iterations = 12, 32
    pictures, told = [], []
    for seed in range(seeds):
        scene = noisy_room(seed=seed, radius_minimum=0.1, radius_maximum=0.1, filter_width=0.0)
        scene.instances = scene.instances[:5]  # caustics are none of the normal kind
        pictures.append(iterated(mapper, scene, iterations)[-1])
        told.append(errors_of(pictures[-1], mapper.state().half).mean())
    mean = np.mean(pictures, axis=0, dtype=np.float64)
    there = math.sqrt(seeds / (seeds - 1)) * np.mean([errors_of(mean, picture[..., :3]) for picture in pictures])
    assert 0.85 * there < np.mean(told) < 1.15 * math.sqrt(2.0) * there


def test_a_render_ends_with_its_noise_also_when_it_was_interrupted(renderer):
    scene = noisy_room(iterations=400, adaptive_threshold=THRESHOLD, adaptive_min_samples=6)
    told, pauses = [], []
    result = renderer.render(scene, lambda progress, _: told.append(progress))
    ended = result.statistics.iterations
    assert LEAST_MEASURED < ended < 400 and ended % MEASURED_EVERY == 0 and not result.stopped
    assert result.statistics.noise == told[-1].noise < THRESHOLD == told[-1].noise_threshold
    assert all(progress.noise >= THRESHOLD for progress in told if LEAST_MEASURED <= progress.iteration < ended)
    assert told[-1].expected_iterations == ended and told[-1].fraction == 1.0 and told[-1].remaining_seconds == 0.0
    for stop in (37, ended):
        scene.settings = dataclasses.replace(scene.settings, iterations=stop)
        renderer.render(scene, continuation=Continuation(keep=pauses.append))
    scene.settings = dataclasses.replace(scene.settings, iterations=400)
    for pause in pauses:
        kept = []
        again = renderer.render(scene, continuation=Continuation(begin=pause, keep=kept.append))
        assert again.statistics.iterations == ended
        assert_same_array(again.frame.combined, result.frame.combined, "combined")
        assert_same_state(kept[-1].state, pauses[1].state)
    scene.settings = dataclasses.replace(scene.settings, use_adaptive_sampling=False, iterations=38)
    plain = []
    renderer.render(scene, continuation=Continuation(begin=pauses[0], keep=plain.append))  # without one from now on
    scene.settings = dataclasses.replace(scene.settings, use_adaptive_sampling=True)
    with pytest.raises(CheckpointError, match="without a noise threshold"):
        renderer.render(scene, continuation=Continuation(begin=plain[0]))


def test_a_picture_that_does_not_end_by_its_noise_keeps_no_half(renderer):
    scene = noisy_room(iterations=1)
    memory = renderer.memory(scene)
    scene.settings = dataclasses.replace(scene.settings, use_adaptive_sampling=False)
    without = renderer.memory(scene)
    blocks = math.ceil(WIDTH / BLOCK) * math.ceil(HEIGHT / BLOCK)
    half = {"half of the film": 12 * WIDTH * HEIGHT, "noise of blocks": max(4 * blocks, SMALLEST)}
    assert memory.working["passes"] == without.working["passes"] | half
    expected = [expected_memory(WIDTH, HEIGHT, 1024, 4, measures_noise=on) for on in (True, False)]
    assert expected[0].working["passes"] == expected[1].working["passes"] | half

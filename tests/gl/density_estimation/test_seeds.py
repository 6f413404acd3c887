# SPDX-License-Identifier: GPL-3.0-or-later
"""The same seed gives the same picture bit for bit; different seeds give independent errors."""

import itertools

import numpy as np
import pytest
from busy_scenes import busy_room
from test_convergence import blurred, floor_radiance, lit_floor, pixel_points

from rppm_addon.integrator.camera_paths.gbuffer import filter_offsets
from rppm_addon.integrator.common import band
from rppm_addon.integrator.common.iteration import LEARNING_ITERATIONS
from rppm_addon.scene import DirectLight, Scene
from rppm_addon.session.render.renderer import Renderer


def several_iterations(direct_light: DirectLight, seed: int = 3) -> Scene:
    """A few iterations more than those that learn."""
    scene = busy_room(direct_light)
    scene.settings = scene.settings.with_values(seed=seed, iterations=LEARNING_ITERATIONS + 4)
    return scene


def arrays(renderer: Renderer, scene: Scene) -> list[np.ndarray]:
    frame = renderer.render(scene).frame
    return [frame.combined, *frame.passes.values()]


@pytest.mark.parametrize("direct_light", [DirectLight.RAYS, pytest.param(DirectLight.PHOTONS, marks=pytest.mark.long)])
def test_a_seed_gives_the_same_picture(renderer, monkeypatch, direct_light):
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", 16 * 6)  # three bands
    first = arrays(renderer, several_iterations(direct_light))
    other = arrays(renderer, several_iterations(direct_light, seed=4))
    again = arrays(renderer, several_iterations(direct_light))
    with Renderer() as second:
        elsewhere = arrays(second, several_iterations(direct_light))
    for mine, same, fresh in zip(first, again, elsewhere, strict=True):
        np.testing.assert_array_equal(mine.view(np.uint32), same.view(np.uint32))
        np.testing.assert_array_equal(mine.view(np.uint32), fresh.view(np.uint32))
    assert (first[0] != other[0]).mean() > 0.5


@pytest.mark.parametrize("direct_light", DirectLight)
def test_errors_of_seeds_are_independent(renderer, direct_light):
    """Correlations over pixels of all iterations of all seeds, but those of the same seed; also of seed a's iteration
    b with seed b's iteration a. Kernels smaller than pixels keep the errors of a picture's pixels apart."""
    seeds, iterations = 12, 4
    scene = lit_floor(0.5, 32768, 0.04, size=32)
    scene.settings = scene.settings.with_values(direct_light=direct_light, alpha=0.999999, iterations=iterations)
    points = pixel_points(scene)
    exact = floor_radiance(np.linalg.norm(points, axis=-1))
    if direct_light is DirectLight.PHOTONS:
        exact = blurred(floor_radiance, points, 0.04)
    errors = np.zeros((seeds, iterations, exact.size))
    for seed in range(seeds):
        scene.settings.seed = seed + 1
        sums = [np.zeros(exact.shape)]

        def keep(progress, frame, sums=sums):
            if progress.iteration:
                sums.append(progress.iteration * frame().combined[..., 0].astype(np.float64))

        renderer.render(scene, on_progress=keep)
        error = np.diff(sums, axis=0) - exact
        errors[seed] = (error / np.sqrt((error**2).mean((1, 2), keepdims=True))).reshape(iterations, -1)
    limit = 1 / np.sqrt(exact.size)
    pairs = itertools.combinations(errors, 2)
    found = np.array([first @ second.T / exact.size for first, second in pairs])
    assert abs(found.mean()) < 4 * limit / np.sqrt(found.size)
    assert abs(found.std() / limit - 1) < 4 / np.sqrt(2 * found.size)
    assert abs(found).max() < 5 * limit


def test_subpixel_offsets_of_seeds_are_independent():
    """Offsets are those of one iteration and the mean of eight, over 400 neighboring seeds."""
    offsets = np.array([[filter_offsets(i, 1.5, seed) for i in range(1, 9)] for seed in range(400)])
    for values in (offsets[:, 0], offsets.mean(1)):
        deviation = values.std(0)
        assert (abs(values.mean(0)) < 4 * deviation / 20).all()
        next_seed = (values[:-1] * values[1:]).mean(0) / deviation**2
        assert (abs(next_seed) < 4 / np.sqrt(399)).all()
        assert abs(np.corrcoef(values.T)[0, 1]) < 4 / 20

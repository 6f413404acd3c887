# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons as many as lower the error: their noise is measured, frames keep finding new light, and none of it shows."""

import dataclasses

import numpy as np
import pytest
import scenes
from rendering import iterated
from support.render_states import assert_same_state, run_until

from rppm_addon.integrator.common import band
from rppm_addon.integrator.common.iteration import LEARNING_ITERATIONS
from rppm_addon.integrator.film import photon_noise
from rppm_addon.scene import Instance, Light, LightKind, Scene

FRAMES, FRAME_ITERATIONS = 24, 6
LUMINANCE = np.array([0.2126391, 0.7151691, 0.0721928])


def floor_and_ball(size: int, ball: float = 0.3, **settings: object) -> Scene:
    """A white floor below a glass ball and an area light, so that all light of photons is one caustic."""
    scene = scenes.room(size, **{"photons": 0, "use_adaptive_radius": False, "photon_path_length": 6} | settings)
    kept = scene.instances[0], dataclasses.replace(scene.instances[5], matrix=scenes.placed(0.0, 0.0, -0.6, ball))
    scene.instances = list(kept)
    return scene


def lamp_in_glass(scene: Scene, power: float) -> Scene:
    """The scene with a lamp in a glass ball of its own, whose light only photons bring."""
    scene.instances.append(Instance(5, scenes.placed(0.55, -0.4, -0.5, 0.2), [3]))
    scene.lights.append(
        Light("in glass", LightKind.POINT, scenes.placed(0.55, -0.4, -0.5), np.full(3, power), radius=0.02)
    )
    return scene


def test_pixels_with_one_photon_have_all_of_it_with_a_sign(mapper):
    iterated(mapper, floor_and_ball(96, photons=40000))
    sums = mapper.stages.density_estimator.sums
    count = mapper.film.width * mapper.film.height
    taken, signed = sums.photons_taken(count)[:, 1], sums.signed(count)[:, 0]
    luminance = sums.read(count)[:, 0].astype(np.float64) @ LUMINANCE
    one, none = taken == 1, taken == 0
    assert one.sum() > 100 and none.sum() > 100
    np.testing.assert_allclose(np.abs(signed[one]), luminance[one], rtol=1e-5, atol=2.0)
    assert not signed[none].any()
    assert (np.abs(signed) <= 1.00001 * luminance + 2.0 * taken).all()
    # Neighbors share photons: at least as many signs as photons that came to them alone.
    positive = np.mean(signed[one] > 0)
    assert 0.25 < positive < 0.75


def test_squares_of_signed_sums_are_the_variance_of_photons(mapper):
    """Photons of many lights in one place are independent; those of one light lie more evenly. With lights without
    extent and fixed points in the pixels, nothing else makes noise."""
    scene = floor_and_ball(24, photons=2048, filter_width=0.0, alpha=0.999999)
    scene.lights = [Light("point", LightKind.POINT, scenes.placed(0.1, 0.1, 0.9), np.full(3, 1.0))] * 512
    found, squares = [], []
    for seed in range(64):
        scene.settings = dataclasses.replace(scene.settings, seed=seed)
        iterated(mapper, scene)
        sums = mapper.stages.density_estimator.sums
        count = mapper.film.width * mapper.film.height
        quanta = sums.read(count)[:, 0].astype(np.float64) @ LUMINANCE
        found.append(sums.quantum * quanta)
        squares.append((sums.quantum * sums.signed(count)[:, 0]) ** 2)
    variance, estimate = np.var(found, 0, ddof=1).mean(), np.mean(squares)
    # The spread of 64 seeds tells a variance within sqrt(2 / 63), and the caustic lies on thirty disks or more.
    assert variance == pytest.approx(estimate, rel=4.0 * np.sqrt(2.0 / 63 / 30))


@pytest.mark.parametrize("pixels", [1 << 20, 700])
def test_samples_are_those_of_whole_rows_and_columns(mapper, monkeypatch, pixels):
    """However many bands there are."""
    monkeypatch.setattr(photon_noise, "_MAX_SAMPLES", pixels)
    scene = floor_and_ball(64)
    rest = []
    for pixels_of_band in (1 << 18, 64 * 10):
        monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", pixels_of_band)
        mapper.build(scene)
        rest.append(run_until(mapper, 1).rest)
    step = mapper.stages.photon_noise.step
    assert step == (1 if pixels > 64 * 64 else 3)
    assert rest[0].shape == mapper.stages.photon_noise.shape == (-(-64 // step), -(-64 // step))
    np.testing.assert_array_equal(rest[0], rest[1])
    film, photons = mapper.film.read_radiance()[::step, ::step, :3], rest[0]
    lit = film @ LUMINANCE.astype(np.float32)
    assert (photons <= lit * 1.0001).all() and np.isclose(photons, lit, rtol=1e-4).mean() > 0.3
    assert photons.mean() > 0.1


def pictures_of(mapper, scene_of_seed, seeds: int, iterations: int) -> np.ndarray:
    """(seeds, H, W, 3) radiance after so many iterations."""
    found = []
    for seed in range(seeds):
        mapper.build(scene_of_seed(seed))
        found.append(run_until(mapper, iterations).radiance[..., :3])
    return np.array(found)


def test_fewer_photons_have_the_same_mean(mapper):
    """Over many seeds; the number of an iteration follows earlier ones and is not the estimate's own."""
    means = []
    for photons in (8192, 0):
        pictures = pictures_of(
            mapper,
            lambda seed, photons=photons: lamp_in_glass(floor_and_ball(20, seed=seed, photons=photons), 0.02),
            24, LEARNING_ITERATIONS + 4,
        )  # fmt: skip
        means.append(pictures.reshape(-1, 5, 4, 5, 4, 3).mean((2, 4, 5)).reshape(-1, 25))
    counts = mapper.learning.photon_counts
    assert counts.latest < counts.first / 4
    many, few = means
    error = np.sqrt((few.var(0, ddof=1) + many.var(0, ddof=1)) / len(few))
    lit = error > 0.0
    distance = (few.mean(0) - many.mean(0))[lit] / error[lit]
    assert lit.sum() > 10 and (np.abs(distance) < 4.5).all()
    whole = few.mean(1).mean() - many.mean(1).mean()
    assert abs(whole) < 4.0 * np.sqrt((few.mean(1).var(ddof=1) + many.mean(1).var(ddof=1)) / len(few))


def test_light_behind_glass_that_the_next_frame_turns_on_is_found(mapper, other_mapper):
    """The frame before has as few photons as there can be, and teaches nothing wrong."""
    dark, lit = floor_and_ball(96, ball=1e-3), lamp_in_glass(floor_and_ball(96, ball=1e-3), 0.4)
    mapper.build(dark)
    before = run_until(mapper, LEARNING_ITERATIONS + 1)
    counts = before.photon_counts
    assert counts.latest == max(counts.first // 16, 512)
    mapper.update(lit)
    found = run_until(mapper, LEARNING_ITERATIONS + 1)
    assert found.photon_counts.latest > 4 * counts.latest
    behind_glass = sum(photons for name, photons in mapper.source_photons.items() if "in glass" in name)
    assert behind_glass > 0.3 * found.photon_counts.latest
    other_mapper.build(lit)
    assert_same_state(run_until(other_mapper, LEARNING_ITERATIONS + 1), found)


def test_light_that_the_next_frame_turns_on_has_its_radiance(mapper):
    """As much as iterations with many photons find, within four standard errors of eight seeds."""
    few, many = (
        pictures_of(
            mapper,
            lambda seed, photons=photons: lamp_in_glass(floor_and_ball(48, 1e-3, seed=seed, photons=photons), 0.4),
            8, LEARNING_ITERATIONS + 1,
        ).mean(axis=(1, 2, 3))
        for photons in (0, 16384)
    )  # fmt: skip
    error = np.sqrt((few.var(ddof=1) + many.var(ddof=1)) / len(few))
    assert error < 0.02 * many.mean(), "the test would not see a difference of a tenth"
    assert abs(few.mean() - many.mean()) < 4.0 * error


def swinging(frame: int, seed: int, photons: int) -> Scene:
    """A lamp in glass that grows brighter, so that frames have other numbers of photons, over a ball that rises."""
    scene = lamp_in_glass(floor_and_ball(40, photons=photons, seed=seed), 0.01 * 1.25**frame)
    scene.instances[1] = dataclasses.replace(scene.instances[1], matrix=scenes.placed(0.0, 0.002 * frame, -0.6, 0.3))
    return scene


@pytest.mark.long
def test_numbers_that_change_between_frames_do_not_show(mapper):
    """Two series with seeds of their own, against as many photons in all: what both series have in common of the
    distance would be a bias that comes and goes with the numbers."""
    apart, photons = {}, []
    for seed in (0, 1):
        blocks = []
        for frame in range(FRAMES):
            pictures = []
            for wanted in (0, 8192):
                mapper.build(swinging(frame, seed, wanted))
                pictures.append(run_until(mapper, FRAME_ITERATIONS).radiance[..., :3].mean(-1))
                if wanted == 0 and seed == 0:
                    photons.append(mapper.learning.photon_counts.latest)
            means = [picture.reshape(2, 20, 2, 20).mean((1, 3)) for picture in pictures]
            blocks.append((means[0] - means[1]) / (means[1] + 0.01))
        apart[seed] = np.array(blocks)
    assert len(set(photons)) >= 3, photons
    changes = [np.diff(apart[seed], axis=0) for seed in (0, 1)]
    products = changes[0] * changes[1]
    error = products.std() / np.sqrt(products.size)
    assert products.mean() < 4.0 * error
    assert 4.0 * error < 0.03**2, "the test would not see a bias of three percent"

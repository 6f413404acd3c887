# SPDX-License-Identifier: GPL-3.0-or-later
"""Radii for caustics follow the photons that pixels take."""

import dataclasses

import numpy as np
import pytest
from busy_scenes import busy_room
from support.iteration_block import iteration_buffer
from support.render_states import run_until

from rppm_addon.gl.context.timers import StageTimers
from rppm_addon.integrator.common import band
from rppm_addon.integrator.common.records.importons import IMPORTON, GatherFlag
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.density_estimation.caustic_radii import CausticRadii
from rppm_addon.integrator.density_estimation.radii import EXPECTED_CAUSTIC_PHOTONS, Radii, shrinkage
from rppm_addon.integrator.density_estimation.splat_sums import SplatSums
from rppm_addon.scene import DensityEstimation, Scene

MOST = 4.0


def many_photons(**settings: object) -> Scene:
    scene = busy_room()
    values = {"photons": 4096, "density_estimation": DensityEstimation.GRID} | settings
    return dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, **values))


@pytest.mark.parametrize(
    ("roulette", "fraction", "held"), [(0, 1.0, 1.0), (7, 1.0, 1.0), (0, 0.5, 0.5), (0, 0.1, 0.25)]
)
def test_disks_shrink_to_what_they_should_hold(context, library, roulette, fraction, held, monkeypatch):
    """The closed form, band by band and iteration by iteration; Eq. 2's shrinkage is no reason to shrink more."""
    pixels = 40
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", 12)
    sizes = StageSizes(1, pixels)
    assert len(sizes.bands) == 4
    radii, sums = CausticRadii(context, library, sizes), SplatSums(context, library, sizes)
    sums.count_in(1.0, roulette, 1)
    timers = StageTimers(context)
    random = np.random.default_rng(4)
    most = 3.0
    expected = np.full(pixels, most)
    for iteration in (1, 2, 4):
        shrunk = shrinkage(iteration, 0.7)
        counts = random.poisson(np.linspace(0, 60, pixels)[:, None], (pixels, 6)).astype(np.uint32)
        for rows in sizes.bands:
            sums.blocks["PhotonCounts"].write(counts[rows.first_row : rows.first_row + rows.rows].tobytes())
            of_iteration = Radii(0.0, 1.0, 1.0, 1.0, most, shrunk)
            blocks = {"Iteration": iteration_buffer(context, number=iteration)}
            radii.narrow(blocks, sums, rows, of_iteration, fraction, timers)
            blocks["Iteration"].release()
        taken = counts[:, 1] * (2 if roulette else 1) / shrunk**2 / held
        expected *= np.minimum(np.sqrt(EXPECTED_CAUSTIC_PHOTONS / np.maximum(taken, 1.0)), 1.0)
        expected = np.maximum(expected, 1.0)
        np.testing.assert_allclose(radii.read()[:, 0], expected, rtol=1e-5)
    assert expected.min() == 1.0 and expected.max() == most and np.sum((expected > 1.0) & (expected < most)) > 3
    radii.release()
    sums.release()


def test_radii_fall_where_photons_are_many(mapper):
    """Never elsewhere, and they never rise; gathering rays and what they share keep their radii."""
    mapper.build(many_photons())
    before = np.full((16, 16), MOST, np.float32)
    for iteration in range(1, 6):
        run_until(mapper, iteration)
        now = mapper.state().radius_factors
        assert (now <= before).all() and (now >= 1.0).all()
        if iteration in (1, 2, 4):
            assert (now < before).any(), "nothing was learned: the test shows nothing"
        else:
            np.testing.assert_array_equal(now, before)
        before = now
    assert (before == MOST).any() and (before < 0.9 * MOST).any()


def test_a_factor_multiplies_the_radius_of_its_pixel(mapper):
    """The importons are those that gathering rays did not lead to."""
    seen = {}
    for adaptive in (False, True):
        mapper.build(many_photons(use_adaptive_radius=adaptive, camera_path_length=1))
        factors = run_until(mapper, 2).radius_factors.reshape(-1)
        mapper.iterate()
        count = mapper.stages.bands[-1].pixel_count
        importons = mapper.stages.importons.importons.read(IMPORTON.dtype, count)
        assert (importons["gathers"] != GatherFlag.HIT).all()
        seen[adaptive] = factors[-count:], importons["radius"]
    (ones, plain), (factors, radii) = seen[False], seen[True]
    assert (ones == 1.0).all() and np.ptp(factors) > 0.5 and np.count_nonzero(plain) > 50
    np.testing.assert_allclose(radii, factors * plain, rtol=1e-6)


def test_without_adaptive_radius_limits_are_those_given(mapper):
    """Automatic limits, given as the user's, are Eq. 3's to the bit."""
    mapper.build(many_photons(use_adaptive_radius=False))
    plain = run_until(mapper, 3)
    low, high = mapper.learning.radius_schedule.limits
    mapper.build(many_photons(radius_minimum=low, radius_maximum=high))
    exact = run_until(mapper, 3)
    assert (plain.radius_factors == 1.0).all() and (exact.radius_factors == 1.0).all()
    np.testing.assert_array_equal(plain.radiance, exact.radiance)
    mapper.build(many_photons())
    assert not np.array_equal(run_until(mapper, 3).radiance, plain.radiance)

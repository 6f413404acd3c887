# SPDX-License-Identifier: GPL-3.0-or-later
"""A mapper that is given the state of another goes on as that one would have."""

import dataclasses

import numpy as np
import pytest
from busy_scenes import busy_room
from moving_scenes import everything_moves
from rendering import iterated
from support.render_states import assert_goes_on, assert_same_state, run_until

from rppm_addon.integrator.common import band
from rppm_addon.integrator.common.iteration import LEARNING_ITERATIONS
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import DirectLight
from rppm_addon.scene.errors import CheckpointError
from rppm_addon.scene.passes import FILM_PASSES
from rppm_addon.session.render.merged_passes import MergedPasses

LAST = LEARNING_ITERATIONS + 3
STOPS = (1, 2, 3, 7, 16, 17)


@pytest.fixture(autouse=True, scope="module")
def several_bands():
    """A whole one and a part."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(band, "MAXIMUM_BAND_PIXELS", 16 * 9)
        yield


@pytest.fixture(scope="module")
def states_of_a_whole(context, library):
    """After each iteration that a test of the busy room looks at, of a render that is not interrupted."""
    with context.moderngl:
        mapper = ProgressivePhotonMapper(context, library)
        mapper.build(busy_room())
        states = {stop: run_until(mapper, stop) for stop in (*STOPS, 18, LAST)}
        mapper.release()
    return states


@pytest.mark.parametrize(
    ("direct_light", "stops"),
    [pytest.param(DirectLight.RAYS, STOPS, marks=pytest.mark.long), (DirectLight.PHOTONS, (2, 16))],
)
def test_a_state_goes_on_bit_for_bit(mapper, other_mapper, states_of_a_whole, direct_light, stops):
    scene = busy_room(direct_light)
    mapper.build(scene)
    whole = run_until(mapper, LAST)
    if direct_light is DirectLight.RAYS:
        states = states_of_a_whole
    else:
        mapper.build(scene)
        states = {stop: run_until(mapper, stop) for stop in (*stops, LAST)}
    assert_same_state(states[LAST], whole)  # asking for the state changes nothing
    states = [states[stop] for stop in stops]
    assert len({state.wide_radius for state in states}) > 1, "nothing was learned: the test shows nothing"
    for name in ("tallies", "radius_factors"):
        assert not np.array_equal(getattr(states[0], name), getattr(states[-1], name)), name
    for state in states:
        other_mapper.build(scene)
        other_mapper.resume(state)
        assert_same_state(run_until(other_mapper, LAST), whole)


@pytest.mark.parametrize("moving", [pytest.param(False, marks=pytest.mark.long), True])
def test_automatic_photons_are_those_of_the_whole(mapper, other_mapper, moving):
    """Later iterations have other numbers than the first one, however one comes to them."""
    scene = busy_room()
    scene.settings.photons = 0
    if moving:
        scene = everything_moves(scene, 1.0)
    mapper.build(scene)
    assert mapper.photons_emitted(0) == 0
    early = [run_until(mapper, stop) for stop in (1, 2, 7, 16)]
    assert [state.rest is None for state in early] == [False, False, False, True]
    whole = run_until(mapper, LAST)
    first, later = scene.photon_count, whole.photon_counts.latest
    assert 256 < later < first == whole.photon_counts.first
    assert mapper.photons_emitted(3) == sum(whole.photon_counts.of(number) for number in (1, 2, 3)) < 3 * first
    assert sum(mapper.source_photons.values()) == mapper.read_photons().shape[1] == later
    for state in early:
        other_mapper.build(scene)
        other_mapper.resume(state)
        assert_same_state(run_until(other_mapper, LAST), whole)
    other_mapper.update(scene)
    for _ in other_mapper.skip(LEARNING_ITERATIONS + 1):
        pass
    part = run_until(other_mapper, LAST)
    names = "iteration", "photon_counts", "photon_noise", "wide_radius", "radius_factors", "tallies", "learned"
    assert_same_state(part, whole, *names)
    assert other_mapper.photons_emitted(3) == 3 * later


def test_photons_stay_as_many_where_all_light_is_theirs(mapper):
    """Without final gather more photons are less noise everywhere."""
    scene = busy_room()
    scene.camera = dataclasses.replace(scene.camera, width=96, height=96)
    later = {}
    for gathers in (True, False):
        scene.settings = dataclasses.replace(scene.settings, photons=0, use_final_gather=gathers)
        mapper.build(scene)
        later[gathers] = run_until(mapper, 2).photon_counts.latest
    assert later[True] < later[False] == scene.photon_count == 96 * 96


@pytest.mark.parametrize("sample_offset", [1, 16, 18])
def test_iterations_that_are_left_out_are_those_of_the_whole(mapper, states_of_a_whole, sample_offset):
    before, whole = states_of_a_whole[sample_offset], states_of_a_whole[LAST]
    mapper.build(busy_room())
    for _ in mapper.skip(sample_offset):
        pass
    assert mapper.iterations_in_film == 0
    part = run_until(mapper, LAST)
    assert_same_state(part, whole, "iteration", "wide_radius", "radius_factors", "tallies", "learned")
    assert part.iterations_in_film == LAST - sample_offset
    radiance = (sample_offset * before.radiance.astype(np.float64) + (LAST - sample_offset) * part.radiance) / LAST
    np.testing.assert_allclose(radiance, whole.radiance, rtol=1e-6, atol=1e-6 * whole.radiance.mean())
    np.testing.assert_array_equal(before.pass_counts + part.pass_counts, whole.pass_counts)
    merged = MergedPasses(FILM_PASSES)
    for state in (before, part):
        merged.add(state.passes, state.pass_counts, state.iterations_in_film)
    assert merged.result().keys() == whole.passes.keys()
    for name, values in merged.result().items():
        np.testing.assert_allclose(values, whole.passes[name], rtol=1e-6, atol=1e-6, err_msg=name)


def test_moments_of_an_open_shutter_are_those_of_the_whole(mapper, other_mapper):
    """Each iteration has its time by its number, however one came to it."""
    scene = everything_moves(busy_room(), 1.0)
    whole = assert_goes_on(mapper, scene, iterations=LAST, stops=(3,), other=other_mapper)
    mapper.build(scene)
    before = run_until(mapper, 18)
    other_mapper.build(scene)
    for _ in other_mapper.skip(18):
        pass
    part = run_until(other_mapper, LAST)
    assert_same_state(part, whole, "wide_radius", "tallies", "learned")
    radiance = (18 * before.radiance.astype(np.float64) + part.radiance) / LAST
    np.testing.assert_allclose(radiance, whole.radiance, rtol=1e-6, atol=1e-6 * whole.radiance.mean())


def test_the_pane_ends_paths(states_of_a_whole):
    """Else the counts of the normals are those of the iterations, and the tests above show less."""
    counts = states_of_a_whole[LAST].pass_counts[..., 0]
    assert counts.max() == LAST
    assert 0 < counts.min() < LAST


def test_a_state_of_another_scene_is_refused(mapper):
    scene = busy_room()
    automatic, fewer = (
        dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, photons=photons))
        for photons in (0, 100)
    )
    smaller = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, width=7))
    state, noisy = (iterated(mapper, each).state() for each in (scene, automatic))
    for other, spoiled, said in (
        (smaller, state, "16x16 pixels, not 7x16"),
        (automatic, dataclasses.replace(noisy, rest=np.zeros((3, 3), np.float32)), "samples"),
        (automatic, dataclasses.replace(noisy, rest=None), "noise of photons"),
        (fewer, state, "cells"),
    ):
        mapper.build(other)
        with pytest.raises(CheckpointError, match=said):
            mapper.resume(spoiled)

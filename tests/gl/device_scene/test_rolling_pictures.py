# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a rolling shutter."""

import dataclasses

import numpy as np
import pytest
import scenes
from moving_scenes import everything_moves
from support.lobes import Lobe, LobeKind, material
from support.render_states import assert_goes_on

from rppm_addon.scene import Instance, Movement, Scene, Shutter

SIZE = 16


def moving_bar(duration: float, iterations_from: float = -4.0, **settings: object) -> Scene:
    """A bar of radiance 1 that crosses the picture, 16 m wide, by 8 m while the shutter is open."""
    bar = scenes.rectangle("bar", (-2.0, -9.0, 0.0), (2.0, -9.0, 0.0), (2.0, 9.0, 0.0), (-2.0, 9.0, 0.0))
    camera = scenes.camera((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), 8.0, SIZE, orthographic=True)
    glow = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)))
    scene = scenes.scene_of(camera, (bar, glow), photons=64, filter_width=0.0, **settings)
    ways = np.stack([np.eye(4), np.eye(4)])
    ways[:, 0, 3] = iterations_from, -iterations_from
    shutter = Shutter(np.ones(4), [Movement(0, np.array([0.0, 1.0]), ways)], rolling_duration=duration)
    return dataclasses.replace(scene, instances=[Instance(0, np.eye(4), [0])], shutter=shutter)


@pytest.mark.parametrize("duration", [0.0, 0.4])
def test_a_bar_leans(mapper, duration):
    """The middle of the bar in each row is where it is in the middle of the row's time. Its edges are blurred by its
    way in that time."""
    mapper.build(moving_bar(duration))
    for _ in range(256):
        mapper.iterate()
    picture = mapper.film.read_radiance()[..., 0].astype(np.float64)
    places = np.arange(SIZE) + 0.5 - SIZE / 2
    np.testing.assert_allclose(picture.sum(axis=1), 4.0, atol=0.4)
    middles = (picture * places).sum(axis=1) / picture.sum(axis=1)
    times = 0.5 + (0.5 - np.arange(SIZE) / SIZE) * (1.0 - duration)
    # The first and the last row of a shutter that exposes single rows are exposed for half of a row's time alone.
    np.testing.assert_allclose(middles[1:], (8.0 * times - 4.0)[1:], atol=0.25)
    spread = np.sqrt((picture * (places - middles[:, None]) ** 2).sum(axis=1) / picture.sum(axis=1))
    # Standard deviations of the bar itself and of its way.
    np.testing.assert_allclose(spread[1:-1], np.hypot(4.0, 8.0 * duration) / np.sqrt(12.0), rtol=0.1)


def test_rows_that_are_not_exposed_yet_show_the_first_moment(mapper):
    mapper.build(moving_bar(0.1))
    mapper.iterate()
    picture = mapper.film.read_radiance()[..., 0]
    assert (picture == picture[:1]).all() and picture.max() == 1.0


def rolling_room(**settings: object) -> Scene:
    room = scenes.room(16, photons=1024, camera_path_length=3, photon_path_length=4, **settings)
    scene = everything_moves(room, 1.0)
    return dataclasses.replace(scene, shutter=dataclasses.replace(scene.shutter, rolling_duration=0.3))


def test_a_state_goes_on_in_the_middle(mapper, other_mapper):
    assert_goes_on(mapper, rolling_room(), "radiance", "tallies", iterations=7, stops=(2, 5), other=other_mapper)


@pytest.mark.long
def test_the_noise_of_all_rows_is_measured(mapper):
    mapper.build(rolling_room(use_adaptive_sampling=True))
    mapper.iterate()
    assert mapper.measure_noise() == np.inf
    for _ in range(127):
        mapper.iterate()
    noisy = mapper.measure_noise()
    assert 0.0 < noisy < 1.0
    for _ in range(128 * 2):
        mapper.iterate()
    assert mapper.measure_noise() < 0.8 * noisy

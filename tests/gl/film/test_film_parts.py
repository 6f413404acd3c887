# SPDX-License-Identifier: GPL-3.0-or-later
"""Films that are larger than a device allows a buffer to be."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.render_states import assert_same_state

from rppm_addon.integrator.common import band, film_buffers
from rppm_addon.integrator.common.film_buffers import FilmBuffer
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.scene.errors import DeviceError

WIDTH, HEIGHT = 8, 40


@pytest.fixture(autouse=True)
def bands_of_a_row(monkeypatch):
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", WIDTH)


def film_parts(context, library, per_pixel=1):
    return FilmBuffer("film", "vec4", per_pixel, together=True).make(
        context, library, StageSizes(WIDTH, HEIGHT), "lower the resolution"
    )


@pytest.mark.parametrize(
    "limit, rows", [(16 * WIDTH * 40, [40]), (16 * WIDTH * 33, [32, 8]), (16 * WIDTH * 31, [16, 16, 8])]
)
def test_parts_hold_what_a_film_does(context, library, monkeypatch, limit, rows):
    monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", limit)
    parts = film_parts(context, library)
    assert parts.rows == rows and max(part.size for part in parts) <= limit
    assert (parts.whole is None) == (len(rows) > 1)
    values = np.random.default_rng(3).random((HEIGHT, WIDTH, 4), np.float32)
    parts.upload(values)
    np.testing.assert_array_equal(parts.read(np.float32, 4), values)
    for one in StageSizes(WIDTH, HEIGHT).bands:
        first = 4 * parts.first_pixel(one)
        found = np.frombuffer(parts.of(one).read(), np.float32)[first : first + 4 * WIDTH]
        np.testing.assert_array_equal(found, values[one.first_row].reshape(-1))
    parts.clear()
    assert not parts.read(np.float32, 4).any()
    parts.release()


def test_where_no_part_of_whole_blocks_of_rows_fits_a_film_is_refused(context, library, monkeypatch):
    monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", 16 * WIDTH * 15)
    with pytest.raises(DeviceError, match="film needs .* in one buffer; lower the resolution"):
        film_parts(context, library)


@pytest.mark.long
def test_pictures_in_parts_are_those_of_one(mapper, other_mapper, monkeypatch):
    """With the noise, of which half of the iterations from the 17th on tells."""
    scene = scenes.room(
        WIDTH, photons=256, camera_path_length=2, photon_path_length=2, use_adaptive_sampling=True,
        passes=("Depth", "Vector", "CryptoObject00"),
    )  # fmt: skip
    scene = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, width=WIDTH, height=HEIGHT))
    states, noises = [], []
    for one, parts in ((mapper, 1), (other_mapper, 3)):
        if parts == 3:
            monkeypatch.setattr(film_buffers, "_BYTES_TOGETHER", one.context.storage_block_limit // (20 * WIDTH))
        one.build(scene)
        while one.iteration < 18:
            one.iterate()
        assert len(one.film.radiance) == parts
        states.append(one.state())
        noises.append(one.measure_noise())
    assert_same_state(*states)
    assert noises[0] == noises[1] > 0.0
    assert states[0].radiance.any() and states[0].half.any()
    other_mapper.build(scene)
    other_mapper.resume(states[0])
    assert_same_state(other_mapper.state(), states[0])

# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass table, and what follows from it without a device."""

import numpy as np
import pytest

from rppm_addon.integrator.common.band import MAXIMUM_BAND_PIXELS
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.film.film import Film
from rppm_addon.integrator.memory import expected_memory
from rppm_addon.pictures import read_exr, write_exr
from rppm_addon.scene import RenderSettings
from rppm_addon.scene.errors import SettingsError
from rppm_addon.scene.passes import FILM_PASSES, PASSES, Accumulation, light_group_passes, passes_named
from rppm_addon.session.render.merged_passes import MergedPasses


def random_values(entry, shape, random):
    values = random.random((*shape, len(entry.channels)), np.float32)
    return values if len(entry.channels) > 1 else values[..., 0]


def test_names_are_found_in_the_order_of_the_table():
    names = [entry.name for entry in PASSES]
    assert [entry.name for entry in passes_named(names[::-1])] == names
    assert len({entry.identifier for entry in PASSES}) == len(names)


def test_a_name_that_is_none_is_refused_with_those_that_are():
    settings = RenderSettings().with_values(passes="Depth, Nothing")
    assert settings.passes == ("Depth", "Nothing")
    with pytest.raises(SettingsError, match="no pass Nothing; the passes are .*Normal"):
        settings.validate()


def test_every_pass_goes_through_an_exr(tmp_path):
    random = np.random.default_rng(3)
    values = {entry.name: random_values(entry, (4, 6), random) for entry in PASSES}
    write_exr(tmp_path / "all.exr", random.random((4, 6, 4), np.float32), values)
    picture = read_exr(tmp_path / "all.exr")
    for name, expected in values.items():
        np.testing.assert_array_equal(picture.layer(name), expected, name)


def test_merged_parts_are_the_whole():
    """Seven iterations of three pixels: one sees a surface always, one from the third on, one never."""
    random = np.random.default_rng(5)
    found = np.array([[True] * 7, [False] * 2 + [True] * 5, [False] * 7]).T.reshape(7, 1, 3)
    iterations = {entry.name: random_values(entry, (7, 1, 3), random) for entry in FILM_PASSES}

    def part(first, end):
        counts = np.stack([np.full((1, 3), end - first), found[first:end].sum(0)], axis=-1).astype(np.uint32)
        passes = {}
        for entry in FILM_PASSES:
            values = iterations[entry.name][first:end]
            seen = found[first:end].reshape(end - first, 1, 3, *[1] * (values.ndim - 3))
            if entry.accumulation is Accumulation.MEAN:
                passes[entry.name] = np.where(seen, values, entry.nothing).mean(0).astype(np.float32)
            elif entry.accumulation is Accumulation.SUM:
                passes[entry.name] = values.mean(0).astype(np.float32)
            else:
                first_seen = np.take_along_axis(values, seen.argmax(0)[None], axis=0)[0]
                passes[entry.name] = np.where(seen.any(0), first_seen, np.float32(entry.nothing))
        return passes, counts

    merged = MergedPasses(FILM_PASSES)
    for ends in ((0, 2), (2, 6), (6, 7)):
        merged.add(*part(*ends), ends[1] - ends[0])
    whole, _ = part(0, 7)
    assert merged.result().keys() == whole.keys()
    for name, values in merged.result().items():
        np.testing.assert_allclose(values, whole[name], rtol=1e-6, err_msg=name)


def test_passes_that_are_off_take_no_memory():
    width, height = 1024, MAXIMUM_BAND_PIXELS // 512
    pixels, radiance = width * height, {"film": 16 * width * height}
    assert Film.expected_bytes(StageSizes(width, height)) == radiance
    channels = sum(len(entry.channels) for entry in FILM_PASSES)
    values = {"pass values": 4 * channels * pixels, "pass counts": 8 * pixels, "pass paths": 16 * MAXIMUM_BAND_PIXELS}
    assert Film.expected_bytes(StageSizes(width, height, passes=FILM_PASSES)) == radiance | values
    four_pairs = passes_named(["CryptoMaterial00", "CryptoMaterial01"])
    pairs = {"cryptomatte of materials": 8 * 4 * pixels}
    assert Film.expected_bytes(StageSizes(width, height, passes=four_pairs)) == radiance | pairs
    wanted = ((), passes_named(["Depth"]), light_group_passes(["key"]))
    without, beside, grouped = (expected_memory(16, 16, 64, 2, passes=passes).total_bytes for passes in wanted)
    assert beside - without == 256 * (4 + 8)
    assert grouped - without == 256 * (12 + 24 + 48 + 3 * 16 + 32)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures and photons as many as devices and 32 bits count, before anything is allocated."""

import dataclasses

import numpy as np
import pytest

from rppm_addon.integrator.common.band import MAX_RASTER_PIXELS, MAXIMUM_BAND_PIXELS, bands_of
from rppm_addon.integrator.common.camera_view import is_rasterized
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.memory import expected_memory
from rppm_addon.integrator.stage_set import StageSet
from rppm_addon.scene.camera import Camera
from rppm_addon.scene.errors import DeviceError
from rppm_addon.scene.passes import PASSES

LARGEST_BLOCK = (1 << 32) - 1
"""Bytes that a device of today allows in a storage block."""


class Device:
    """One without end, but for a block."""

    available_memory = None

    def __init__(self, limit):
        self.storage_block_limit = limit
        self.array_limit = lambda texel_bytes: max(limit, min((texel_bytes or 0) << 27, LARGEST_BLOCK))
        self.information = dataclasses.make_dataclass("Information", ["name"])("Device")


@pytest.mark.parametrize(
    "width, height",
    [
        (1, 1), (128, 128), (1920, 1080), (7680, 4320), (300000, 3), (3, 300000),
        (1, 1 << 20), (16384, 16384), (17000, 2), (2, 17000), (1 << 20, 3),
    ],
)  # fmt: skip
def test_bands_can_be_drawn_and_cover_every_row_once(width, height):
    bands = bands_of(width, height)
    rows = [row for band in bands for row in range(band.first_row, band.first_row + band.rows)]
    assert rows == list(range(height))
    assert max(band.rows for band in bands) <= MAX_RASTER_PIXELS
    assert all(band.rows == 1 or band.pixel_count <= MAXIMUM_BAND_PIXELS for band in bands)


@pytest.mark.parametrize("width, crop, is_drawn", [(16384, None, True), (16385, None, False), (20000, 9000, True)])
def test_rows_that_are_too_long_to_draw_are_traced(width, crop, is_drawn):
    region = crop and (0, 0, crop, 2)
    assert is_rasterized(Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), width, 2, crop=region)) == is_drawn


@pytest.mark.parametrize("width, height, photons", [(65536, 65536, 1), (1 << 31, 8, 1), (8, 8, 1 << 31)])
def test_forecasts_do_not_wrap(width, height, photons):
    """Each part is as many times as large as it has items: nothing is counted in 32 bits."""
    large, small = expected_memory(width, height, photons, 8), expected_memory(64, 64, photons, 8)
    assert large.ppm["film"] == width * height * small.ppm["film"] // 64**2 if photons == 1 else True
    assert large.ppm["photons"] == 64 * photons * 4
    assert large.total_bytes > 16 * width * height + 64 * photons


@pytest.mark.parametrize("width, height, photons", [(1 << 29, 2, 1024), (64, 64, 1 << 31)])
@pytest.mark.parametrize("limit", [128 << 20, LARGEST_BLOCK])
def test_what_no_block_holds_is_refused(width, height, photons, limit):
    with pytest.raises(DeviceError, match=r"needs \d+ MiB but the device Device allows \d+ MiB in one buffer; lower"):
        StageSet.refuse_large(Device(limit), StageSizes(width, height, photons, 8))


@pytest.mark.parametrize("size", [(7680, 4320), (16384, 8192), (12000, 12001)])
def test_large_pictures_lie_in_blocks_of_128_mib(size):
    """With all passes."""
    sizes = StageSizes(*size, 1 << 18, 8, PASSES, has_catchers=True, measures_noise=True, is_filtered=True)
    StageSet.refuse_large(Device(128 << 20), sizes)


def test_words_of_what_a_block_holds_have_numbers_of_32_bits():
    """Shaders count words of a block, and items times their words, in uint."""
    assert LARGEST_BLOCK // 4 < 1 << 32
    StageSet.refuse_large(Device(LARGEST_BLOCK), StageSizes(8192, 8192, 1 << 22, 8))

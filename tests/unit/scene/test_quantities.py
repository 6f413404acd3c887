# SPDX-License-Identifier: GPL-3.0-or-later
"""Quantities as short texts."""

import pytest

from rppm_addon.scene.common.quantities import bytes_text, clock_text, count_text, rate_text, seconds_text


@pytest.mark.parametrize(
    ("text_of", "texts"),
    [
        (count_text, {0: "0", 950: "950", 65536: "65.5 k", 8388608: "8.39 M", 1.2e9: "1.20 G"}),
        (bytes_text, {512: "512 B", 65536: "64.0 KiB", 82942362: "79.1 MiB", 3 << 29: "1.50 GiB", 1 << 20: "1.0 MiB"}),
        (seconds_text, {0.25: "0.25 s", 12.34: "12.3 s", 125: "2:05 min", 3725.4: "1:02:05 h"}),
        (rate_text, {0.25: "0.25", 12.34: "12.3", 950.0: "950", 65536.0: "65.5 k"}),
        (clock_text, {0.2: "00:00", 4.2: "00:04", 749.6: "12:30", 3725.4: "1:02:05"}),
    ],
)
def test_quantities_are_short(text_of, texts):
    assert {quantity: text_of(quantity) for quantity in texts} == texts

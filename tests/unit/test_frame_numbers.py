# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame numbers as a user writes them."""

from pathlib import Path

import pytest

from rppm_addon.commands.frame_numbers import frame_numbers, frame_path
from rppm_addon.scene.errors import SettingsError


@pytest.mark.parametrize(
    ("text", "frames"),
    [
        ("7", (7,)),
        ("1..4", (1, 2, 3, 4)),
        ("1..10..4", (1, 5, 9)),
        ("-2..1", (-2, -1, 0, 1)),
        ("5,1..3,2", (5, 1, 2, 3)),
    ],
)
def test_ranges_steps_and_lists(text, frames):
    assert frame_numbers(text) == frames


@pytest.mark.parametrize("text", ["", "1-4", "1..", "4..1", "1..4..0", "a", "1,,2", "1.5"])
def test_what_holds_no_frame_is_refused(text):
    with pytest.raises(ValueError):
        frame_numbers(text)


@pytest.mark.parametrize(
    ("pattern", "frame", "name"),
    [
        ("####.exr", 12, "0012.exr"),
        ("a_##_b.png", 123, "a_123_b.png"),
        ("a#_####.exr", 5, "a#_0005.exr"),
        ("####.exr", -3, "-0003.exr"),
    ],
)
def test_the_last_row_of_hashes_is_the_number(pattern, frame, name):
    assert frame_path(Path("out") / pattern, frame) == Path("out") / name


def test_a_name_without_hashes_is_refused():
    with pytest.raises(SettingsError, match="####"):
        frame_path(Path("out##/a.exr"), 1)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Options behind two dashes, and the exit status for lost frames; tests/gui has Blender itself end with it."""

import pytest

from rppm_addon.blender import background


@pytest.mark.parametrize(
    ("arguments", "device"),
    [
        (["blender", "-b", "x.blend", "-a", "--", "--rppm-device", "2"], "2"),
        (["blender", "-b", "--", "--cycles-device", "CPU", "--rppm-device=3", "file"], "3"),
        (["blender", "--rppm-device", "2"], "1"),  # Blender's own options
        (["blender", "--"], "1"),
    ],
)
def test_the_device_behind_two_dashes_wins(monkeypatch, arguments, device):
    monkeypatch.setenv("RPPM_DEVICE", "1")
    background.read_options(arguments)
    assert background.os.environ["RPPM_DEVICE"] == device


@pytest.mark.parametrize(("word", "text"), [("--rppm-device", "needs a device"), ("--rppm-speed=3", "no option")])
def test_options_that_make_no_sense_are_told(monkeypatch, caplog, word, text):
    monkeypatch.setenv("RPPM_DEVICE", "1")
    background.read_options(["blender", "-b", "--", word])
    assert text in caplog.text and background.os.environ["RPPM_DEVICE"] == "1"


def test_the_status_is_that_of_scripts_that_fail():
    assert background.failure_status(["blender", "-b", "-a"]) == 1
    assert background.failure_status(["blender", "-b", "--python-exit-code", "3", "-a"]) == 3
    assert background.failure_status(["blender", "-b", "--python-exit-code", "0"]) == 1

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


@pytest.mark.parametrize(
    ("arguments", "count"),
    [
        (["blender", "-b", "x.blend", "-a"], 1),
        (["blender", "-b", "-S", "A", "-a", "-S", "B", "--render-anim", "--", "-a"], 2),
        (["blender", "-b", "-f", "1,3..5", "--render-frame", "7"], 5),
        (["blender", "-b", "-f", "+1,-1"], 2),
        (["blender", "-b", "--python", "render.py"], 0),
    ],
)
def test_the_renders_of_a_command_line(arguments, count):
    assert background.renders_asked(arguments) == count


def test_lost_frames_are_told_once_the_last_render_has_ended():
    """Once: Blender's handler of the signal ends it at the second one."""
    count = background.RenderCount(3)
    count.lose_frame()
    assert [count.end_render() for _ in range(5)] == [False, False, True, False, False]


def test_a_script_that_renders_is_told_of_each_render_with_lost_frames():
    count = background.RenderCount(0)
    assert not count.end_render()
    count.lose_frame()
    assert count.end_render() and not count.end_render()

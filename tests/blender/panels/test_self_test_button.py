# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that tries the device, with a device that is not there, which takes no time."""

import bpy
import pytest
from drawing import RecordingLayout

from rppm_addon.blender import self_test
from rppm_addon.blender.render_client import renderer_process


@pytest.fixture
def report(timers, tmp_path, monkeypatch):
    monkeypatch.setattr(renderer_process, "log_path", lambda: tmp_path / "new" / "renderer.log")
    return tmp_path / "new" / "rppm_report.txt"


def test_a_process_writes_the_report(report, timers, monkeypatch):
    monkeypatch.setattr(renderer_process, "environment", lambda: {"RPPM_DEVICE": "no device"})
    assert bpy.ops.rppm.self_test() == {"FINISHED"}
    with pytest.raises(RuntimeError, match="poll"):
        bpy.ops.rppm.self_test()  # one at a time
    layout = RecordingLayout()
    self_test.draw(layout)
    assert layout.record.labels == ["The self-test runs for a minute or two"]
    timers.run_out()
    text = report.read_text()
    assert "stopped: " in text and "there is no device 'no device'" in text and "Not all is well" in text


def test_a_process_that_cannot_be_started(report, monkeypatch):
    monkeypatch.setattr(renderer_process, "python_program", lambda: "/nowhere/python")
    with pytest.raises(RuntimeError, match="cannot be started"):
        bpy.ops.rppm.self_test()
    assert not self_test.is_running()

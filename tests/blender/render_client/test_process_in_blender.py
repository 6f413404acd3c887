# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer process as Blender with a window uses it."""

import os
import signal
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest
from recorder import Recorder, record
from support.baking import add_uv_map, bake
from support.sent_members import watch_sent_members

import rppm_addon
from rppm_addon.blender.render_client import renderer_process, renderer_thread
from rppm_addon.session.client.client import ProcessState
from rppm_addon.session.transport.sessions import SessionKind


@pytest.fixture
def windowed(monkeypatch, tmp_path):
    """Renders go to the process, as where Blender has a window."""
    process = renderer_process.renderer_process()
    process.close()
    monkeypatch.setattr(process.launcher, "log_path", tmp_path / "renderer.log")
    monkeypatch.setattr(renderer_process, "is_used", lambda: True)
    yield process
    process.close()


@pytest.fixture
def expected_of(monkeypatch):
    """Call a function while renders go to the thread, as without a window; the thread has no renderer afterwards."""

    def expected_of(function, *arguments, **given):
        with monkeypatch.context() as patched:
            patched.setattr(renderer_process, "is_used", lambda: False)
            expected = function(*arguments, **given)
        renderer_thread.release()
        monkeypatch.setattr(renderer_thread, "render", lambda *_: pytest.fail("the process was to render"))
        return expected

    return expected_of


class Killer(Recorder):
    """Kills the process of this one's children after the first iteration."""

    def on_progress(self, progress):
        super().on_progress(progress)
        if progress.iteration == 1:
            task = Path(f"/proc/{os.getpid()}/task")
            for child in {int(pid) for thread in task.iterdir() for pid in (thread / "children").read_text().split()}:
                os.kill(child, signal.SIGKILL)


def test_the_process_renders_what_the_thread_does(lit, windowed, expected_of):
    lit.view_layers[0].use_pass_z = lit.view_layers[0].use_pass_normal = True
    expected = expected_of(record, Recorder(snapshots=(0.0,)))
    for _ in range(2):
        recorder = record(Recorder(snapshots=(0.0,)))
        assert windowed.state is ProcessState.RUNNING and not windowed.sessions
        assert recorder.iterations == expected.iterations == [0, 1, 2]
        for before, after in zip(expected.frames, recorder.frames, strict=True):
            np.testing.assert_array_equal(before.combined, after.combined)
            assert before.passes and list(before.passes) == list(after.passes)
            for name, values in before.passes.items():
                np.testing.assert_array_equal(values, after.passes[name])
    assert recorder.frames[-1].combined[16, 16, 0] == pytest.approx(1.0, rel=1e-3)


@pytest.mark.parametrize("persistent", [False, True])
def test_an_animation_sends_only_what_changes(lit, windowed, expected_of, monkeypatch, tmp_path, persistent):
    """And its frames are those of the thread, bit for bit."""
    lit.frame_start, lit.frame_end = 1, 3
    lit.render.filepath = str(tmp_path / "####")
    for frame in (1, 2, 3):
        lit.camera.location.x = 0.1 * frame
        lit.camera.keyframe_insert("location", frame=frame)
    sent = watch_sent_members(monkeypatch)

    expected = expected_of(record, animation=True).frames
    lit.render.use_persistent_data = persistent
    found = record(animation=True).frames
    assert [frame.combined.tobytes() for frame in found] == [frame.combined.tobytes() for frame in expected]
    assert len({session for session, _ in sent}) == 1
    first, *others = sent.values()
    assert "meshes" in first and others == [{"camera"}, {"camera"}]
    # With persistent data Blender's user wants it kept.
    assert len(windowed.sessions) == persistent
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert not windowed.sessions


def test_the_process_bakes_what_the_thread_does(lit, windowed, expected_of):
    add_uv_map(lit.objects["Quad"])
    expected = expected_of(bake, lit.objects["Quad"], type="COMBINED")
    np.testing.assert_array_equal(bake(lit.objects["Quad"], type="COMBINED"), expected)
    assert expected.any() and windowed.state is ProcessState.RUNNING
    for handler in bpy.app.handlers.object_bake_complete:  # which Blender calls where it bakes in a job
        handler(lit.objects["Quad"], None)
    assert not windowed.sessions


def test_errors_reach_the_user(lit, windowed):
    """A process that dies with a scene again and again is an error that names its log."""
    lit.rppm.samples = 1000
    killer = Killer()
    with pytest.raises(RuntimeError, match="SIGKILL"):
        record(killer)
    assert len(killer.errors) == 1 and str(windowed.log_path) in killer.errors[0]
    assert windowed.state is ProcessState.FAILED and windowed.restarts == 2
    windowed.restart()
    lit.rppm.samples = 2
    assert record().frames


def test_the_process_ends_with_the_file_and_with_the_extension(windowed):
    windowed.open(SessionKind.VIEWPORT)
    assert windowed.state is ProcessState.STARTING
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert windowed.state is ProcessState.STOPPED
    windowed.open(SessionKind.VIEWPORT)
    assert windowed.state is ProcessState.STARTING
    rppm_addon.unregister()
    try:
        assert windowed.state is ProcessState.STOPPED
    finally:
        rppm_addon.register()


def test_nothing_is_started_before_it_is_needed(windowed):
    assert windowed.state is ProcessState.STOPPED
    assert not windowed.log_path.exists()


def test_the_python_that_blender_brings(monkeypatch, tmp_path):
    assert renderer_process.python_program() == sys.executable
    monkeypatch.setattr(sys, "executable", "/opt/blender/blender")
    assert Path(renderer_process.python_program()).name.startswith("python")
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    assert renderer_process.python_program() == "python"
    (tmp_path / "bin").mkdir()
    for name in ("python3-config", "python3"):
        (tmp_path / "bin" / name).touch()
    assert renderer_process.python_program() == str(tmp_path / "bin" / "python3")

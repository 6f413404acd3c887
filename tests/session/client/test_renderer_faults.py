# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever the renderer's process does, Blender goes on and can say what happened. Here the process is faked."""

import errno
import os
import re
import statistics
import threading
import time

import numpy as np
import pytest
from session.conftest import children, open_viewport, scene_of, wait_until

from rppm_addon.scene import Image
from rppm_addon.scene.errors import RendererError
from rppm_addon.session.client import launcher, remote_rendering
from rppm_addon.session.client.client import MOST_RESTARTS, ProcessState
from rppm_addon.session.render.render_job import RenderJob
from rppm_addon.session.transport import arrays
from rppm_addon.session.transport.protocol import ProtocolError
from rppm_addon.session.transport.sessions import SessionKind

LONGEST_CALL = 5.0
"""Seconds: one that waits for the process waits for a minute at least; one that does not may have to wait for a
processor that many tests want."""
USUAL_CALL = 0.005


def failed(process):
    wait_until(lambda: process.state is ProcessState.FAILED)
    assert process.error.count("\n") == 0
    assert str(process.log_path) in process.error
    assert not children()
    return process.error


@pytest.mark.parametrize(
    ("fault", "text"),
    [
        ("import_error", "ended with code 1"),
        ("ends_before_the_greeting", "ended with code 3"),
        ("dies_with_each_scene", "ended by SIGSEGV"),
        ("dies_amid_a_message", "ended with code 7"),
        ("sends_malformed_data_first", "cannot be understood"),
        pytest.param("sends_no_json", "cannot be understood", marks=pytest.mark.long),
        pytest.param("sends_unknown_messages", "cannot be understood .*weather", marks=pytest.mark.long),
        pytest.param("sends_wrong_content", "cannot be understood .*mood", marks=pytest.mark.long),
        ("sends_impossible_frames", "cannot be understood .*1048576"),
        ("names_foreign_files", "cannot be understood .*passwd"),
    ],
)
def test_what_happens_again_and_again_ends_in_failure(start, fault, text):
    process = start(fault)
    session = open_viewport(process)
    error = failed(process)
    assert re.search(text, error)
    assert process.restarts == MOST_RESTARTS == 2
    assert session.status.error == error and session.status.settled
    preview = process.open(SessionKind.PREVIEW)
    assert preview.events.get(timeout=1.0)[0] == "failed" and process.state is ProcessState.FAILED
    process.error = "forgotten"
    open_viewport(process)  # which a user asked for: the process is tried again
    assert failed(process) == error and process.restarts == MOST_RESTARTS


@pytest.mark.parametrize(
    ("fault", "text"), [("has_no_device", "install a driver"), ("is_of_another_version", "restart Blender")]
)
def test_what_another_process_would_not_change_is_tried_once(start, fault, text):
    process = start(fault)
    open_viewport(process)
    assert text in failed(process)
    assert process.restarts == 0


def test_a_program_that_is_not_there(start, tmp_path):
    process = start()
    process.launcher.python = [str(tmp_path / "python")]
    open_viewport(process)
    assert "cannot be started" in failed(process)


@pytest.mark.parametrize(
    ("fault", "timeouts", "text"),
    [
        ("hangs_in_the_greeting", {"start": 0.5}, "did not start within 0.5 s"),
        ("hangs_and_stops_reading", {"start": 30.0, "ping": 0.05, "answer": 0.5}, "did not answer for 0.5 s"),
        ("hangs_after_a_frame", {"start": 30.0, "ping": 0.05, "answer": 0.5}, "did not answer for 0.5 s"),
    ],
)
def test_who_hangs_is_ended(start, fault, timeouts, text):
    process = start(fault, **timeouts)
    open_viewport(process)
    assert text in failed(process)
    assert process.restarts == MOST_RESTARTS


def test_the_log_has_what_the_process_printed(start):
    process = start("import_error")
    open_viewport(process)
    failed(process)
    assert process.log_path.read_text().count("ImportError: no module that draws") == 1 + MOST_RESTARTS


def test_the_log_does_not_grow_without_end(start, monkeypatch):
    monkeypatch.setattr(launcher, "LARGEST_LOG", 1 << 20)
    process = start("fills_the_log", ping=0.01, leave=0.1)
    open_viewport(process)
    wait_until(process.log_path.exists)
    sizes = [0]
    wait_until(lambda: sizes.append(process.log_path.stat().st_size) or sizes[-1] < sizes[-2])
    assert process.state is ProcessState.RUNNING


def test_nothing_is_left_open(start):
    """No files, no threads, however often a process dies and is restarted."""

    def left():
        return len(os.listdir("/proc/self/fd")), threading.active_count()

    before = left()
    process = start("dies_with_each_scene")
    session = open_viewport(process)
    for _ in range(3):
        failed(process)
        process.restart()
    failed(process)
    session.close()
    assert left() == before


def test_restart_tries_again(start):
    process = start("import_error")
    open_viewport(process)
    failed(process)
    process.restart()
    assert process.state is ProcessState.STARTING and process.restarts == 0 and not process.error
    failed(process)
    assert process.restarts == MOST_RESTARTS


def test_frames_go_on_after_a_death_amid_a_frame(start):
    process = start("is_killed_amid_a_frame")
    session = open_viewport(process)
    first = wait_until(session.newest)
    second = wait_until(lambda: (frame := session.newest()).sequence > first.sequence and frame)
    for frame in (first, second):
        assert frame.generation == 1 and np.array_equal(frame.combined, np.ones((8, 8, 4)))
    wait_until(lambda: process.state is ProcessState.RUNNING)
    assert process.restarts == 1 and "SIGKILL" in process.error


def test_old_and_unknown_frames_are_not_shown(start):
    process = start("sends_old_frames")
    session = open_viewport(process, generation=5)
    wait_until(lambda: session.status.settled)
    frame = session.newest()
    assert (frame.generation, frame.sequence) == (5, 1) and (frame.combined == 1.0).all()
    assert process.state is ProcessState.RUNNING


@pytest.mark.parametrize(
    "fault", ["floods", "hangs_in_the_greeting", "hangs_and_stops_reading", "sends_old_frames", "dies_with_each_scene"]
)
def test_calls_return_at_once(start, fault):
    """Among them scenes of 8 MB that nobody reads."""
    process = start(fault)
    pixels = np.zeros((1024, 512, 4), np.float32)
    calls = []

    def timed(function, *arguments):
        began = time.perf_counter()
        result = function(*arguments)
        calls.append((time.perf_counter() - began, function))
        return result

    session = timed(process.open, SessionKind.VIEWPORT)
    ends = time.monotonic() + 1.5
    generation = 0
    while time.monotonic() < ends:
        generation += 1
        timed(session.show, scene_of(images=[Image("Large", pixels.copy())]), generation, True)
        timed(session.pause, generation % 2 == 0)
        timed(session.newest)
        timed(lambda: (session.status, process.state, process.error))
        time.sleep(0.01)
    timed(process.open(SessionKind.VIEWPORT).close)
    seconds = [call[0] for call in calls]
    assert max(seconds) < LONGEST_CALL, max(calls, key=lambda call: call[0])
    assert statistics.median(seconds) < USUAL_CALL


def test_close_ends_who_does_not_leave(start):
    process = start("ignores_the_end", leave=0.2)
    open_viewport(process)
    wait_until(lambda: process.state is ProcessState.RUNNING)
    (child,) = children()
    began = time.monotonic()
    process.close()
    assert time.monotonic() - began < 4.0
    assert child not in children() and process.state is ProcessState.STOPPED


def test_close_while_the_process_starts(start):
    process = start("hangs_in_the_greeting", leave=0.2)
    open_viewport(process)
    process.close()
    assert process.state is ProcessState.STOPPED and not children()
    open_viewport(process)
    assert process.state is ProcessState.STARTING


def test_close_of_a_process_that_has_failed(start):
    process = start("import_error")
    open_viewport(process)
    failed(process)
    process.close()
    assert process.state is ProcessState.STOPPED and not process.error


def test_a_render_can_be_stopped_though_the_process_hangs(start, monkeypatch):
    monkeypatch.setattr(remote_rendering, "STOP_SECONDS", 0.3)
    for fault in ("hangs_in_the_greeting", "hangs_and_stops_reading"):
        asked = []

        class Job(RenderJob):
            def should_stop(self, asked=asked):
                asked.append(True)
                return len(asked) > 20

        result = remote_rendering.render(start(fault), scene_of(), Job(), SessionKind.FINAL)
        assert result.stopped and not result.frame.combined.any()


def test_without_shared_memory_the_scene_is_not_sent(start, monkeypatch):
    """Blender goes on and says why; the process, which is not to blame, stays."""

    def nothing_left(size):
        raise OSError(errno.ENOMEM, "Cannot allocate memory")

    monkeypatch.setattr(arrays.SharedBlock, "create", nothing_left)
    process = start("hangs_and_stops_reading")
    session = process.open(SessionKind.VIEWPORT)
    scene = scene_of()
    scene.images.append(Image("Large", np.zeros((256, 64, 4), np.float32)))
    session.show(scene, 1, False)
    wait_until(lambda: session.status.error)
    assert "could not be sent" in session.status.error and "not enough shared memory" in session.status.error
    assert process.state is ProcessState.RUNNING and process.restarts == 0


@pytest.mark.parametrize(
    ("sent", "names", "text"),
    [
        ([], [], "cannot be read"), ([np.zeros((4, 4, 4), np.float32)], ["Depth"], "cannot be read"),
        ([np.zeros((4, 5, 4), np.float32)], [], "came as"), ([np.zeros((4, 4, 3), np.float32)], [], "the shape"),
        ([np.zeros((4, 4, 4))], [], "came as float64"), ([np.zeros(64, np.float32)], [], "came as"),
        ([np.zeros((4, 4, 4), np.float32), np.zeros((2, 2), np.float32)], ["Depth"], "came as"),
    ],
)  # fmt: skip
def test_pictures_that_do_not_fit_are_refused(sent, names, text):
    scene = scene_of()
    scene.camera.width = scene.camera.height = 4
    with pytest.raises(ProtocolError, match=text):
        remote_rendering.received_frame({"arrays": sent, "passes": names}, scene)


def test_a_process_that_lacks_memory_says_so(start):
    error = remote_rendering.render_error(start(), "MemoryError", "")
    assert isinstance(error, RendererError) and str(error).startswith("there is not enough memory; lower")

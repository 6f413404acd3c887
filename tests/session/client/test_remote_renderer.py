# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders that follow each other in one session of the renderer's process."""

import dataclasses
import os
import signal

import numpy as np
import pytest
from session.conftest import children, open_blocks, rendered, scene_of, wait_until, with_settings
from support.sent_members import watch_sent_members

from rppm_addon.scene.errors import SettingsError
from rppm_addon.session.client.client import ProcessState
from rppm_addon.session.client.remote_rendering import RemoteRenderer
from rppm_addon.session.render.render_job import RenderJob
from rppm_addon.session.transport.sessions import SessionKind


class Job(RenderJob):
    def __init__(self, stop_at=None, checkpoint=None):
        self.stop_at, self.iterations, self.checkpoint = stop_at, [], checkpoint

    def should_stop(self):
        return self.stop_at is not None and self.stop_at in self.iterations

    def on_progress(self, progress):
        self.iterations.append(progress.iteration)
        return True


def moved(scene, x):
    """The scene from elsewhere; it shares the rest."""
    matrix = scene.camera.matrix.copy()
    matrix[0, 3] += x
    return dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, matrix=matrix), warnings=[])


@pytest.fixture
def remote(process):
    return RemoteRenderer(process, SessionKind.FINAL)


@pytest.fixture(scope="module")
def scene():
    return scene_of(3)


@pytest.fixture(scope="module")
def pictures(scene):
    """By where they are taken from, each by a renderer that knows of no other."""
    found = {x: rendered(moved(scene, x)).combined for x in (0.0, 0.3, 0.6)}
    assert not np.array_equal(found[0.0], found[0.3])
    return found


def shows(remote, scene, x, pictures):
    job = Job()
    result = remote.render(moved(scene, x), job)
    assert job.iterations == [0, 1, 2, 3] and not result.stopped
    np.testing.assert_array_equal(result.frame.combined, pictures[x])


def test_only_what_is_new_is_sent(remote, scene, pictures, monkeypatch):
    sent = watch_sent_members(monkeypatch)
    for x in (0.0, 0.3, 0.6):
        shows(remote, scene, x, pictures)
    assert len({session for session, _ in sent}) == 1
    first, *others = sent.values()
    assert "meshes" in first and others == [{"camera"}, {"camera"}]
    assert len(remote.process.sessions) == 1
    remote.forget()
    assert not remote.process.sessions
    shows(remote, scene, 0.3, pictures)
    assert "meshes" in list(sent.values())[-1]


def test_who_is_stopped_does_not_stop_the_next(remote, scene, pictures):
    endless = with_settings(scene, iterations=100000)
    result = remote.render(endless, Job(stop_at=2))
    assert result.stopped and 2 <= result.statistics.iterations < 100000
    shows(remote, scene, 0.3, pictures)
    # Too late: the render that is to stop has ended.
    (session,) = remote.process.sessions.values()
    session.request_picture()
    session.stop()
    shows(remote, scene, 0.6, pictures)
    # Before there was anything to see, nobody waits for the process.
    assert remote.render(endless, Job(stop_at=0)).stopped
    shows(remote, scene, 0.0, pictures)


def test_a_render_goes_on_where_it_was_stopped(remote, scene, tmp_path):
    """Once it is complete it is there at once, and of another scene it begins anew, its file being set aside."""
    path = tmp_path / "kept.exr"
    longer = with_settings(scene, iterations=64)
    whole = rendered(longer).combined
    first = remote.render(longer, Job(stop_at=2, checkpoint=path))
    assert first.stopped and path.is_file() and 2 <= first.statistics.iterations < 64
    job = Job(checkpoint=path)
    second = remote.render(longer, job)
    assert job.iterations == list(range(first.statistics.iterations, 65)) and not second.stopped
    np.testing.assert_array_equal(second.frame.combined, whole)
    job = Job(checkpoint=path)
    third = remote.render(longer, job)
    assert job.iterations == [64]
    np.testing.assert_array_equal(third.frame.combined, whole)
    job = Job(checkpoint=path)
    other = remote.render(moved(longer, 0.3), job)
    assert job.iterations == list(range(65)) and (tmp_path / "kept_before.exr").is_file()
    assert any("begins anew" in text and "other camera" in text for text in other.statistics.warnings)
    kept = (tmp_path / "kept_before.exr").read_bytes()
    remote.render(longer, Job(checkpoint=path))
    assert (tmp_path / "kept_before2.exr").is_file() and (tmp_path / "kept_before.exr").read_bytes() == kept
    job = Job()
    remote.render(longer, job)
    assert job.iterations == list(range(65))  # without a checkpoint nothing is gone on with


def test_an_error_ends_one_render(remote, scene, pictures):
    shows(remote, scene, 0.0, pictures)
    with pytest.raises(SettingsError, match="alpha"):
        remote.render(with_settings(scene, alpha=2.0), Job())
    assert not remote.process.sessions
    shows(remote, scene, 0.3, pictures)


def test_a_process_that_dies_between_renders(remote, scene, pictures):
    """Another one takes over and does not begin again with what is done."""
    shows(remote, scene, 0.0, pictures)
    (child,) = children()
    os.kill(child, signal.SIGKILL)
    wait_until(lambda: remote.process.restarts == 1 and remote.process.state is ProcessState.RUNNING)
    shows(remote, scene, 0.3, pictures)
    # And where nothing has been noticed yet.
    (child,) = children()
    os.kill(child, signal.SIGKILL)
    shows(remote, scene, 0.6, pictures)


def test_a_closed_process_is_started_again(remote, scene, pictures):
    shows(remote, scene, 0.0, pictures)
    remote.process.close()
    shows(remote, scene, 0.3, pictures)


def test_shared_memory_is_given_back(remote, scene, pictures):
    for _ in range(3):
        shows(remote, scene, 0.3, pictures)
    (child,) = children()
    before = open_blocks(), open_blocks(child)
    for x in (0.0, 0.3, 0.6) * 5:
        shows(remote, scene, x, pictures)
    assert open_blocks() <= before[0] and open_blocks(child) <= before[1]

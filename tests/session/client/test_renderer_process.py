# SPDX-License-Identifier: GPL-3.0-or-later
"""The real process of the renderer: what it renders, and that it leaves nothing behind."""

import dataclasses
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from session.conftest import (
    children,
    is_running,
    open_viewport,
    rendered,
    scene_of,
    settled_picture,
    shared_files,
    wait_until,
    with_settings,
)

from rppm_addon.scene import InstanceArray, Movement, Shutter
from rppm_addon.scene.errors import RendererError, SettingsError
from rppm_addon.session.client.client import ProcessState
from rppm_addon.session.client.remote_rendering import RemoteRenderer, render
from rppm_addon.session.render.render_job import RenderJob
from rppm_addon.session.transport.sessions import SessionKind

ROOT = Path(__file__).resolve().parents[3]


def child_of(process):
    """The id of the process's process once it runs."""
    wait_until(lambda: process.state is ProcessState.RUNNING)
    (child,) = children()
    return child


def next_frame(session):
    """A frame that was not there yet."""
    before = session.newest().sequence
    return wait_until(lambda: (frame := session.newest()).sequence > before and frame)


def frame_of(session, generation):
    return wait_until(lambda: (frame := session.newest()) and frame.generation == generation and frame)


def test_programs_are_prepared_by_a_session_that_ends_by_itself(process):
    scene = scene_of(3)
    process.prepare(dataclasses.replace(scene, meshes=[], instances=[], lights=[]))
    assert len(process.sessions) == 1
    wait_until(lambda: not process.sessions)
    assert process.state is ProcessState.RUNNING
    assert np.array_equal(settled_picture(open_viewport(process, scene)), rendered(scene).combined)


def test_a_viewport_settles_on_the_picture_of_a_render(process):
    scene = scene_of(3)
    session = open_viewport(process, scene)
    assert np.array_equal(settled_picture(session), rendered(scene).combined)
    status = session.status
    assert (status.generation, status.iteration, status.progress.iterations, status.error) == (1, 3, 3, "")
    assert status.progress.photons == 3 * scene.settings.photons and status.progress.memory_bytes > 0
    assert status.photon_statistics.radius_meters > 0.0
    assert process.device.name and float(process.device.version) >= 4.3
    darker = dataclasses.replace(scene, exposure=0.5)
    wider = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, width=40, height=24))
    for generation, other in enumerate((darker, wider), 2):
        session.show(other, generation, False)
        assert np.array_equal(settled_picture(session, generation), rendered(other).combined)


def test_a_render_blurs_what_moves(process):
    """And the one after it does not, though it has the same members."""
    way = np.stack([np.eye(4)] * 2)
    way[1, 0, 3] = 3.0
    scene = scene_of(3, shutter=Shutter(np.ones(2), [Movement(0, np.array([0.0, 1.0]), way)]))
    still = dataclasses.replace(scene, shutter=None)
    pictures = [render(process, shown, RenderJob(), SessionKind.FINAL).frame.combined for shown in (scene, still)]
    for picture, shown in zip(pictures, (scene, still), strict=True):
        assert np.array_equal(picture, rendered(shown).combined)
    assert not np.array_equal(*pictures)


def test_of_many_scenes_the_last_is_shown(process):
    session = process.open(SessionKind.VIEWPORT)
    shown = set()
    for generation in range(1, 300):
        session.show(scene_of(2, exposure=generation), generation, True)
        time.sleep(0.002)
        if (frame := session.newest()) is not None:
            shown.add(frame.generation)
    assert np.array_equal(settled_picture(session, 299), rendered(scene_of(2, exposure=299)).combined)
    assert len(shown) < 299


def test_pause(process):
    session = open_viewport(process, scene_of(100000))
    frame_of(session, 1)
    session.pause(True)
    wait_until(
        lambda: (before := session.newest().sequence) and (time.sleep(0.5), session.newest().sequence == before)[1]
    )
    session.pause(False)
    next_frame(session)


def test_a_bad_scene_does_not_end_the_process(process):
    session = open_viewport(process, with_settings(scene_of(), alpha=2.0))
    wait_until(lambda: session.status.error)
    assert session.status.error.startswith("alpha is 2.0; set it to") and session.status.settled
    session.show(scene_of(images=[object()]), 2, False)
    wait_until(lambda: "could not be sent" in session.status.error)
    session.show(scene_of(), 3, False)
    frame_of(session, 3)
    assert process.state is ProcessState.RUNNING and process.restarts == 0
    wait_until(lambda: not session.status.error)


def test_a_killed_process_is_started_anew_and_shows_the_scene_again(process):
    session = open_viewport(process, scene_of(100000), generation=7)
    for restarts in (1, 2):
        frame_of(session, 7)
        child = child_of(process)
        os.kill(child, signal.SIGKILL)
        wait_until(lambda: process.device is None)
        wait_until(lambda: process.state is ProcessState.RUNNING)
        assert process.restarts == restarts
        assert next_frame(session).generation == 7
        assert not is_running(child)
    assert "SIGKILL" in process.error
    os.kill(child_of(process), signal.SIGKILL)
    wait_until(lambda: process.state is ProcessState.FAILED)
    process.restart()
    next_frame(session)
    assert process.state is ProcessState.RUNNING and not process.error


def test_restart_of_a_process_that_runs(process):
    session = open_viewport(process, scene_of(100000))
    frame_of(session, 1)
    child = child_of(process)
    process.restart()
    wait_until(lambda: process.state is ProcessState.RUNNING)
    next_frame(session)
    assert process.restarts == 0 and not is_running(child) and child_of(process) != child
    with process.changed:
        process.is_listing = True
        process.post("list_devices")
    wait_until(lambda: not process.is_listing)
    assert process.device.devices[process.device.number].driver


_PARENT = """
import json, sys, time
from pathlib import Path
sys.path[:0] = [{root!r}, {tests!r}]
from rppm_addon.session.client.client import RendererProcess
from session.conftest import children, open_viewport, scene_of, wait_until
process = RendererProcess([sys.executable, "-I"], sys.path, Path(sys.argv[1]))
session = open_viewport(process, scene_of(100000, size=64))
wait_until(session.newest)
print(json.dumps(sorted(children())), flush=True)
{then}
"""


def start_parent(tmp_path, then):
    """A process with a renderer process of its own, which does ``then`` once there is a picture; and both ids."""
    code = _PARENT.format(root=str(ROOT), tests=str(ROOT / "tests"), then=then)
    parent = subprocess.Popen([sys.executable, "-c", code, str(tmp_path / "log")], stdout=subprocess.PIPE)
    (child,) = json.loads(parent.stdout.readline())
    return parent, child


@pytest.mark.parametrize(
    "then",
    [
        "time.sleep(1000)",
        "for generation in range(2, 10**6): session.show(scene_of(size=200 + generation % 50), generation, True)",
    ],
)
def test_when_blender_is_killed_the_process_leaves(tmp_path, then):
    """While it shows one scene, and while scenes and sizes change all the time."""
    parent, child = start_parent(tmp_path, then)
    with parent:
        time.sleep(0.5)
        assert is_running(child)
        parent.kill()
        killed = time.monotonic()
    wait_until(lambda: not is_running(child), seconds=10.0)
    assert time.monotonic() - killed < 2.0
    assert not shared_files()


@pytest.mark.parametrize("then", ["", "process.close()", "sys.exit(1)", "1 / 0"])
def test_when_python_ends_the_process_leaves(tmp_path, then):
    parent, child = start_parent(tmp_path, then)
    with parent:
        parent.communicate(timeout=30)
        ended = time.monotonic()
    wait_until(lambda: not is_running(child), seconds=10.0)
    assert time.monotonic() - ended < 2.0
    assert not shared_files()


class Job(RenderJob):
    def __init__(self, stop_at=None, snapshots=()):
        self.stop_at, self.snapshots, self.events, self.frames = stop_at, snapshots, [], []

    def should_stop(self):
        return self.stop_at is not None and (self.stop_at == 0 or ("progress", self.stop_at) in self.events)

    def on_start(self):
        self.events.append("start")

    def on_progress(self, progress):
        self.events.append(("progress", progress.iteration))
        return progress.iteration == 1

    def on_frame(self, progress, frame):
        self.events.append(("frame", frame.combined.shape))
        self.frames.append((progress.iteration, frame))

    def on_snapshot(self, seconds, frame):
        self.events.append(("snapshot", seconds))


@pytest.mark.parametrize("passes", [(), ("Depth", "Normal", "Deep Cubemap")])
def test_a_render_in_the_process_is_the_same_picture(process, passes):
    scene = scene_of(4, size=48)
    scene.settings.passes = passes
    job = Job(snapshots=(0.0, 0.001))
    result = render(process, scene, job, SessionKind.FINAL)
    frame = rendered(scene)
    np.testing.assert_array_equal(result.frame.combined, frame.combined)
    assert set(result.frame.passes) == set(frame.passes) == set(passes)
    for name in passes:
        np.testing.assert_array_equal(result.frame.passes[name], frame.passes[name])
    assert not result.stopped and result.statistics.iterations == 4
    assert result.statistics.flux_watts["emitted"] > 0.0
    assert job.events[0] == "start" and [event[1] for event in job.events if event[0] == "progress"] == [0, 1, 2, 3, 4]
    assert [event for event in job.events if event[0] == "snapshot"] == [("snapshot", 0.0), ("snapshot", 0.001)]


@pytest.mark.long
def test_instances_in_arrays_are_the_same_picture_as_one_by_one(process):
    """The renderer's process and a renderer in this one."""
    scene = scene_of(2, size=48)
    count, (floor,) = 40, scene.instances
    matrices = np.tile(np.float32(0.1 * floor.matrix[:3]), (count, 1, 1))
    matrices[:, :, 3] = np.random.default_rng(1).uniform(-1.0, 1.0, (count, 3))
    many = InstanceArray(floor, np.arange(1, count + 1, dtype=np.int32), matrices, np.linspace(0.0, 1.0, count))
    scene.instance_arrays = [many]
    expected = rendered(scene.expanded()).combined
    assert not np.array_equal(expected, rendered(dataclasses.replace(scene, instance_arrays=[])).combined)
    np.testing.assert_array_equal(rendered(scene).combined, expected)
    result = render(process, scene, Job(), SessionKind.FINAL)
    np.testing.assert_array_equal(result.frame.combined, expected)


def test_pictures_that_are_asked_for_come_meanwhile(process):
    job = Job()
    job.should_stop = lambda: ("frame", (48, 48, 4)) in job.events
    assert render(process, scene_of(size=48), job, SessionKind.PREVIEW).stopped
    assert all(iteration > 0 for iteration, _ in job.frames)


def test_a_first_look_comes_before_the_first_picture(process):
    remote = RemoteRenderer(process, SessionKind.FINAL)
    jobs = [Job(), Job()]
    for job in jobs:
        remote.render(scene_of(2, size=48), job)
    first, second = ([iteration for iteration, _ in job.frames] for job in jobs)
    assert first.index(0) == 0 and first.count(0) == 1
    assert 0 not in second  # the second frame of an animation compiles nothing
    look = jobs[0].frames[0][1]
    assert look.combined.shape == (48, 48, 4) and np.isfinite(look.combined).all() and not look.passes
    assert look.combined[..., :3].std() > 0.02  # surfaces differ


def test_stopped_renders(process):
    result = render(process, scene_of(), Job(stop_at=0), SessionKind.FINAL)
    assert result.stopped and result.statistics.iterations == 0 and not result.frame.combined.any()
    result = render(process, scene_of(), Job(stop_at=3), SessionKind.FINAL)
    assert result.stopped and 3 <= result.statistics.iterations < 1000 and result.frame.combined[..., :3].mean() > 0.0
    assert not process.sessions


def test_a_render_is_stopped_amid_an_iteration(process):
    scene = with_settings(scene_of(size=256), photons=1 << 17)
    job = Job()
    job.should_stop = lambda: ("progress", 0) in job.events
    result = render(process, scene, job, SessionKind.FINAL)
    assert result.stopped and result.statistics.iterations == 0 and ("progress", 1) not in job.events


def test_errors_of_renders(process):
    with pytest.raises(SettingsError, match="alpha"):
        render(process, with_settings(scene_of(), alpha=2.0), Job(), SessionKind.PREVIEW)
    job = Job()
    job.on_progress = lambda progress: 1 / 0
    with pytest.raises(ZeroDivisionError):
        render(process, scene_of(), job, SessionKind.FINAL)
    assert not process.sessions and process.restarts == 0
    assert not render(process, scene_of(1), Job(), SessionKind.FINAL).stopped


def test_a_render_survives_a_death_but_not_three(process):
    for deaths, iterations in ((1, 30), (2, 10**6)):
        killed = []

        class Killer(Job):
            def on_progress(self, progress, killed=killed, deaths=deaths):
                if progress.iteration == 1 and len(killed) < deaths:
                    killed.append(child_of(process))
                    os.kill(killed[-1], signal.SIGKILL)
                return False

        if deaths == 1:
            assert render(process, scene_of(iterations), Killer(), SessionKind.FINAL).statistics.iterations == 30
        else:
            with pytest.raises(RendererError, match="SIGKILL"):
                render(process, scene_of(iterations), Killer(), SessionKind.FINAL)


def test_close_ends_a_render(process):
    job = Job()
    job.on_progress = lambda progress: process.close()
    with pytest.raises(RendererError, match="closed"):
        render(process, scene_of(), job, SessionKind.FINAL)


def test_a_viewport_goes_on_beside_a_render(process):
    """How much each gets is a matter of the clock, which test_fair_share.py has in hand."""
    scene = scene_of(10**6)
    session = open_viewport(process, scene)
    wait_until(lambda: (frame := session.newest()) and frame.width == 16)
    counts = []

    class Watch(Job):
        def on_progress(self, progress):
            if progress.iteration >= 5:
                counts.append(session.status.iteration)
            return super().on_progress(progress)

        def should_stop(self):
            return bool(counts) and (counts[-1] - counts[0] >= 5 or len(counts) > 20000)

    render(process, dataclasses.replace(scene), Watch(), SessionKind.FINAL)
    assert counts[-1] - counts[0] >= 5


def test_messages_for_a_session_that_was_closed(process):
    """Whoever draws may not know of it yet, and pictures are still on their way."""
    for _ in range(10):
        viewport, final = open_viewport(process), process.open(SessionKind.FINAL)
        final.show(scene_of(size=200), 1, False)
        final.request_picture()
        wait_until(viewport.newest)
        viewport.close()
        final.close()
        viewport.show(scene_of(), 2, False)
        viewport.pause(True)
        viewport.close()
        final.stop()
        with process.changed:
            process.post("received", session=final.number)
    session = open_viewport(process)
    frame_of(session, 1)
    assert process.restarts == 0
    assert list(process.sessions.values()) == [session]


def test_a_log_that_cannot_be_written(process):
    process.launcher.log_path = Path("/proc/renderer/renderer.log")
    frame_of(open_viewport(process), 1)

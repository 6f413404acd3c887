# SPDX-License-Identifier: GPL-3.0-or-later
"""One renderer in one thread, whoever asks, and callbacks in the thread that asked."""

import threading

import pytest
from blender_scenes import CAMERA

from rppm_addon.blender.render_client.renderer_thread import RendererThread, RenderJob
from rppm_addon.scene import Scene
from rppm_addon.session.render import renderer as session_renderer
from rppm_addon.session.render.results import Progress


class FakeRenderer:
    made = []

    def __init__(self, device=None, denoiser=None, times_stages=False):
        self.threads = [threading.current_thread()]
        self.released = False
        FakeRenderer.made.append(self)

    def render(self, scene, on_progress, should_stop, snapshots, on_snapshot, continuation):
        self.threads.append(threading.current_thread())
        self.continuation = continuation
        for iteration in range(1000):
            on_progress(Progress(iteration, 1000, 0.0, 0), lambda count=iteration: f"frame {count}")
            if should_stop():
                break
        for seconds in snapshots:
            on_snapshot(seconds, "snapshot")
        return iteration

    def release(self):
        self.threads.append(threading.current_thread())
        self.released = True


@pytest.fixture
def renderers(monkeypatch):
    monkeypatch.setattr(session_renderer, "Renderer", FakeRenderer)
    FakeRenderer.made = []
    owner = RendererThread()
    yield owner
    owner.release()


SCENE = Scene(CAMERA)


class Job(RenderJob):
    snapshots = (1.0, 2.0)

    def __init__(self, last=3):
        self.last, self.threads, self.told = last, set(), []
        self.continuation = object()

    def should_stop(self):
        self.threads.add(threading.current_thread())
        return bool(self.told) and self.told[-1] == self.last

    def on_progress(self, progress):
        self.threads.add(threading.current_thread())
        self.told.append(progress.iteration)
        return progress.iteration == 1

    def on_frame(self, progress, frame):
        self.threads.add(threading.current_thread())
        self.told.append(frame)

    def on_snapshot(self, seconds, frame):
        self.told.append((seconds, frame))


def test_callers_of_all_threads_share_one_renderer(renderers):
    jobs, results = [Job(), Job()], []
    for job in jobs:
        caller = threading.Thread(target=lambda job=job: results.append(renderers.render(SCENE, job)))
        caller.start()
        caller.join(timeout=30)
        assert job.threads == {caller}
        assert job.told == [0, 1, "frame 1", 2, 3, (1.0, "snapshot"), (2.0, "snapshot")]
    assert results == [3, 3]
    (renderer,) = FakeRenderer.made
    assert renderer.continuation is jobs[1].continuation
    renderers.release()
    assert renderer.released and len(set(renderer.threads)) == 1
    assert renderer.threads[0] is not threading.main_thread() and not renderer.threads[0].is_alive()


def test_release_and_render_again(renderers):
    for _ in range(2):
        assert renderers.render(SCENE, Job()) == 3
        renderers.release()
        renderers.release()
    assert len(FakeRenderer.made) == 2 and all(renderer.released for renderer in FakeRenderer.made)


@pytest.mark.parametrize("name", ["on_start", "on_progress", "on_frame", "on_snapshot", "should_stop"])
def test_what_a_callback_raises_ends_the_render(renderers, name):
    job = Job()

    def fail(*_):
        raise ZeroDivisionError(name)

    setattr(job, name, fail)
    with pytest.raises(ZeroDivisionError, match=name):
        renderers.render(SCENE, job)
    assert FakeRenderer.made[0].released
    assert renderers.render(SCENE, Job()) == 3


def test_an_error_between_iterations_ends_the_render(renderers, monkeypatch):
    """The caller polls while the renderer works: what that raises must not leave the renderer behind."""
    asked = threading.Event()

    def slow(self, scene, on_progress, should_stop, snapshots, on_snapshot):
        while not should_stop():
            asked.wait(0.01)

    monkeypatch.setattr(FakeRenderer, "render", slow)
    job = Job()
    job.should_stop = lambda: asked.set() or 1 / 0
    with pytest.raises(ZeroDivisionError):
        renderers.render(SCENE, job)
    monkeypatch.undo()
    monkeypatch.setattr(session_renderer, "Renderer", FakeRenderer)
    assert renderers.render(SCENE, Job()) == 3


def test_what_the_renderer_raises_reaches_the_caller(renderers, monkeypatch):
    monkeypatch.setattr(FakeRenderer, "__init__", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        renderers.render(SCENE, Job())

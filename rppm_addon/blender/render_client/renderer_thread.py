# SPDX-License-Identifier: GPL-3.0-or-later
"""The one Renderer of this Blender, in a thread of its own.

A GL context belongs to the thread that made it, and Blender renders from ever new threads (F12)
or from its main thread, where a context of ours would collide with Blender's. So the renderer
lives in one thread that outlasts renders and keeps its compiled programs; whoever renders waits
for it and runs the callbacks, which may then talk to Blender.
"""

import atexit
import contextlib
import contextvars
import logging
import queue
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ...denoising.denoiser import Denoiser
from ...scene import Scene
from ...session.render.observers import RenderObserver, current_observer
from ...session.render.render_job import POLL_SECONDS, RenderJob
from .chosen_device import chosen_device
from .denoising_libraries import denoising_libraries

if TYPE_CHECKING:
    from ...session.render.results import Frame, Progress, RenderResult

logger = logging.getLogger(__name__)


class _Conversation:
    """How the renderer's thread has its caller run a function and waits for what it returns."""

    def __init__(self, scene: Scene, job: RenderJob) -> None:
        self.scene = scene
        self.libraries = denoising_libraries()
        self.device = chosen_device() or None
        self.times_stages = type(current_observer()) is not RenderObserver  # the program's reports have them
        self.job = job
        self.stop = threading.Event()
        self._questions: queue.SimpleQueue = queue.SimpleQueue()
        self._answers: queue.SimpleQueue = queue.SimpleQueue()

    # In the renderer's thread.

    def ask(self, function: Callable, *arguments: object) -> Any:
        """Run a function in the caller's thread; its exceptions are raised here."""
        self._questions.put((function, arguments))
        answer, error = self._answers.get()
        if error is not None:
            raise error
        return answer

    def finish(self, result: "RenderResult | None", error: BaseException | None) -> None:
        self._questions.put((None, (result, error)))

    # In the caller's thread.

    def attend(self) -> "RenderResult":
        """Serve the renderer until it is done; raises what it or a callback raised.

        After an error the renderer is still awaited: it must not be left waiting for an answer.
        """
        failure: BaseException | None = None
        while True:
            question = answer = None
            try:
                with contextlib.suppress(queue.Empty):
                    question = self._questions.get(timeout=POLL_SECONDS)
                if question is not None and question[0] is not None and failure is None:
                    function, arguments = question
                    answer = function(*arguments)
                if failure is None:
                    self._poll()
            except BaseException as raised:  # Ctrl-C as well
                failure = failure or raised
                self.stop.set()
            if question is None:
                continue
            if question[0] is None:
                result, error = question[1]
                if failure is not None or error is not None:
                    raise failure or error
                return result
            self._answers.put((answer, failure))

    def _poll(self) -> None:
        if not self.stop.is_set() and self.job.should_stop():
            self.stop.set()


_FORGET = object()
"""In place of a job."""


class RendererThread:
    """Owns the thread and, in it, the Renderer; one render at a time."""

    def __init__(self) -> None:
        self._jobs: queue.SimpleQueue = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()

    def render(self, scene: Scene, job: RenderJob) -> "RenderResult":
        """Render a scene; returns or raises what Renderer.render does."""
        with self._lock:
            if self._thread is None or not self._thread.is_alive():
                # A daemon: a Blender that ends without unregistering must not wait for it.
                self._thread = threading.Thread(target=self._run, name="RPPM renderer", daemon=True)
                self._thread.start()
            conversation = _Conversation(scene, job)
            self._jobs.put((conversation, contextvars.copy_context()))
            return conversation.attend()

    def forget(self) -> None:
        """Give back what the device holds of the last scene, once no render is under way."""
        if self._thread is not None and self._thread.is_alive():
            self._jobs.put(_FORGET)

    def release(self) -> None:
        """Release the renderer and end the thread; a later render starts anew."""
        with self._lock:
            if self._thread is not None and self._thread.is_alive():
                self._jobs.put(None)
                self._thread.join(timeout=30.0)
            self._thread = None

    def _run(self) -> None:
        renderer = None
        while (job := self._jobs.get()) is not None:
            if job is _FORGET:
                if renderer is not None:
                    renderer.forget()
                continue
            conversation, context = job
            result = error = None
            try:
                if renderer is None:
                    from ...session.render.renderer import Renderer

                    denoiser = Denoiser(conversation.libraries)
                    renderer = Renderer(conversation.device, denoiser, conversation.times_stages)
                result = context.run(_render, renderer, conversation)
            except BaseException as raised:
                error = raised
                # What state a failed render leaves the device in is unknown: start anew.
                if renderer is not None:
                    _release_quietly(renderer)
                    renderer = None
            conversation.finish(result, error)
        if renderer is not None:
            _release_quietly(renderer)


def _render(renderer: Any, conversation: _Conversation) -> "RenderResult":
    job = conversation.job
    conversation.ask(job.on_start)

    def on_progress(progress: "Progress", read_frame: "Callable[[], Frame]") -> None:
        if conversation.ask(job.on_progress, progress):
            conversation.ask(job.on_frame, progress, read_frame())

    return renderer.render(
        conversation.scene,
        on_progress=on_progress,
        should_stop=conversation.stop.is_set,
        snapshots=conversation.ask(lambda: job.snapshots),
        on_snapshot=lambda seconds, frame: conversation.ask(job.on_snapshot, seconds, frame),
        continuation=conversation.ask(lambda: job.continuation),
    )


def _release_quietly(renderer: Any) -> None:
    try:
        renderer.release()
    except Exception:
        logger.exception("the renderer could not be released")


_shared = RendererThread()


def render(scene: Scene, job: RenderJob) -> "RenderResult":
    """Render with the Renderer that all renders of this Blender share."""
    return _shared.render(scene, job)


def forget() -> None:
    """Give back what the device holds of the last scene."""
    _shared.forget()


def release() -> None:
    """Release the shared Renderer; the next render makes a new one."""
    _shared.release()


atexit.register(release)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders in the renderer's process for callers that wait for them."""

import queue
import threading
import time
from collections.abc import Mapping

import numpy as np

from ...scene import errors
from ...scene.scene import Scene
from ..render.render_job import POLL_SECONDS, RenderJob
from ..render.results import Frame, RenderResult, empty_result
from ..transport.protocol import ProtocolError
from ..transport.sessions import SessionKind
from .client import ProcessState, RendererProcess
from .client_session import RenderSession

STOP_SECONDS, KEEP_SECONDS = 10.0, 120.0
"""Seconds that the process may take to stop, and to write a checkpoint as well; then it ends without a picture."""


class RemoteRenderer:
    """Renders scene after scene in one session: members that they have in common are sent and uploaded once."""

    def __init__(self, process: RendererProcess, kind: SessionKind) -> None:
        self.process = process
        self._kind = kind
        self._idle: RenderSession | None = None
        self._lock = threading.Lock()

    def render(self, scene: Scene, job: RenderJob) -> RenderResult:
        """Render a scene; returns and raises what Renderer.render does, and RendererError when the process fails.

        Callbacks run in the caller's thread while the process renders. A process that dies is started anew and
        continues the scene.
        """
        with self._lock:
            session, self._idle = self._idle, None
        if session is not None and self.process.state is ProcessState.FAILED:
            session.close()  # a new one has the process started anew
        if session is None or not session.is_open:
            session = self.process.open(self._kind)
        result = None
        try:
            result = _attend(self.process, session, scene, job)
        except ProtocolError as error:
            raise errors.RendererError(
                f"the renderer process sent what cannot be understood ({error}); please report what is in its log, "
                f"{self.process.log_path}"
            ) from error
        finally:
            if result is None:
                session.close()
        if result.statistics.iterations == 0:
            session.close()  # the process may still be at it
        else:
            session.rest()
            with self._lock:
                self._idle = session
        return result

    def forget(self) -> None:
        """Have the process free the last scene. A render that is under way continues."""
        with self._lock:
            session, self._idle = self._idle, None
        if session is not None:
            session.close()


def render(process: RendererProcess, scene: Scene, job: RenderJob, kind: SessionKind) -> RenderResult:
    """Render one scene as RemoteRenderer.render does, and free it."""
    renderer = RemoteRenderer(process, kind)
    try:
        return renderer.render(scene, job)
    finally:
        renderer.forget()


def _attend(process: RendererProcess, session: RenderSession, scene: Scene, job: RenderJob) -> RenderResult:
    def begin() -> None:
        job.on_start()
        session.expect_snapshots(tuple(job.snapshots))
        session.set_checkpoint(job.checkpoint)
        session.begin(scene)

    shown = session.introduced
    stopped_at: float | None = None
    if shown:
        begin()
    while True:
        if stopped_at is None and job.should_stop():
            stopped_at = time.monotonic()
            session.stop()
        patience = STOP_SECONDS if job.checkpoint is None else KEEP_SECONDS
        if stopped_at is not None and not (shown and time.monotonic() - stopped_at < patience):
            return empty_result(scene, process.device.label if process.device else "")
        try:
            event, content = session.events.get(timeout=POLL_SECONDS)
        except queue.Empty:
            continue
        if event == "started" and not shown:
            shown = True
            begin()
        elif event == "progress":
            if job.on_progress(content["progress"]):
                session.request_picture()
        elif event == "picture":
            job.on_frame(content["progress"], received_frame(content, scene))
        elif event == "snapshot":
            job.on_snapshot(content["seconds"], received_frame(content, scene))
        elif event == "result":
            return RenderResult(received_frame(content, scene), content["statistics"], content["stopped"])
        elif event == "failed":
            raise render_error(process, content["error"], content["text"])


def received_frame(content: Mapping, scene: Scene) -> Frame:
    """Return the frame that a message brings. Raises ProtocolError unless arrays, names and the scene fit."""
    width, height = scene.camera.resolution
    try:
        combined, *passes = content["arrays"]
        frame = Frame(combined, dict(zip(content["passes"], passes, strict=True)))
    except (ValueError, TypeError) as error:
        raise ProtocolError(f"a frame cannot be read ({error})") from error
    for array in content["arrays"]:
        if array.dtype != np.float32 or array.shape[:2] != (height, width) or array.ndim not in (2, 3):
            raise ProtocolError(f"a picture of {width} x {height} pixels came as {array.dtype} {array.shape}")
    if combined.shape[2:] != (4,):
        raise ProtocolError(f"a picture came with the shape {combined.shape}")
    return frame


def render_error(process: RendererProcess, name: str, text: str) -> errors.RppmError:
    """Return the error of a render that failed in the process with an error of this name and text."""
    kind = getattr(errors, name, None)
    if kind is not None:
        return kind(text)
    if name == MemoryError.__name__:
        return errors.RendererError(errors.NO_MEMORY)
    return errors.RendererError(
        f"RPPM failed unexpectedly ({name}: {text}); please report what is in its log, {process.log_path}"
    )

# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders in the renderer's process, for a caller that waits for them."""

import queue

from ..scene import errors
from ..scene.scene import Scene
from .client import RendererProcess
from .client_session import RenderSession
from .render_job import POLL_SECONDS, RenderJob
from .results import Frame, Progress, RenderResult, RenderStatistics, empty_result
from .sessions import SessionKind


def render(process: RendererProcess, scene: Scene, job: RenderJob, kind: SessionKind) -> RenderResult:
    """Render a scene; returns and raises what Renderer.render does, and RendererError when the process fails.

    Callbacks run in the caller's thread, while the process goes on. A process that dies is started anew and begins
    again with the scene.
    """
    session = process.open(kind)
    try:
        return _attend(process, session, scene, job)
    finally:
        session.close()


def _attend(process: RendererProcess, session: RenderSession, scene: Scene, job: RenderJob) -> RenderResult:
    shown = False
    while True:
        stopping = job.should_stop()
        if stopping and not shown:
            return empty_result(scene, process.device.name if process.device else "")
        if stopping:
            session.stop()
        try:
            event, content = session.events.get(timeout=POLL_SECONDS)
        except queue.Empty:
            continue
        if event == "started" and not shown:
            shown = True
            job.on_start()
            session.expect_snapshots(tuple(job.snapshots))
            session.show(scene, 1, False)
        elif event == "progress":
            if job.on_progress(Progress(**content["progress"])):
                session.want_picture()
        elif event == "picture":
            job.on_frame(Progress(**content["progress"]), Frame(*content["arrays"]))
        elif event == "snapshot":
            job.on_snapshot(content["seconds"], Frame(*content["arrays"]))
        elif event == "result":
            return RenderResult(
                Frame(*content["arrays"]), RenderStatistics(**content["statistics"]), content["stopped"]
            )
        elif event == "failed":
            raise _error(process, content["error"], content["text"])


def _error(process: RendererProcess, name: str, text: str) -> errors.RppmError:
    kind = getattr(errors, name, None)
    if kind is not None:
        return kind(text)
    return errors.RendererError(
        f"RPPM failed unexpectedly ({name}: {text}); please report what is in its log, {process.log_path}"
    )

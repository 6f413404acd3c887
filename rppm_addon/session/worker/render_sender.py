# SPDX-License-Identifier: GPL-3.0-or-later
"""The messages that a render's session sends to Blender."""

import collections
import dataclasses
import logging

from ..checkpoints.continuation import Pause
from ..render.results import Frame, Progress, RenderResult
from ..transport.arrays import pack
from ..transport.kept_renders import described
from ..transport.messages import Send
from ..transport.shared_memory import SharedBlock

log = logging.getLogger(__name__)


class RenderSender:
    """Sends progress, pictures and state of renders; arrays are in shared memory until Blender has copied them."""

    def __init__(self, send: Send) -> None:
        self._send = send
        self._blocks: collections.deque[SharedBlock] = collections.deque()
        """Blocks of shared memory that Blender has not copied yet, the oldest first."""

    def send_progress(self, progress: Progress) -> None:
        """Send the progress of the render."""
        self._send("progress", progress=dataclasses.asdict(progress))

    def send_picture(self, frame: Frame, progress: Progress) -> None:
        """Send a picture of a render that is under way."""
        self._send_frame("picture", frame, progress=dataclasses.asdict(progress))

    def send_snapshot(self, frame: Frame, seconds: float) -> None:
        """Send the picture at a time that Blender has named."""
        self._send_frame("snapshot", frame, seconds=seconds)

    def send_result(self, result: RenderResult) -> None:
        """Send the last picture and the statistics."""
        statistics = dataclasses.asdict(result.statistics)
        self._send_frame("result", result.frame, statistics=statistics, stopped=result.stopped)

    def send_state(self, pause: Pause, generation: int, seconds: float) -> None:
        """Send the state of a render after so many seconds, with which another process can continue it."""
        try:
            document, description, block = described(pause)
        except OSError as error:
            log.warning("the render is not kept for another process: %s", error)
            return
        self._keep(block)
        self._send("kept", document=document, arrays=description, generation=generation, seconds=seconds)

    def send_error(self, error: Exception) -> None:
        """Send why the render has failed."""
        self._send("failed", error=type(error).__name__, text=str(error))

    def _send_frame(self, kind: str, frame: Frame, **content: object) -> None:
        description, block = pack([frame.combined, *frame.passes.values()])
        self._keep(block)
        self._send(kind, arrays=description, passes=list(frame.passes), **content)

    def _keep(self, block: SharedBlock | None) -> None:
        if block is not None:
            self._blocks.append(block)

    def free_oldest(self) -> None:
        """Free the shared memory of the oldest message, which Blender has copied."""
        self._blocks.popleft().close()

    def release(self) -> None:
        """Free all shared memory."""
        while self._blocks:
            self.free_oldest()

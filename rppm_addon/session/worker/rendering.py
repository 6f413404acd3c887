# SPDX-License-Identifier: GPL-3.0-or-later
"""A session of the renderer's process that renders scenes to their end: F12, an animation, or a preview."""

import functools
import logging
from collections.abc import Sequence

import numpy as np

from ...denoising.denoiser import Denoiser
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...integrator.common.require import require
from ...integrator.progressive import ProgressivePhotonMapper
from ...scene.errors import DeviceLostError, RppmError
from ...scene.scene import Scene
from ..checkpoints.continuation import Pause
from ..placeholders.first_looks import FirstLooks
from ..placeholders.known_programs import KnownPrograms
from ..render.denoised_pictures import finished_frame
from ..render.render_loop import RenderLoop
from ..render.results import Frame, Progress, RenderResult
from ..transport.messages import Send
from .active_render import ActiveRender
from .render_sender import RenderSender
from .resumption import Resumption

log = logging.getLogger(__name__)


class Rendering:
    """Renders each scene that Blender sends, slice by slice, and sends its progress, pictures and result.

    Members that the next scene has in common with the last one stay on the device.
    """

    def __init__(
        self,
        context: Context,
        library: ProgramLibrary,
        denoiser: Denoiser,
        send: Send,
        programs: KnownPrograms,
        has_first_look: bool = False,
    ) -> None:
        """Open a session.

        Args:
            context: the process's device.
            library: the process's programs.
            denoiser: denoiser of results and snapshots.
            send: sends messages about this session to Blender.
            programs: programs of materials that the process has rendered with.
            has_first_look: send a first look at the session's first scene if its programs are not compiled yet.
        """
        self._context = context
        self._library = library
        self._denoiser = denoiser
        self._sender = RenderSender(send)
        self._programs = programs
        self._first_looks: FirstLooks | None = FirstLooks(context, library) if has_first_look else None
        self._snapshots: Sequence[float] = ()
        self._resumption = Resumption()
        self._mapper: ProgressivePhotonMapper | None = None
        self._scene: Scene | None = None
        """Scene that is rendered or will be; None when there is nothing to do."""
        self._render: ActiveRender | None = None
        """Render of the scene; None before its first slice."""
        self._generation = 0
        self._stopped_generation = 0
        """The newest generation that is to end."""
        self._picture_requested = False

    def expect_snapshots(self, seconds: Sequence[float]) -> None:
        """Send the picture of the next scene at these ascending times."""
        self._snapshots = seconds

    def set_checkpoint(self, path: str) -> None:
        """Continue the next scene from this checkpoint and keep its render there; "" is none."""
        self._resumption.checkpoint = path

    def resume(self, pause: Pause | None, seconds: float, reason: str) -> None:
        """Continue the next scene where an ended process has left it; None: begin anew."""
        self._resumption.hand_over(pause, seconds, reason)

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Render this scene to its end."""
        self._scene = scene
        self._generation = generation
        self._render = None
        self._picture_requested = False

    def stop(self, generation: int) -> None:
        """End the render of this generation with what there is. It may not have begun, or be over."""
        self._stopped_generation = generation

    def request_picture(self) -> None:
        """Send the picture as soon as an iteration is complete."""
        self._picture_requested = True

    def received(self) -> None:
        """Free the shared memory of the oldest message, which Blender has copied."""
        self._sender.free_oldest()

    @property
    def busy(self) -> bool:
        """Whether there is something to render."""
        return self._scene is not None

    def run_slice(self) -> None:
        """Render for a bounded time. Raises DeviceLostError, and BrokenPipeError when Blender has left."""
        self._library.pacing.share_with_window(False)
        try:
            render = self._render = self._render or self._begin(require(self._scene))
            result = render.run_slice(is_stopping=self._stopped_generation == self._generation)
            if result is not None:
                self._end(result)
            elif self._picture_requested and render.has_picture:
                self._picture_requested = False
                self._sender.send_picture(render.picture(), render.loop.progress)
        except (BrokenPipeError, DeviceLostError):
            raise
        except Exception as error:
            self._context.finish()  # raises DeviceLostError if that is the cause
            self._fail(error)

    def _begin(self, scene: Scene) -> ActiveRender:
        """Start the render of a scene; its clock runs from now on."""
        self._library.hurry(True)
        mapper = self._mapper = self._mapper or ProgressivePhotonMapper(self._context, self._library)
        writer, continuation = self._resumption.begin(scene, self._snapshots)
        continuation.safeguard = self._send_state
        loop = RenderLoop(
            self._context,
            mapper,
            scene,
            on_progress=lambda progress, _: self._sender.send_progress(progress),
            snapshots=self._snapshots,
            on_snapshot=functools.partial(self._send_snapshot, scene),
            continuation=continuation,
        )
        if self._first_looks is not None:
            if continuation.begin is None and not self._programs.cover(scene):
                self._send_first_look(scene, self._first_looks.draw(scene, mapper), loop.elapsed)
            self._first_looks.release()
            self._first_looks = None
        return ActiveRender(loop, scene, self._denoiser, writer)

    def _send_first_look(self, scene: Scene, combined: np.ndarray | None, elapsed: float) -> None:
        """Send a first look at iteration 0, before the programs of the scene are compiled, if there is one."""
        if combined is not None:
            np.nan_to_num(combined, copy=False)
            self._sender.send_picture(Frame(combined, {}), Progress(0, scene.settings.iterations, elapsed, photons=0))

    def _send_state(self, pause: Pause, seconds: float) -> None:
        self._sender.send_state(pause, self._generation, seconds)

    def _send_snapshot(self, scene: Scene, seconds: float, frame: Frame) -> None:
        finished = finished_frame(frame, scene.settings, self._denoiser, scene.warnings)
        self._sender.send_snapshot(finished, seconds)

    def _end(self, result: RenderResult) -> None:
        """Send the result. The mapper keeps the scene for the next one."""
        if result.statistics.iterations > 0:
            self._programs.add(require(self._mapper).device_scene.materials)
        self._scene = self._render = None
        self._sender.send_result(result)

    def _fail(self, error: Exception) -> None:
        """Send why the render has failed. The mapper is released, as its state is unknown."""
        if not isinstance(error, RppmError):
            log.exception("a render failed")
        self._release_mapper()
        self._sender.send_error(error)

    def _release_mapper(self) -> None:
        self._scene = self._render = None
        if self._first_looks is not None:
            self._first_looks.release()
        if self._mapper is not None:
            self._mapper.release()
            self._mapper = None

    def release(self) -> None:
        """Free what the session has on the device and in shared memory."""
        self._release_mapper()
        self._sender.release()

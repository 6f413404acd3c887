# SPDX-License-Identifier: GPL-3.0-or-later
"""A session of the renderer's process that renders scenes to their end: F12, an animation, or a preview."""

import collections
import dataclasses
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from ...denoising.denoiser import Denoiser
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...integrator.progressive import ProgressivePhotonMapper
from ...pictures import PictureError
from ...scene.errors import DeviceLostError, RppmError
from ...scene.scene import Scene
from ..checkpoints.checkpoint_writer import CheckpointWriter, continued_still
from ..checkpoints.continuation import Continuation, Pause, place_of
from ..placeholders.first_looks import FirstLooks
from ..placeholders.known_programs import KnownPrograms
from ..render.background_denoising import BackgroundFinish
from ..render.denoised_pictures import finished_frame, wanted_frame
from ..render.renderer import SlicedRender, log
from ..render.results import Frame, Progress, RenderResult
from ..transport.arrays import pack
from ..transport.kept_renders import described
from ..transport.shared_memory import SharedBlock


class Rendering:
    """Renders the scene that it is shown, slice by slice, and tells what becomes of it.

    What the next scene shares with it stays on the device.
    """

    def __init__(
        self,
        context: Context,
        library: ProgramLibrary,
        denoiser: Denoiser,
        send: Callable[..., None],
        programs: KnownPrograms,
        looks_first: bool = False,
    ) -> None:
        """programs: what all sessions of the process know to be ready; looks_first: send a first look at the session's
        first scene, where the first iteration takes much longer."""
        self._context = context
        self._library = library
        self._denoiser = denoiser
        self._send = send
        self._programs = programs
        self._looks_first = looks_first
        self._looks = FirstLooks(context, library)
        self._snapshots: Sequence[float] = ()
        self._checkpoint = ""
        self._handed_on: tuple[Pause, float, str] | None = None
        """Where the next scene goes on, the seconds that it has taken, and why the process before ended."""
        self._keeper: CheckpointWriter | None = None
        self._scene: Scene | None = None
        self._mapper: ProgressivePhotonMapper | None = None
        self._render: SlicedRender | None = None
        self._slices: Iterator[None] | None = None
        self._finish: BackgroundFinish | None = None
        """Result of a render whose iterations are over, on its way to be handed out; None while iterations are run."""
        self._generation = 0
        self._stopped = 0
        """The newest generation that is to end."""
        self._picture_wanted = False
        self._blocks: collections.deque[SharedBlock] = collections.deque()
        """Blocks of shared memory that Blender has not copied yet, the oldest first."""

    def expect_snapshots(self, seconds: Sequence[float]) -> None:
        """Send the picture at these ascending times; to be said before the scene is shown."""
        self._snapshots = seconds

    def keep_still(self, path: str) -> None:
        """Go on from this checkpoint and keep the render in it, "" for none; to be said before the scene is shown."""
        self._checkpoint = path

    def go_on(self, pause: Pause | None, seconds: float, reason: str) -> None:
        """Go on where a process has left the scene that is shown next. None: begin anew."""
        self._handed_on = None if pause is None else (pause, seconds, reason)

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Render this scene."""
        self._scene = scene
        self._generation = generation
        self._slices = self._finish = None
        self._picture_wanted = False

    def stop(self, generation: int) -> None:
        """End the render of this generation with what there is; another one goes on, or will begin."""
        self._stopped = generation

    @property
    def _stopping(self) -> bool:
        return self._stopped == self._generation

    @property
    def _stops_here(self) -> bool:
        """Whether the render ends now, as it is to stop: one that is kept with its iteration."""
        waits = self._keeper is not None and not (self._render.getting_ready or self._render.between_iterations)
        return self._stopping and not waits

    def want_picture(self) -> None:
        """Send the picture as soon as an iteration is complete."""
        self._picture_wanted = True

    def received(self) -> None:
        """Blender has copied the oldest frame that is in shared memory."""
        self._blocks.popleft().close()

    @property
    def busy(self) -> bool:
        """Whether there is something to render."""
        return self._scene is not None

    def run_slice(self) -> None:
        """Render a bounded while."""
        self._library.pacing.share_with_window(False)
        try:
            if self._slices is None:
                self._begin()
            if self._finish is None:
                if not self._stops_here and next(self._slices, self) is not self:
                    self._send_wanted_picture()
                    return
                self._keep()
                result = self._render.result(self._stopping)
                if result.statistics.iterations > 0:
                    self._programs.add(self._mapper.device_scene.materials)
                self._finish = BackgroundFinish(result, self._scene.settings, self._denoiser)
            finished = self._finish.take(self._stopping)
            if finished is not None:
                self._end(finished)
        except (BrokenPipeError, DeviceLostError):
            raise
        except Exception as error:
            self._context.finish()  # which says so where it is because the device is lost
            self._fail(error)

    def _begin(self) -> None:
        self._library.hurry(True)
        self._mapper = self._mapper or ProgressivePhotonMapper(self._context, self._library)
        self._keeper, continuation = None, Continuation()
        if self._checkpoint:
            self._keeper, continuation = continued_still(Path(self._checkpoint), self._scene)
        continuation.safeguard = self._send_kept
        self._take_up(continuation)
        self._render = SlicedRender(
            self._context,
            self._mapper,
            self._scene,
            on_progress=lambda progress, _: self._send("progress", progress=dataclasses.asdict(progress)),
            snapshots=self._snapshots,
            on_snapshot=self._send_snapshot,
            continuation=continuation,
        )
        if self._looks_first and continuation.begin is None and not self._programs.cover(self._scene):
            self._send_first_look()
        self._looks_first = False
        self._slices = self._render.slices()

    def _take_up(self, continuation: Continuation) -> None:
        """Go on where another process stood, unless the checkpoint is further."""
        if self._handed_on is None:
            return
        (pause, seconds, reason), self._handed_on = self._handed_on, None
        kept = continuation.begin
        if kept is None or kept.state.iteration < pause.state.iteration:
            continuation.begin = pause
        continuation.seconds = seconds
        continuation.snapshots_taken = sum(mark <= seconds for mark in self._snapshots)
        self._scene.warn(f"{reason}; the render went on {place_of(continuation.begin)} in another process")

    def _send_kept(self, pause: Pause, seconds: float) -> None:
        try:
            document, description, block = described(pause)
        except OSError as error:
            log.warning("the render is not kept for another process: %s", error)
            return
        if block is not None:
            self._blocks.append(block)
        self._send("kept", document=document, arrays=description, generation=self._generation, seconds=seconds)

    def _keep(self) -> None:
        """Write the checkpoint of a render that ends."""
        if self._keeper is None:
            return
        self._render.keep()
        try:
            self._keeper.finish()
        except PictureError as error:
            self._scene.warn(str(error))

    def _send_snapshot(self, seconds: float, frame: Frame) -> None:
        finished = finished_frame(frame, self._scene.settings, self._denoiser, self._scene.warnings)
        self._send_frame("snapshot", finished, seconds=seconds)

    def _send_wanted_picture(self) -> None:
        render = self._render
        if self._picture_wanted and render.between_iterations and render.iterations > 0:
            self._picture_wanted = False
            frame = wanted_frame(render.frame(), self._scene.settings)
            self._send_frame("picture", frame, progress=dataclasses.asdict(render.progress))

    def _send_first_look(self) -> None:
        """Send a picture at iteration 0, before the programs of the scene are compiled."""
        combined = self._looks.draw(self._scene, self._mapper)
        if combined is not None:
            np.nan_to_num(combined, copy=False)
            progress = Progress(0, self._scene.settings.iterations, self._render.elapsed, photons=0)
            self._send_frame("picture", Frame(combined, {}), progress=dataclasses.asdict(progress))

    def _send_frame(self, kind: str, frame: Frame, **content: object) -> None:
        description, block = pack([frame.combined, *frame.passes.values()])
        if block is not None:
            self._blocks.append(block)
        self._send(kind, arrays=description, passes=list(frame.passes), **content)

    def _end(self, result: RenderResult) -> None:
        self._scene = self._slices = self._finish = None
        self._send_frame("result", result.frame, statistics=result.statistics.as_dict(), stopped=result.stopped)

    def _fail(self, error: Exception) -> None:
        """The render has ended; what state the mapper is in is unknown."""
        kind, text = type(error).__name__, str(error)
        if not isinstance(error, RppmError):
            log.exception("a render failed")
        self._release_mapper()
        self._send("failed", error=kind, text=text)

    def _release_mapper(self) -> None:
        self._scene = self._slices = self._render = self._finish = None
        self._looks.release()
        if self._mapper is not None:
            self._mapper.release()
            self._mapper = None

    def release(self) -> None:
        """Give memory and frames back."""
        self._release_mapper()
        while self._blocks:
            self.received()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The loop of a render: iterations until the settings' number, the noise threshold or the time limit is reached."""

from collections.abc import Callable, Generator, Iterator, Sequence

from ...gl.context.context import Context
from ...integrator.progressive import ProgressivePhotonMapper
from ...scene.errors import DeviceLostError
from ...scene.passes import DEEP_CUBEMAP
from ...scene.scene import Scene
from ...scene.storage.validation import check_scene
from ..checkpoints.checkpoint_schedule import CheckpointSchedule
from ..checkpoints.continuation import Continuation
from .film_output import FilmOutput
from .render_progress import RenderProgress
from .results import Frame, Progress, RenderResult
from .snapshots import SnapshotSchedule

CENTER_TOLERANCE = 0.5
"""Distance, in radii of the scene, that the camera of an animation may move from the deep cubemap's center before the
cubemap is built anew. Measured in a room of 100 k triangles: rays from so far off cost a tenth more, building takes a
third of an iteration."""


class RenderLoop:
    """One render in slices of bounded time, between which other sessions render and it can be stopped."""

    def __init__(
        self,
        context: Context,
        mapper: ProgressivePhotonMapper,
        scene: Scene,
        on_progress: Callable[[Progress, Callable[[], Frame]], None] | None = None,
        snapshots: Sequence[float] = (),
        on_snapshot: Callable[[float, Frame], None] | None = None,
        continuation: Continuation | None = None,
    ) -> None:
        """Start the clock; nothing is rendered yet. The arguments after the scene are those of Renderer.render.

        Members of the scene that the mapper rendered before are neither uploaded nor built again.
        """
        self._context = context
        self._mapper = mapper
        self._scene = scene
        self._on_progress = on_progress
        self._continuation = continuation or Continuation()
        self._progress = RenderProgress(mapper, scene.settings, self._continuation.seconds)
        self._output = FilmOutput(context, mapper, scene, self._progress)
        self._checkpoints = CheckpointSchedule(self._continuation, self._output.pause)
        self._snapshots = SnapshotSchedule(snapshots, on_snapshot, self._continuation)
        self._is_skipping = False
        """Whether iterations are run that do not enter the film."""

    def run(self, should_stop: Callable[[], bool] | None = None) -> RenderResult:
        """Render to the end, or until ``should_stop`` returns True between two iterations.

        Raises the errors of scene/errors.py.
        """
        stopped = False
        try:
            for _ in self.slices():
                stopped = should_stop is not None and self._may_stop and should_stop()
                if stopped:
                    break
            self.keep()
            return self.result(stopped)
        except DeviceLostError:
            raise
        except Exception:
            self._context.finish()  # raises DeviceLostError if that is the cause
            raise

    @property
    def _may_stop(self) -> bool:
        """Whether there is a picture, or none yet and the film has not begun."""
        return self._is_skipping or (self.between_iterations and self.iterations > 0)

    def slices(self) -> Iterator[None]:
        """Render the settings' iterations, or as many as the noise threshold and the time limit ask for.

        Yields between slices. Raises the errors of scene/errors.py.
        """
        self._build()
        yield from self._begin()
        self._report()
        while self._progress.needs_iteration:
            yield
            if not (yield from self._iterate()):
                break
            self._report()
            self._snapshots.take(self.elapsed, self.frame)
            self._checkpoints.run(self.elapsed)
        if self._progress.is_early:  # no other picture comes before the time limit
            self._snapshots.take(max(self.elapsed, self._scene.settings.time_limit), self.frame)

    def _build(self) -> None:
        """Bring the scene to the device."""
        check_scene(self._scene)
        self._mapper.timers.reset()
        # The pass pictures the deep cubemap from its center, which therefore has to be the camera.
        is_inspected = DEEP_CUBEMAP.name in self._scene.settings.passes
        self._mapper.update(self._scene, center_tolerance=0.0 if is_inspected else CENTER_TOLERANCE)
        self._output.inspect()

    def _begin(self) -> Iterator[None]:
        """Resume the film, or skip the iterations before its first one."""
        pause = self._continuation.begin
        if pause is not None:
            self._mapper.resume(pause.state)
            self._progress.resume(self._mapper.iterations_in_film)
            if pause.device != self._context.information.label:
                self._scene.warn(
                    f"the checkpoint is of the device {pause.device}: the picture is not the same bit for bit "
                    "as that of an uninterrupted render"
                )
            return
        if self._continuation.sample_offset:
            self._is_skipping = True
            yield from self._mapper.skip(self._continuation.sample_offset)
            self._is_skipping = False
        self._progress.resume(0)

    def _iterate(self) -> Generator[None, None, bool]:
        """Run one iteration. Returns whether it was complete before time was up."""
        began = self.elapsed
        may_cut = self._progress.may_cut
        if may_cut:
            self.keep()
            self._output.hold()
        self._progress.begin_iteration()
        for _ in self._mapper.steps():
            yield
            if may_cut and self._progress.is_over_time:
                return False
        self._context.finish()
        self._progress.end_iteration(began)
        self._output.release()
        return True

    def _report(self) -> None:
        self._progress.measure_noise()
        if self._on_progress is not None:
            self._on_progress(self.progress, self.frame)

    @property
    def elapsed(self) -> float:
        """Seconds since the render began."""
        return self._progress.elapsed

    @property
    def iterations(self) -> int:
        """Number of complete iterations in the film."""
        return self._progress.iterations

    @property
    def between_iterations(self) -> bool:
        """Whether the film is that of a complete iteration, or of none."""
        return self._progress.between_iterations

    @property
    def can_be_kept(self) -> bool:
        """Whether the render can end now with a checkpoint of all that it has done."""
        return self._is_skipping or self.between_iterations

    @property
    def progress(self) -> Progress:
        """Progress of the render."""
        return self._progress.record()

    def frame(self) -> Frame:
        """Return the picture so far, noisy, with all passes of the film. Raises DeviceLostError."""
        return self._output.frame()

    def result(self, stopped: bool) -> RenderResult:
        """Return the picture and the statistics; ``stopped``: whether slices() was left before its end."""
        return self._output.result(stopped)

    def keep(self) -> None:
        """Hand over the state for the checkpoint, if the render has one and its film has an iteration."""
        self._checkpoints.keep()

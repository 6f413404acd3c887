# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the photon mapper on a scene and reports how it goes."""

import contextlib
import logging
import time
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence

import numpy as np

from ...denoising.denoiser import Denoiser
from ...denoising.places import library_places
from ...gl.context.context import Context, DeviceInformation
from ...gl.programs.programs import ProgramLibrary
from ...integrator.film.film import Film, exposed
from ...integrator.memory import Memory
from ...integrator.progressive import ProgressivePhotonMapper
from ...scene.errors import DeviceLostError
from ...scene.passes import DEEP_CUBEMAP
from ...scene.scene import Scene
from ...scene.storage.validation import check_scene
from ..checkpoints.continuation import Continuation, DeviceLossRecovery, Pause
from .denoised_pictures import finished_frame, finished_result, wanted_frame
from .frame_passes import frame_passes
from .noise_threshold import NoiseThreshold
from .remaining_time import RemainingTime
from .results import Frame, Progress, RenderResult, RenderStatistics, empty_result
from .time_limit import TimeLimit

log = logging.getLogger(__name__)

CENTER_TOLERANCE = 0.5
"""Radii of the scene by which the camera of an animation may leave the deep cubemap's center before it is built anew.
Measured in a room of 100 k triangles, so far off rays cost a tenth more, building a third of an iteration."""
FIRST_SAFEGUARD_SECONDS = 0.25
"""Seconds until the first safeguard of a render. A render that takes less is quickly done again."""
SAFEGUARD_SECONDS = 5.0
"""Least time from one safeguard of a render to the next, of which a lost device takes the iterations along."""
SAFEGUARD_MOST_TIME = 0.02
"""Largest fraction of all time that safeguards may take."""
MOST_LOSSES = 3
"""Number of times that one render may lose the device. After more, another context would not help either."""


def read_combined(film: Film, exposure: float) -> np.ndarray:
    """The film's current picture, as Frame.combined."""
    return exposed(film.read_radiance(), exposure)


def read_frame(film: Film, exposure: float, inspections: Mapping[str, np.ndarray] | None = None) -> Frame:
    """The film's current picture and passes; ``inspections`` are those that it does not keep."""
    passes = frame_passes(film.read_passes(), film.found_passes, exposure)
    return Frame(read_combined(film, exposure), {**passes, **(inspections or {})})


class SlicedRender:
    """One render in pieces that the device does in a bounded while, so that it can be shared and stopped."""

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
        """Arguments as those of Renderer.render. Nothing is rendered yet, but time counts from now on.

        Members that the scene shares with the one that the mapper rendered before are neither uploaded nor built.
        """
        self._context = context
        self._mapper = mapper
        self._scene = scene
        self._on_progress = on_progress
        self._continuation = continuation or Continuation()
        self._pending = list(snapshots[self._continuation.snapshots_taken :])
        self._on_snapshot = on_snapshot
        self._kept = time.perf_counter()
        self._start = self._kept - self._continuation.seconds
        self._safeguard_due = self._kept + FIRST_SAFEGUARD_SECONDS
        self._inspections: dict[str, np.ndarray] = {}
        """Passes that are computed once."""
        self._found = 0
        """Iterations that were there before this render."""
        self.iterations = 0
        """Number of complete iterations in the film."""
        self._limit = TimeLimit(scene.settings.time_limit)
        self._noise = NoiseThreshold(scene.settings)
        self._remaining = RemainingTime()
        self._before: RenderResult | None = None
        """Result before an iteration that may be given up, or None. Giving one up leaves the film unfinished."""
        self._late_warnings: list[str] = []
        self.getting_ready = False
        """Whether iterations are run that do not enter the film."""
        self.between_iterations = False
        """Whether the photons and the film are those of a complete iteration, or of none."""

    def slices(self) -> Iterator[None]:
        """Render the settings' iterations, or as many as the time limit (TimeLimit) or the noise asks for, but one.

        Raises the errors of scene/errors.py.
        """
        check_scene(self._scene)
        mapper, settings = self._mapper, self._scene.settings
        mapper.timers.reset()
        # The pass pictures the deep cubemap: there the center is not free.
        inspected = DEEP_CUBEMAP.name in settings.passes
        mapper.update(self._scene, center_tolerance=0.0 if inspected else CENTER_TOLERANCE)
        if inspected:
            self._inspections = {DEEP_CUBEMAP.name: mapper.inspect_deep_cubemap()[..., :3]}
        yield from self._begin()
        self._measure_noise()
        self._report()
        while not self._is_done and self._limit.allows_another(self.elapsed):
            yield
            if not (yield from self._iterate()):
                break
            self._measure_noise()
            self._report()
            self._take_snapshots()
            if time.perf_counter() - self._kept >= self._continuation.interval:
                self.keep()
            self._safeguard()
        if self.iterations < settings.iterations:
            self._take_snapshots(settings.time_limit)

    @property
    def _is_done(self) -> bool:
        return self.iterations >= self._scene.settings.iterations or self._noise.is_reached

    def _measure_noise(self) -> None:
        if self._noise.is_due(self.iterations):
            self._noise.add(self.iterations, self._mapper.measure_noise())

    def _iterate(self) -> Generator[None, None, bool]:
        """One more iteration; returns whether it has come to its end before time was up."""
        began = self.elapsed
        cuttable = self._limit.may_cut(began)
        if cuttable:
            self.keep()
            self._before = self.result(stopped=False)
        self.between_iterations = False
        for _ in self._mapper.steps():
            yield
            if cuttable and self._limit.has_passed(self.elapsed):
                return False
        self._context.finish()
        seconds = self.elapsed - began
        self.iterations += 1
        self.between_iterations = True
        self._before = None
        self._remaining.add(self.elapsed)
        if self._limit.is_first_too_long(self.elapsed):
            self._late_warnings = [
                f"the first sample ended after {self.elapsed:.1f} s, past the time limit of {self._limit.limit:.3g} s: "
                "there would be no picture without it; fewer photons or pixels make samples shorter"
            ]
            log.warning("%s", self._late_warnings[0])
        self._limit.add(seconds, *(self._photons_of(self.iterations + later) for later in (0, 1)))
        return True

    def _photons_of(self, number: int) -> int:
        """Photons of one of the film's iterations, counted from 1."""
        return self._mapper.photons_emitted(number) - self._mapper.photons_emitted(number - 1)

    def _begin(self) -> Iterator[None]:
        """Come to the iteration that the film goes on with."""
        mapper, pause = self._mapper, self._continuation.begin
        if pause is not None:
            mapper.resume(pause.state)
            self.iterations = self._found = mapper.iterations_in_film
            if pause.device != self._context.information.label:
                self._scene.warn(
                    f"the checkpoint is of the device {pause.device}: the picture is not the same bit for bit "
                    "as that of an uninterrupted render"
                )
        elif self._continuation.sample_offset:
            self.getting_ready = True
            yield from mapper.skip(self._continuation.sample_offset)
            self.getting_ready = False
        self.between_iterations = True

    def keep(self) -> None:
        """Tell whoever keeps the render how to go on with it, once there is something to keep."""
        if self._continuation.keep is not None and self.between_iterations and self.iterations > 0:
            self._continuation.keep(self._pause())
        self._kept = time.perf_counter()

    def _safeguard(self) -> None:
        """The same for whoever begins again where this device or process is lost, as far as that costs little."""
        start = time.perf_counter()
        if self._continuation.safeguard is not None and start >= self._safeguard_due:
            self._continuation.safeguard(self._pause(), self.elapsed)
            now = time.perf_counter()
            self._safeguard_due = now + max(SAFEGUARD_SECONDS, (now - start) / SAFEGUARD_MOST_TIME)

    def _pause(self) -> Pause:
        """Between two iterations. Raises DeviceLostError for one that was read of a lost device."""
        mapper = self._mapper
        pause = Pause(mapper.state(), self._context.information.label, mapper.splat_radii[0], self._inspections)
        self._context.finish()
        return pause

    @property
    def elapsed(self) -> float:
        """Seconds since the render began."""
        return time.perf_counter() - self._start

    def _report(self) -> None:
        if self._on_progress is not None:
            self._on_progress(self.progress, self.frame)

    def _take_snapshots(self, until: float = 0.0) -> None:
        """Hand out the snapshots that are due, and those up to ``until``, before which no other picture comes."""
        while self._pending and max(self.elapsed, until) >= self._pending[0]:
            mark = self._pending.pop(0)
            if self._on_snapshot is not None:
                self._on_snapshot(mark, self.frame())

    @property
    def progress(self) -> Progress:
        """How far the render is."""
        settings, noise = self._scene.settings, self._noise
        iterations = min(settings.iterations, noise.expected_iterations or settings.iterations)
        return Progress(
            self.iterations,
            settings.iterations,
            self.elapsed,
            self._mapper.photons_emitted(self.iterations),
            settings.time_limit,
            noise.expected_iterations,
            self._remaining.seconds(iterations - self.iterations, self.elapsed, settings.time_limit),
            noise.noise,
            noise.threshold,
            sum(self._mapper.memory_bytes.values()),
        )

    def frame(self) -> Frame:
        """The picture so far, with its noise and all passes of the film."""
        if self._before is not None:
            return self._before.frame
        frame = read_frame(self._mapper.film, self._scene.exposure, self._inspections)
        self._context.finish()  # a lost device would give no picture
        return frame

    def result(self, stopped: bool) -> RenderResult:
        """The picture and the figures; ``stopped`` says whether slices() was left before its end."""
        if self.iterations == 0:
            return empty_result(self._scene, self._context.information.label)
        if self._before is not None:
            statistics = self._before.statistics
            statistics.seconds, statistics.stage_seconds = self.elapsed, self._mapper.timers.seconds
            return RenderResult(self._before.frame, statistics, stopped)
        mapper, seconds, warnings = self._mapper, self.elapsed, [*self._scene.warnings, *self._late_warnings]
        balance = {}
        if self.between_iterations and self.iterations > self._found:
            balance = mapper.flux_balance()
            emitted = max(balance["emitted"], 1e-30)
            if abs(balance["lost"]) > 1e-4 * emitted:
                warnings.append(f"{balance['lost'] / emitted:.2%} of the photons' flux was lost in tracing")
        statistics = RenderStatistics(
            iterations=self.iterations,
            photons=self.progress.photons,
            seconds=seconds,
            build_seconds=mapper.build_seconds,
            device=self._context.information.label,
            triangles=mapper.triangle_count,
            radius_meters=mapper.splat_radii[0],
            density_estimation=mapper.density_estimation.name,
            first_photon_hits=mapper.first_photon_hits.name,
            noise=self._noise.noise,
            stage_seconds=mapper.timers.seconds,
            memory_bytes=mapper.memory_bytes,
            flux_watts=balance,
            source_watts=mapper.source_watts,
            source_photons=mapper.source_photons,
            warnings=warnings,
        )
        return RenderResult(self.frame(), statistics, stopped)


class Renderer:
    """Owns the GL context and the compiled programs; renders one scene after another."""

    def __init__(self, device: str | None = None, denoiser: Denoiser | None = None, times_stages: bool = False) -> None:
        """Open the device (see Context.create). Raises DeviceError.

        denoiser: None is one by the libraries that are found here.
        times_stages: whether statistics tell the seconds of stages, for which the device is waited for.
        """
        self._wish = device
        self._context = Context.create(device)
        self._denoiser = denoiser or Denoiser(library_places())
        self._library = ProgramLibrary(self._context)
        self._times_stages = times_stages
        self._mapper: ProgressivePhotonMapper | None = None

    @property
    def device(self) -> DeviceInformation:
        """Device that the renderer uses."""
        return self._context.information

    def __enter__(self) -> "Renderer":
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def render(
        self,
        scene: Scene,
        on_progress: Callable[[Progress, Callable[[], Frame]], None] | None = None,
        should_stop: Callable[[], bool] | None = None,
        snapshots: Sequence[float] = (),
        on_snapshot: Callable[[float, Frame], None] | None = None,
        continuation: Continuation | None = None,
    ) -> RenderResult:
        """Render a scene to its settings' iterations or time limit, whichever comes first.

        What it shares with the scene before stays on the device, so nobody may change members of scenes.
        ``on_progress`` is called once the structure stands (iteration 0) and after each iteration,
        with a function that reads the current picture; ``should_stop`` is asked as often, and one
        iteration is done in any case so that there is a picture. ``on_snapshot`` gets the picture
        as each of the ascending ``snapshots`` (seconds since the call) has passed. ``continuation``
        says where to begin and who keeps the render, for those that do not just begin and end.
        Where the device is lost the render goes on in another context, after the last iteration that was safeguarded.
        Raises the errors of scene/errors.py.
        """
        going_on = DeviceLossRecovery(continuation)

        def hand_out(seconds: float, frame: Frame) -> None:
            going_on.continuation.snapshots_taken += 1
            if on_snapshot is not None:
                on_snapshot(seconds, frame)

        while True:
            try:
                with self._context.moderngl:  # another context may be current in this thread
                    return self._render(scene, on_progress, should_stop, snapshots, hand_out, going_on.continuation)
            except DeviceLostError as error:
                if going_on.losses == MOST_LOSSES:
                    raise
                going_on.lose(scene, error)
                self._open_anew()

    def _open_anew(self) -> None:
        """Have another context in place of a lost one."""
        self._mapper = None  # whose buffers are gone
        with contextlib.suppress(Exception):  # whatever drivers say to those who tidy up
            self._library.release()
            self._context.release()
        self._context = Context.create(self._wish)
        self._library = ProgramLibrary(self._context)

    def _render(
        self,
        scene: Scene,
        on_progress: Callable[[Progress, Callable[[], Frame]], None] | None,
        should_stop: Callable[[], bool] | None,
        snapshots: Sequence[float],
        on_snapshot: Callable[[float, Frame], None],
        continuation: Continuation,
    ) -> RenderResult:
        if self._mapper is None:
            self._mapper = ProgressivePhotonMapper(self._context, self._library)
            if self._times_stages:
                self._mapper.timers.begin()
        late_warnings: list[str] = []

        def report(progress: Progress, read: Callable[[], Frame]) -> None:
            if on_progress is not None:
                on_progress(progress, lambda: wanted_frame(read(), scene.settings))

        def hand_out(seconds: float, frame: Frame) -> None:
            on_snapshot(seconds, finished_frame(frame, scene.settings, self._denoiser, late_warnings))

        render = SlicedRender(self._context, self._mapper, scene, report, snapshots, hand_out, continuation)
        stopped = False
        try:
            for _ in render.slices():
                may_stop = render.getting_ready or (render.between_iterations and render.iterations > 0)
                stopped = should_stop is not None and may_stop and should_stop()
                if stopped:
                    break
            render.keep()
            result = render.result(stopped)
        except DeviceLostError:
            raise
        except Exception:
            self._context.finish()  # which says so where it is because the device is lost
            raise
        return finished_result(result, scene.settings, self._denoiser)

    def compile(self, scene: Scene, on_program: Callable[[int, int, str], None]) -> int:
        """Have the driver compile the programs that pictures of a scene need, and keep them on the disk.

        The scene is rendered, as drivers compile for the state in which programs run: make it small. ``on_program`` is
        notified before each program that runs for the first time the how many-th it is, how many there are so far, and
        its name.
        Returns their number. Raises the errors of scene/errors.py.
        """
        library = self._library
        library.on_start = lambda name: on_program(library.started, library.made, name)
        try:
            self.render(scene)
        finally:
            library.on_start = None
        return library.started

    def inspect(self, scene: Scene) -> tuple[np.ndarray, dict[str, int], dict[str, int]]:
        """Measure what the camera's rays cost in the scene's deep cubemap, without rendering.

        Returns (height, width, 4) float32 of CUBEMAP_COSTS, the counts of the structure, and
        its bytes by buffer. Raises the errors of scene/errors.py.
        """
        check_scene(scene)
        with self._context.moderngl:
            if self._mapper is None:
                self._mapper = ProgressivePhotonMapper(self._context, self._library)
            self._mapper.build_deep_cubemap(scene)
            cubemap = self._mapper.deep_cubemap
            counts = cubemap.counts | {"resolution": cubemap.resolution}
            return self._mapper.inspect_deep_cubemap(), counts, cubemap.memory_bytes

    def memory(self, scene: Scene) -> Memory:
        """Bytes on the device that rendering the scene takes. Raises the errors of scene/errors.py."""
        check_scene(scene)
        with self._context.moderngl:
            if self._mapper is None:
                self._mapper = ProgressivePhotonMapper(self._context, self._library)
            self._mapper.build(scene)
            self._mapper.lengthen_lists()
            return self._mapper.memory

    def forget(self) -> None:
        """Give back what the device and the memory hold of the last scene; programs stay."""
        if self._mapper is not None:
            with self._context.moderngl:
                self._mapper.release()
            self._mapper = None

    def release(self) -> None:
        """Free the device; the renderer cannot be used afterwards."""
        self.forget()
        self._library.release()
        self._context.release()

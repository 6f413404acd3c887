# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's session in the renderer's process."""

import math
import time
from collections.abc import Generator, Iterator

from ...denoising.denoiser import Denoiser
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...integrator.progressive import ProgressivePhotonMapper
from ...integrator.viewport.pictures import demands_of
from ...scene.errors import DeviceLostError
from ...scene.scene import Scene
from ..placeholders.known_programs import KnownPrograms
from ..placeholders.resolution_scaler import at_level
from ..placeholders.stand_ins import StandIns
from ..render.background_denoising import POLL_SECONDS
from ..transport.messages import Send
from .denoising import ViewportDenoising
from .picture_series import PictureSeries
from .presenter import ViewportPresenter, film_picture
from .scheduler import ViewportScheduler, ViewRequest
from .status_reporter import StatusReporter


class ViewportRenderer:
    """Renders the newest scene that Blender has sent, slice by slice, and sends its pictures as frames."""

    def __init__(
        self, context: Context, library: ProgramLibrary, denoiser: Denoiser, send: Send, programs: KnownPrograms
    ) -> None:
        """programs: programs of materials that the process has rendered with."""
        self._context = context
        self._library = library
        self._programs = programs
        self._scheduler = ViewportScheduler()
        self._presenter = ViewportPresenter(context, library, send)
        self._denoising = ViewportDenoising(denoiser)
        self._status = StatusReporter(send, library)
        self._stand_ins = StandIns(library)
        self.mapper: ProgressivePhotonMapper | None = None
        self._slices: Iterator[None] | None = None
        """The rest of the scene's rendering; None if it is complete."""
        self._has_rendered = False
        """Whether a rendered picture was presented."""
        self._arriving: ViewRequest | None = None
        """The newest scene of the reading thread, which is shown once the renderer handles messages again."""

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Render this scene next, in place of the one that is rendered, which is given up after its first picture."""
        self._scheduler.request(ViewRequest(scene, generation, navigating))

    def expect(self, scene: Scene, generation: int) -> None:
        """Announce a scene that will be shown soon, in another thread."""
        self._arriving = ViewRequest(scene, generation, navigating=True)

    def pause(self, paused: bool) -> None:
        """Stop improving the picture, or continue."""
        self._scheduler.is_paused = paused

    @property
    def busy(self) -> bool:
        """Whether there is something to render."""
        return self._scheduler.pending is not None or (self._slices is not None and not self._scheduler.is_paused)

    def run_slice(self) -> None:
        """Render for a bounded time. Raises DeviceLostError, and BrokenPipeError when Blender has left."""
        self._library.pacing.share_with_window(True)
        request = self._scheduler.take()
        if request is not None:
            self._slices = self._render(request)
        try:
            if self._scheduler.pending is not None:
                self._reproject(self._scheduler.pending)
            if self.mapper is not None and not self._has_rendered:
                self._library.on_start = self._while_compiling
            if self._slices is not None and next(self._slices, self) is self:
                self._slices = None
        except (BrokenPipeError, DeviceLostError):
            raise
        except Exception as error:
            self._context.finish()  # raises DeviceLostError if that is the cause
            self._fail(error)
        finally:
            self._library.on_start = None

    def _render(self, request: ViewRequest) -> Iterator[None]:
        """Render a scene at ascending resolutions."""
        self._reproject(request)
        for level in self._scheduler.resolution_levels(request):
            yield from self._render_level(request, level)

    def _render_level(self, request: ViewRequest, level: float) -> Iterator[None]:
        """Render a scene at one resolution, and again as materials' own programs replace stand-ins."""
        mapper = self.mapper = self.mapper or ProgressivePhotonMapper(self._context, self._library)
        is_first = not self._has_rendered and self._presenter.newest_generation < request.generation
        if is_first and not self._programs.cover(request.scene):
            self._presenter.present_first_look(request.scene, request.generation, mapper)
            yield
        self._library.hurry(True)
        while True:
            is_complete = yield from self._render_series(mapper, request, level)
            while is_complete and self._stand_ins.count and not self._stand_ins.due:
                time.sleep(POLL_SECONDS)
                yield
            if not self._stand_ins.due:
                return

    def _render_series(
        self, mapper: ProgressivePhotonMapper, request: ViewRequest, level: float
    ) -> Generator[None, None, bool]:
        """Run iterations until something else is due. Returns whether all were run."""
        scene = self._stand_ins.replace(request.scene)
        began = time.perf_counter()
        center_tolerance = math.inf if level < 1.0 else 0.0
        mapper.update(at_level(scene, level), center_tolerance, demands_of(scene, level, request.scene.materials))
        series = PictureSeries(mapper, scene, request.generation, level, began)
        self._denoising.begin_series(mapper.scene)
        yield
        is_complete = False
        while not is_complete:
            yield from mapper.steps()
            series.measure_noise()
            is_complete = series.is_complete
            now = time.perf_counter()
            self._present(series)
            self._present_denoised(series)
            if is_complete:
                yield from self._finish_denoising(series)
            memory_bytes = sum(mapper.memory_bytes.values()) + self._presenter.memory_bytes
            self._status.report(series.status(now, memory_bytes, self._stand_ins.count))
            yield
            if self._stand_ins.due and not self._scheduler.first_picture_pending:
                return False
            if self._scheduler.is_higher_level_due(level, request.navigating):
                return False
        return True

    def _present(self, series: PictureSeries) -> None:
        """Present the picture of an iteration, if it is due, or begin to denoise it."""
        mapper, scene = series.mapper, series.scene
        per_frame = scene.settings.iterations_per_frame
        if not (series.is_complete or self._scheduler.is_picture_due(mapper.iteration, per_frame)):
            return
        began = time.perf_counter()
        shows_noisy = not self._denoising.has_picture
        if self._denoising.is_wanted(mapper.iteration) and self._denoising.is_due:
            self._start_denoising(series)
        if shows_noisy:
            self._presenter.present(scene, series.generation, mapper, series.is_complete)
        self._scheduler.add_picture(began, mapper.film.width * mapper.film.height, began - series.began)
        if not self._has_rendered:
            self._has_rendered = True
            self._programs.add(mapper.device_scene.materials)

    def _start_denoising(self, series: PictureSeries) -> None:
        film = series.mapper.film
        self._denoising.start(series.mapper.iteration, film_picture(film, series.scene), film.read_passes())

    def _present_denoised(self, series: PictureSeries, seconds: float = 0.0) -> int:
        """Present a picture that is denoised within so many seconds. Returns its iteration, 0 if there is none."""
        found = self._denoising.take(seconds)
        if found is None:
            return 0
        iteration, combined = found
        self._presenter.present_denoised(combined, series.scene, series.generation, series.progress)
        return iteration

    def _finish_denoising(self, series: PictureSeries) -> Iterator[None]:
        """Present the denoised picture of the last iteration, if the settings ask for it."""
        iteration, last = 0, series.mapper.iteration
        while self._denoising.is_wanted(last) and iteration < last:
            if self._denoising.is_idle:
                self._start_denoising(series)
            yield
            iteration = max(iteration, self._present_denoised(series, POLL_SECONDS))

    def _reproject(self, request: ViewRequest) -> None:
        """Until a changed view is rendered, present the last picture as that view has it."""
        if self._presenter.can_reproject(request.generation):
            self._presenter.reproject(self._stand_ins.as_shown(request.scene), request.generation)

    def _while_compiling(self, _program: str) -> None:
        """Between two programs of the first picture, present the view that has changed and report the compilation."""
        if self._arriving is not None and self.mapper is not None:
            self._presenter.update_first_look(self._arriving.scene, self._arriving.generation, self.mapper)
        self._status.report_compilation()

    def _fail(self, error: Exception) -> None:
        """Report an error and wait for another scene. The mapper is released, as its state is unknown."""
        self._release_mapper()
        self._status.report_error(error)

    def _release_mapper(self) -> None:
        self._slices = None
        self._scheduler.cancel()
        self._presenter.release_pictures()
        if self.mapper is not None:
            self.mapper.release()
            self.mapper = None

    def release(self) -> None:
        """Free what the session has on the device and in shared memory."""
        self._release_mapper()
        self._denoising.release()
        self._presenter.release()

# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's session in the renderer's process."""

import math
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...denoising.denoiser import Denoiser
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...integrator.film.film import Film
from ...integrator.progressive import ProgressivePhotonMapper
from ...integrator.viewport.pictures import ViewportPictures, demands_of
from ...scene.errors import DenoiserError, DeviceLostError, RppmError, unforeseen
from ...scene.materials import Material
from ...scene.scene import Scene
from ..placeholders.first_looks import FirstLooks
from ..placeholders.known_programs import KnownPrograms
from ..placeholders.resolution_scaler import ResolutionScaler, at_level
from ..placeholders.stand_ins import StandIns
from ..render.background_denoising import POLL_SECONDS, BackgroundDenoising
from ..render.frame_passes import frame_passes
from ..render.noise_threshold import NoiseThreshold
from ..render.renderer import log, read_combined
from ..transport.frames import FrameWriter
from ..transport.sessions import SessionStatus

NAVIGATION_SECONDS = 1.0 / 15.0
"""Time for the first picture while the view or the scene keeps changing."""
FIRST_SECONDS = 0.15
"""Time for the first picture after a single change."""
REST_SECONDS = 0.25
"""Without a change for so long, the view is at rest and pictures become sharper."""

BRIGHTEST = 65000.0
"""Windows draw half floats, which end there; what is infinite would be drawn black."""

FRAME_SECONDS = 1.0 / 60.0
"""Pictures that follow each other faster are not given out: nobody would see them, and reading them costs time."""

MOST_PICTURE_TIME = 0.1
"""Largest fraction of all time that making pictures of a film may take from the iterations."""
MOVED_SECONDS = 1.0 / 12.0
"""Between two pictures that are moved into views that follow each other."""
MOVE_SECONDS = 1.0 / 30.0
"""For moving one, with fewer pixels where it takes more."""

COMPILING_SECONDS = 0.1
"""Between two words about how far compiling is."""

Send = Callable[..., None]
"""send(kind, **content): a message to Blender about this session."""


def shown_picture(film: Film, scene: Scene) -> np.ndarray:
    """(height, width, 4) float32: Combined, or where the scene's settings name a single pass, that as colors, a
    value as gray."""
    if len(scene.settings.passes) != 1:
        return read_combined(film, scene.exposure)
    values = frame_passes(film.read_passes(), film.found_passes, scene.exposure)[scene.settings.passes[0]]
    planes = np.atleast_3d(values)
    shown = np.zeros((*planes.shape[:2], 4), np.float32)
    shown[..., : planes.shape[2]] = planes
    if planes.shape[2] == 1:
        shown[..., :3] = planes
    shown[..., 3] = 1.0
    return shown


class ViewportRenderer:
    """Renders the newest scene that it was shown, slice by slice, and gives frames out."""

    def __init__(
        self, context: Context, library: ProgramLibrary, denoiser: Denoiser, send: Send, programs: KnownPrograms
    ) -> None:
        """programs: what all viewports of the process know to be ready."""
        self._context = context
        self._library = library
        self._denoising = BackgroundDenoising(denoiser)
        self._pictures = 0
        """Series of pictures of one scene and resolution so far: each has a number."""
        self._denoised = 0
        """The series of which a denoised picture was given out last."""
        self._left_noisy = 0
        """The series that could not be denoised."""
        self._send = send
        self._programs = programs
        self._frames = FrameWriter()
        self._mapper: ProgressivePhotonMapper | None = None
        self._slices: Iterator[None] | None = None
        self._shown: tuple[Scene, int, bool] | None = None
        self._shown_at = 0.0
        self._first_picture_pending = False
        self._looks = FirstLooks(context, library)
        """First looks, shown until there is a first frame. Afterward they help to draw a moving view."""
        self._viewport_pictures: ViewportPictures | None = None
        self._moved_at = 0.0
        self._move_seconds = 0.0
        """When the last picture was moved into another view, and how long that took."""
        self._moved_sharpness = ResolutionScaler(seconds_per_pixel=1e-9)
        self._coming: tuple[Scene, int] | None = None
        """The newest scene that the reading thread has, which is shown once the renderer takes messages again."""
        self._newest_sent = 0
        """Generation of the last frame."""
        self._rendered = False
        """Whether there has been a frame of the renderer's own."""
        self._told_at = 0.0
        self._next_picture_at = 0.0
        self._sharpness = ResolutionScaler()
        self._stand_ins = StandIns(library)
        self._paused = False
        self._status = SessionStatus()

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Render this scene next; what was rendered of another is dropped.

        But for its first picture: else nothing would be seen of a scene that changes faster than it is rendered.
        """
        self._shown = (scene, generation, navigating)
        self._shown_at = time.perf_counter()

    def expect(self, scene: Scene, generation: int) -> None:
        """This scene will be shown soon; called in another thread."""
        self._coming = scene, generation

    def pause(self, paused: bool) -> None:
        """Stop improving the picture, or go on."""
        self._paused = paused

    @property
    def busy(self) -> bool:
        """Whether there is something to render."""
        return self._shown is not None or (self._slices is not None and not self._paused)

    def run_slice(self) -> None:
        """Render a bounded while."""
        self._library.pacing.share_with_window(True)
        if self._shown is not None and not (self._slices is not None and self._first_picture_pending):
            self._slices = self._render(*self._shown)
            self._shown = None
        try:
            if self._shown is not None:
                self._follow_view(*self._shown[:2])
            if self._mapper is not None and not self._rendered:  # the programs of the first look are there
                self._library.on_start = self._while_compiling
            if next(self._slices, self) is self:  # ended
                self._slices = None
        except (BrokenPipeError, DeviceLostError):
            raise
        except Exception as error:
            self._context.finish()  # which says so where it is because the device is lost
            self._fail(error)
        finally:
            self._library.on_start = None

    def _render(self, scene: Scene, generation: int, navigating: bool) -> Iterator[None]:
        """Pictures of a scene, first a coarse one and then sharper ones."""
        self._first_picture_pending = True
        self._follow_view(scene, generation)
        width, height = scene.camera.resolution
        levels = self._sharpness.levels(width * height, NAVIGATION_SECONDS if navigating else FIRST_SECONDS)
        for level in levels:
            yield from self._render_level(scene, generation, navigating, level)

    def _render_level(self, scene: Scene, generation: int, navigating: bool, level: float) -> Iterator[None]:
        """Pictures of one sharpness, begun anew as materials' own programs become ready."""
        if self._mapper is None:
            self._mapper = ProgressivePhotonMapper(self._context, self._library)
        if not self._rendered and self._newest_sent < generation and not self._programs.cover(scene):
            self._look_at(scene, generation)
            yield
        self._library.hurry(True)
        while True:
            shown = self._stand_ins.replace(scene)
            done = yield from self._improve(shown, scene.materials, generation, navigating, level)
            while done and self._stand_ins.count and not self._stand_ins.due:
                time.sleep(POLL_SECONDS)
                yield
            if not self._stand_ins.due:
                return

    def _improve(
        self, scene: Scene, materials: Sequence[Material], generation: int, navigating: bool, level: float
    ) -> Generator[None, None, bool]:
        """Iterations of a scene, until something else is due. Returns whether there are no more.

        materials: its own, or those that others stand in for.
        """
        started = time.perf_counter()
        mapper, settings = self._mapper, scene.settings
        center_tolerance = math.inf if level < 1.0 else 0.0
        mapper.update(at_level(scene, level), center_tolerance, demands_of(scene, level, materials))
        built = time.perf_counter()
        self._pictures += 1
        yield
        threshold = NoiseThreshold(settings)
        last = False
        while not last:
            yield from mapper.steps()
            if threshold.is_due(mapper.iteration):
                threshold.add(mapper.iteration, mapper.measure_noise())
            now = time.perf_counter()
            last = mapper.iteration >= settings.iterations or threshold.is_reached
            at_once = last or self._first_picture_pending or now >= self._next_picture_at
            if last or (at_once and mapper.iteration % settings.iterations_per_frame == 0):
                self._show_picture(scene, generation, last)
                took = time.perf_counter() - now
                self._next_picture_at = now + max(FRAME_SECONDS, took / MOST_PICTURE_TIME)
                if not self._rendered:
                    self._rendered = True
                    self._programs.add(mapper.device_scene.materials)
                if self._first_picture_pending:
                    self._sharpness.measure(mapper.film.width * mapper.film.height, now - started)
                    self._first_picture_pending = False
            self._show_denoised(scene, generation)
            if last:
                yield from self._finish_denoising(scene, generation)
            self._tell(
                SessionStatus(
                    generation=generation,
                    iteration=mapper.iteration,
                    iterations=settings.iterations,
                    photons=mapper.photons_emitted(mapper.iteration),
                    elapsed_seconds=now - started,
                    radius_meters=mapper.splat_radii[0],
                    memory_bytes=sum(mapper.memory_bytes.values()) + self._picture_bytes,
                    density_estimation=mapper.density_estimation.name,
                    first_photon_hits=mapper.first_photon_hits.name,
                    iterations_per_second=mapper.iteration / (now - built),
                    photons_per_second=mapper.photons_emitted(mapper.iteration) / (now - built),
                    source_watts=mapper.source_watts,
                    source_photons=mapper.source_photons,
                    warnings=mapper.scene.warnings,
                    noise=threshold.noise,
                    noise_threshold=threshold.threshold,
                    programs_stood_in_for=self._stand_ins.count,
                    settled=level == 1.0 and last and not self._stand_ins.count,
                )
            )
            yield
            if self._stand_ins.due and not self._first_picture_pending:
                return False
            at_rest = not navigating or time.perf_counter() - self._shown_at >= REST_SECONDS
            if level < 1.0 and at_rest and not self._first_picture_pending:
                return False
        return True

    def _is_denoised(self, scene: Scene) -> bool:
        """Whether the picture so far is to be denoised."""
        settings = scene.settings
        starts = settings.use_denoising and self._mapper.iteration >= settings.denoising_start_sample
        return starts and self._left_noisy != self._pictures

    def _show_picture(self, scene: Scene, generation: int, last: bool) -> None:
        """Give the picture so far out, or have it denoised. Until there is a denoised picture, noisy ones are shown,
        so that none is waited for; from then on, only denoised ones."""
        denoise = self._is_denoised(scene) and self._denoising.is_due
        show = self._denoised != self._pictures
        if denoise:
            self._start_denoising(shown_picture(self._mapper.film, scene), scene)
        if show:
            self._give_out(self._picture(scene, last), scene, generation, last)

    @property
    def _picture_bytes(self) -> int:
        """On the device, of what is shown."""
        return sum(self._viewport_pictures.memory_bytes.values())

    def _picture(self, scene: Scene, last: bool) -> np.ndarray:
        """The picture so far as a viewport shows it."""
        mapper = self._mapper
        if self._viewport_pictures is None:
            self._viewport_pictures = ViewportPictures(self._context, self._library, self._looks.of(mapper))
        combined = self._viewport_pictures.show(scene, mapper.film, mapper.iteration, last)
        return shown_picture(mapper.film, scene) if combined is None else combined

    def _follow_view(self, scene: Scene, generation: int) -> None:
        """Until a view that has changed is rendered, move the last picture into it, as often as the device has time for
        that beside rendering."""
        now = time.perf_counter()
        due = now - self._moved_at >= max(MOVED_SECONDS, 2.0 * self._move_seconds)
        if self._viewport_pictures is None or generation <= self._newest_sent or not due:
            return
        level = self._moved_sharpness.first(math.prod(scene.camera.resolution), MOVE_SECONDS)
        combined = self._viewport_pictures.move(at_level(self._stand_ins.as_shown(scene), level))
        self._moved_at = time.perf_counter()
        self._move_seconds = self._moved_at - now
        if combined is not None:
            self._moved_sharpness.measure(combined.shape[0] * combined.shape[1], self._move_seconds)
            self._send_frame(combined, generation, 0.0)

    def _start_denoising(self, combined: np.ndarray, scene: Scene) -> None:
        key = self._pictures, self._mapper.iteration
        try:
            self._denoising.start(key, combined, self._mapper.film.read_passes(), scene.settings)
        except DenoiserError as error:
            self._leave_noisy(error)

    def _show_denoised(self, scene: Scene, generation: int, seconds: float = 0.0) -> int:
        """Give out what has been denoised within so many seconds, if it is of this series; returns its iteration."""
        try:
            found = self._denoising.take(seconds)
        except DenoiserError as error:
            self._leave_noisy(error)
            return 0
        if found is None or found[0][0] != self._pictures:
            return 0
        (_, iteration), combined = found
        self._give_out(combined, scene, generation)
        self._denoised = self._pictures
        return iteration

    def _finish_denoising(self, scene: Scene, generation: int) -> Iterator[None]:
        """See to it that the last picture is denoised."""
        iteration = 0
        while self._is_denoised(scene) and iteration < self._mapper.iteration:
            if self._denoising.is_idle:
                self._start_denoising(shown_picture(self._mapper.film, scene), scene)
            yield
            iteration = max(iteration, self._show_denoised(scene, generation, POLL_SECONDS))

    def _leave_noisy(self, error: DenoiserError) -> None:
        """Go on without denoising, and say so."""
        self._left_noisy = self._pictures
        self._denoised = 0
        self._mapper.scene.warn(f"the viewport is not denoised: {error}")

    def _look_at(self, scene: Scene, generation: int) -> None:
        """Give a first look at a scene out, if there is one; a single pass has none."""
        if len(scene.settings.passes) == 1:
            return
        combined = self._looks.draw(scene, self._mapper)
        if combined is not None:
            self._send_frame(combined, generation, 0.0)

    def _while_compiling(self, name: str) -> None:
        """Between two programs of the first frame: follow the view, and say how far it is."""
        if self._coming is not None:
            scene, generation = self._coming
            if generation > self._newest_sent and self._looks.shows_parts_of(scene):
                self._look_at(scene, generation)
        now = time.perf_counter()
        if now - self._told_at >= COMPILING_SECONDS:
            self._told_at = now
            library = self._library
            self._tell(SessionStatus(program=name, programs_started=library.started, programs=library.made))

    def _give_out(self, combined: np.ndarray, scene: Scene, generation: int, last: bool = False) -> None:
        """Send a picture, which is changed, unless a newer view was looked at meanwhile."""
        self._viewport_pictures.given_out(scene, combined)
        if generation >= self._newest_sent:
            self._send_frame(combined, generation, 1.0 if last else self._mapper.iteration / scene.settings.iterations)

    def _send_frame(self, combined: np.ndarray, generation: int, progress: float) -> None:
        """Write a picture, which is changed, to a slot."""
        # Done here, where no window waits for it.
        np.nan_to_num(combined, copy=False, nan=0.0, posinf=BRIGHTEST, neginf=0.0)
        np.minimum(combined, BRIGHTEST, out=combined)
        height, width = combined.shape[:2]
        slots = self._frames.reserve(width * height)
        if slots is not None:
            self._send("slots", **slots)
        self._newest_sent = generation
        self._send("frame", **self._frames.write(generation, combined), progress=progress)

    def _tell(self, status: SessionStatus) -> None:
        self._status = status
        self._send("status", status=vars(status))

    def _fail(self, error: Exception) -> None:
        """Say what is wrong and wait for another scene; what state the mapper is in is unknown."""
        text = str(error)
        if not isinstance(error, RppmError):
            log.exception("a viewport failed")
            text = unforeseen(error, "please report what its log says")
        self._release_mapper()
        self._tell(replace(self._status, error=text, settled=True))

    def _release_mapper(self) -> None:
        self._slices = None
        if self._viewport_pictures is not None:
            self._viewport_pictures.release()
            self._viewport_pictures = None
        self._looks.release()
        if self._mapper is not None:
            self._mapper.release()
            self._mapper = None

    def release(self) -> None:
        """Give memory and frames back."""
        self._release_mapper()
        self._denoising.release()
        self._frames.release()

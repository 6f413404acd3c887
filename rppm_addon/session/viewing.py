# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's session in the renderer's process."""

import time
from collections.abc import Callable, Iterator
from dataclasses import replace

from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..integrator.progressive import ProgressivePhotonMapper
from ..scene.errors import RppmError
from ..scene.scene import Scene
from .frames import FrameWriter
from .renderer import log, read_frame, slices_of_iteration
from .sessions import SessionStatus

Send = Callable[..., None]
"""send(kind, **content): a message to Blender about this session."""


class Viewing:
    """Renders the newest scene that it was shown, slice by slice, and gives frames out."""

    def __init__(self, context: Context, library: ProgramLibrary, send: Send) -> None:
        self._context = context
        self._library = library
        self._send = send
        self._frames = FrameWriter()
        self._mapper: ProgressivePhotonMapper | None = None
        self._slices: Iterator[None] | None = None
        self._shown: tuple[Scene, int, bool] | None = None
        self._paused = False
        self._status = SessionStatus()

    def show(self, scene: Scene, generation: int, navigating: bool) -> None:
        """Render this scene from now on; what was rendered of another is dropped."""
        self._shown = (scene, generation, navigating)
        self._slices = None

    def pause(self, paused: bool) -> None:
        self._paused = paused

    @property
    def busy(self) -> bool:
        """Whether there is something to render."""
        return self._shown is not None or (self._slices is not None and not self._paused)

    def run_slice(self) -> None:
        """Render a bounded while."""
        if self._shown is not None:
            self._slices = self._render(*self._shown)
            self._shown = None
        try:
            if next(self._slices, self) is self:  # ended
                self._slices = None
        except BrokenPipeError:
            raise
        except Exception as error:
            self._fail(error)

    def _render(self, scene: Scene, generation: int, navigating: bool) -> Iterator[None]:
        started = time.perf_counter()
        if self._mapper is None:
            self._mapper = ProgressivePhotonMapper(self._context, self._library)
        mapper, settings = self._mapper, scene.settings
        mapper.build(scene)
        built = time.perf_counter()
        yield
        while mapper.iteration < settings.iterations:
            for _ in slices_of_iteration(mapper):
                yield
            combined = read_frame(mapper.film, scene.exposure).combined
            slots = self._frames.reserve(combined.shape[0] * combined.shape[1])
            if slots is not None:
                self._send("slots", **slots)
            announcement = self._frames.write(generation, combined)
            self._send("frame", **announcement, progress=mapper.iteration / settings.iterations)
            now = time.perf_counter()
            self._tell(
                SessionStatus(
                    generation=generation,
                    iteration=mapper.iteration,
                    iterations=settings.iterations,
                    photons=mapper.photons_emitted,
                    elapsed_seconds=now - started,
                    radius_metres=mapper.splat_radii[0],
                    memory_bytes=sum(mapper.memory_bytes.values()),
                    iterations_per_second=mapper.iteration / (now - built),
                    photons_per_second=mapper.photons_emitted / (now - built),
                    warnings=scene.warnings,
                    settled=mapper.iteration >= settings.iterations,
                )
            )
            yield

    def _tell(self, status: SessionStatus) -> None:
        self._status = status
        self._send("status", status=vars(status))

    def _fail(self, error: Exception) -> None:
        """Say what is wrong and wait for another scene; what state the mapper is in is unknown."""
        text = str(error)
        if not isinstance(error, RppmError):
            log.exception("a viewport failed")
            text = f"RPPM failed unexpectedly ({type(error).__name__}: {error}); please report what its log says"
        self._release_mapper()
        self._tell(replace(self._status, error=text, settled=True))

    def _release_mapper(self) -> None:
        self._slices = None
        if self._mapper is not None:
            self._mapper.release()
            self._mapper = None

    def unlink(self) -> None:
        """Leave no shared memory behind; for a process that ends at once."""
        self._frames.unlink()

    def release(self) -> None:
        """Give memory and frames back."""
        self._release_mapper()
        self._frames.release()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the photon mapper on a scene and reports how it goes."""

import dataclasses
import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..gl.context import Context, DeviceInformation
from ..gl.programs import ProgramLibrary
from ..integrator.film import Film
from ..integrator.memory import Memory
from ..integrator.progressive import ProgressivePhotonMapper
from ..scene.scene import Scene

log = logging.getLogger(__name__)


@dataclass
class Frame:
    """A picture: arrays with row 0 at the bottom."""

    combined: np.ndarray
    """(height, width, 4) float32 scene-linear Rec.709, premultiplied alpha."""
    depth: np.ndarray
    """(height, width) float32, metres along the view axis; 1e10 where nothing is hit."""
    normal: np.ndarray
    """(height, width, 3) float32 world-space shading normals; 0 where nothing is hit."""
    deep_cubemap: np.ndarray | None = None
    """(height, width, 3) float32: steps, triangle tests and list (scene.settings.CUBEMAP_COSTS); None
    unless the setting deep_cubemap_pass asks for it."""


@dataclass
class Progress:
    """How far a render is."""

    iteration: int
    iterations: int
    elapsed_seconds: float
    photons: int
    time_limit: float = 0.0

    @property
    def fraction(self) -> float:
        """Share done, 0 to 1, of the iterations or of the time limit, whichever is nearer its end."""
        by_iterations = self.iteration / self.iterations
        by_time = self.elapsed_seconds / self.time_limit if self.time_limit > 0 else 0.0
        return min(1.0, max(by_iterations, by_time))


@dataclass
class RenderStatistics:
    """Figures of a finished render."""

    iterations: int
    photons: int
    seconds: float
    build_seconds: float
    device: str
    triangles: int
    radius_metres: float
    stage_seconds: dict[str, float] = field(default_factory=dict)
    memory_bytes: dict[str, int] = field(default_factory=dict)
    flux_watts: dict[str, float] = field(default_factory=dict)
    source_watts: dict[str, float] = field(default_factory=dict)
    """Power by light source, as integrator/sources.py names them; the channels' mean."""
    source_photons: dict[str, int] = field(default_factory=dict)
    """Photons of the last iteration by light source."""
    warnings: list[str] = field(default_factory=list)

    def as_dict(self) -> dict:
        """Plain values for JSON."""
        return dataclasses.asdict(self)


@dataclass
class RenderResult:
    frame: Frame
    statistics: RenderStatistics
    stopped: bool
    """Whether should_stop ended it before its iterations or time limit did."""


def read_frame(film: Film, exposure: float, deep_cubemap: np.ndarray | None = None) -> Frame:
    """The film's current picture."""
    combined = film.read_radiance()
    combined[..., :3] *= exposure
    combined[..., 3] = np.clip(combined[..., 3], 0.0, 1.0)
    normal, depth = film.read_surface()
    return Frame(combined, depth, normal, deep_cubemap)


class Renderer:
    """Owns the GL context and the compiled programs; renders one scene after another."""

    def __init__(self, device: str | None = None) -> None:
        """Open the device (see Context.create). Raises DeviceError."""
        self._context = Context.create(device)
        self._library = ProgramLibrary(self._context)
        self._mapper: ProgressivePhotonMapper | None = None

    @property
    def device(self) -> DeviceInformation:
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
    ) -> RenderResult:
        """Render a scene to its settings' iterations or time limit, whichever comes first.

        ``on_progress`` is called once the structure stands (iteration 0) and after each iteration,
        with a function that reads the current picture; ``should_stop`` is asked as often, and one
        iteration is done in any case so that there is a picture. ``on_snapshot`` gets the picture
        as each of the ascending ``snapshots`` (seconds since the call) has passed. Raises the
        errors of scene/errors.py.
        """
        with self._context.moderngl:  # another context may be current in this thread
            return self._render(scene, on_progress, should_stop, snapshots, on_snapshot)

    def _render(
        self,
        scene: Scene,
        on_progress: Callable[[Progress, Callable[[], Frame]], None] | None,
        should_stop: Callable[[], bool] | None,
        snapshots: Sequence[float],
        on_snapshot: Callable[[float, Frame], None] | None,
    ) -> RenderResult:
        start = time.perf_counter()
        settings = scene.settings
        if self._mapper is None:
            self._mapper = ProgressivePhotonMapper(self._context, self._library)
        mapper = self._mapper
        mapper.timers.reset()
        mapper.build(scene)
        inspection = mapper.inspect_deep_cubemap()[..., :3] if settings.deep_cubemap_pass else None
        pending = list(snapshots)
        stopped = False

        def frame() -> Frame:
            return read_frame(mapper.film, scene.exposure, inspection)

        def elapsed() -> float:
            return time.perf_counter() - start

        def report() -> None:
            if on_progress is not None:
                on_progress(
                    Progress(
                        mapper.iteration, settings.iterations, elapsed(), mapper.photons_emitted, settings.time_limit
                    ),
                    frame,
                )

        report()
        while mapper.iteration < settings.iterations:
            mapper.iterate()
            self._context.finish()
            report()
            while pending and elapsed() >= pending[0]:
                mark = pending.pop(0)
                if on_snapshot is not None:
                    on_snapshot(mark, frame())
            if settings.time_limit > 0 and elapsed() >= settings.time_limit:
                break
            if should_stop is not None and mapper.iteration < settings.iterations and should_stop():
                stopped = True
                break
        seconds = elapsed()
        balance = mapper.flux_balance()
        emitted = max(balance["emitted"], 1e-30)
        warnings = list(scene.warnings)
        if abs(balance["lost"]) > 1e-4 * emitted:
            warnings.append(f"{balance['lost'] / emitted:.2%} of the photons' flux was lost in tracing")
        statistics = RenderStatistics(
            iterations=mapper.iteration,
            photons=mapper.photons_emitted,
            seconds=seconds,
            build_seconds=mapper.build_seconds,
            device=self.device.name,
            triangles=mapper.triangle_count,
            radius_metres=mapper.splat_radii[0],
            stage_seconds=mapper.timers.seconds,
            memory_bytes=mapper.memory_bytes,
            flux_watts=balance,
            source_watts=mapper.source_watts,
            source_photons=mapper.source_photons,
            warnings=warnings,
        )
        return RenderResult(frame(), statistics, stopped)

    def inspect(self, scene: Scene) -> tuple[np.ndarray, dict[str, int], dict[str, int]]:
        """What the camera's rays cost in the scene's deep cubemap, without rendering.

        Returns (height, width, 4) float32 of CUBEMAP_COSTS, the counts of the structure, and
        its bytes by buffer. Raises the errors of scene/errors.py.
        """
        with self._context.moderngl:
            if self._mapper is None:
                self._mapper = ProgressivePhotonMapper(self._context, self._library)
            self._mapper.build_deep_cubemap(scene)
            cubemap = self._mapper.deep_cubemap
            counts = cubemap.counts | {"resolution": cubemap.resolution}
            return self._mapper.inspect_deep_cubemap(), counts, cubemap.memory_bytes

    def memory(self, scene: Scene) -> Memory:
        """Bytes on the device that rendering the scene takes. Raises the errors of scene/errors.py."""
        with self._context.moderngl:
            if self._mapper is None:
                self._mapper = ProgressivePhotonMapper(self._context, self._library)
            self._mapper.build(scene)
            self._mapper.lengthen_lists()
            return self._mapper.memory

    def release(self) -> None:
        """Free the device; the renderer cannot be used afterwards."""
        if self._mapper is not None:
            self._mapper.release()
            self._mapper = None
        self._library.release()
        self._context.release()

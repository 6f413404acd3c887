# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures and statistics of a render, read from its photon mapper."""

import numpy as np

from ...gl.context.context import Context
from ...integrator.progressive import ProgressivePhotonMapper
from ...scene.passes import DEEP_CUBEMAP
from ...scene.scene import Scene
from ..checkpoints.continuation import Pause
from .frame_reading import read_frame
from .render_progress import RenderProgress
from .results import Frame, PhotonStatistics, RenderResult, RenderStatistics, empty_result

_LARGEST_LOSS = 1e-4
"""Fraction of the emitted flux whose loss in tracing becomes a warning."""


class FilmOutput:
    """Reads the film of a render: its frames, results and state."""

    def __init__(
        self, context: Context, mapper: ProgressivePhotonMapper, scene: Scene, progress: RenderProgress
    ) -> None:
        self._context = context
        self._mapper = mapper
        self._scene = scene
        self._progress = progress
        self._inspections: dict[str, np.ndarray] = {}
        """Passes that are computed once."""
        self._held: RenderResult | None = None
        """Result before an iteration that may be given up, which would leave the film unfinished."""

    def inspect(self) -> None:
        """Compute the passes that picture the scene on the device."""
        if DEEP_CUBEMAP.name in self._scene.settings.passes:
            self._inspections = {DEEP_CUBEMAP.name: self._mapper.inspect_deep_cubemap()[..., :3]}

    def hold(self) -> None:
        """Read the result now, and give it out until release()."""
        self._held = self.result(stopped=False)

    def release(self) -> None:
        """Read the film again: its iteration is complete."""
        self._held = None

    def frame(self) -> Frame:
        """Return the picture so far, noisy, with all passes of the film. Raises DeviceLostError."""
        if self._held is not None:
            return self._held.frame
        frame = read_frame(self._mapper.film, self._scene.exposure, self._inspections)
        self._context.finish()  # a lost device would give no picture
        return frame

    def result(self, stopped: bool) -> RenderResult:
        """Return the picture and the statistics; ``stopped``: whether the render ends early at its caller's wish."""
        if self._progress.iterations == 0:
            return empty_result(self._scene, self._context.information.label)
        if self._held is not None:
            statistics = self._held.statistics
            statistics.seconds, statistics.stage_seconds = self._progress.elapsed, self._mapper.timers.seconds
            return RenderResult(self._held.frame, statistics, stopped)
        statistics = self._statistics()
        return RenderResult(self.frame(), statistics, stopped)

    def _statistics(self) -> RenderStatistics:
        mapper, progress = self._mapper, self._progress.record()
        warnings = [*self._scene.warnings, *self._progress.warnings]
        balance = {}
        if self._progress.between_iterations and self._progress.has_iterated:
            balance = mapper.flux_balance()
            emitted = max(balance["emitted"], 1e-30)
            if abs(balance["lost"]) > _LARGEST_LOSS * emitted:
                warnings.append(f"{balance['lost'] / emitted:.2%} of the photons' flux was lost in tracing")
        return RenderStatistics(
            iterations=progress.iteration,
            photons=progress.photons,
            seconds=progress.elapsed_seconds,
            build_seconds=mapper.build_seconds,
            device=self._context.information.label,
            triangles=mapper.triangle_count,
            photon_statistics=PhotonStatistics.of(mapper),
            noise=progress.noise,
            stage_seconds=mapper.timers.seconds,
            memory_bytes=mapper.memory_bytes,
            flux_watts=balance,
            warnings=warnings,
        )

    def pause(self) -> Pause | None:
        """Return the state of the render; None during an iteration and before the first. Raises DeviceLostError."""
        if not self._progress.between_iterations or self._progress.iterations == 0:
            return None
        mapper = self._mapper
        pause = Pause(mapper.state(), self._context.information.label, mapper.splat_radii[0], self._inspections)
        self._context.finish()  # a lost device would give no state
        return pause

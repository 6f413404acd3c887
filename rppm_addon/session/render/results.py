# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of a render: pictures, progress, and figures."""

import dataclasses
from dataclasses import dataclass, field

import numpy as np

from ...scene.common.declared import declared
from ...scene.passes import RenderPass
from ...scene.scene import Scene


@dataclass
class Frame:
    """A picture: arrays with row 0 at the bottom."""

    combined: np.ndarray
    """(height, width, 4) float32 scene-linear Rec.709, premultiplied alpha."""
    passes: dict[str, np.ndarray] = field(default_factory=dict)
    """(height, width) or (height, width, channels) float32 by name (scene/passes.py): those that the settings name."""


@dataclass
class Progress:
    """How far a render is."""

    iteration: int
    iterations: int = field(metadata=declared(minimum=1))
    elapsed_seconds: float
    photons: int
    time_limit: float = 0.0
    expected_iterations: int = 0
    """With which the render is expected to end by its noise; 0 where nothing is known of that."""
    remaining_seconds: float | None = None
    """Until the render is expected to end; None before the first iteration."""
    noise: float = 0.0
    """When it was measured last; 0 before, and without a threshold."""
    noise_threshold: float = 0.0
    """At which the render ends; 0 is none."""
    memory_bytes: int = 0
    """On the device."""

    @property
    def fraction(self) -> float:
        """Share done, 0 to 1, of the iterations or of the time limit, whichever is nearer its end."""
        by_iterations = self.iteration / min(self.iterations, self.expected_iterations or self.iterations)
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
    radius_meters: float
    density_estimation: str = ""
    """The route that was taken, a name of DensityEstimation."""
    first_photon_hits: str = ""
    """The route of the last iteration, a name of FirstPhotonHits."""
    noise: float = 0.0
    """Noise of the noisiest block, in the unit of the noise threshold; 0 where there is none."""
    stage_seconds: dict[str, float] = field(default_factory=dict)
    """Seconds of the device by stage, if the renderer times stages."""
    memory_bytes: dict[str, int] = field(default_factory=dict)
    flux_watts: dict[str, float] = field(default_factory=dict)
    source_watts: dict[str, float] = field(default_factory=dict)
    """Power by light source, as integrator/lights/sources.py names them; the channels' mean."""
    source_photons: dict[str, int] = field(default_factory=dict)
    """Photons of the last iteration by light source."""
    warnings: list[str] = field(default_factory=list)

    def as_dict(self) -> dict:
        """Plain values for JSON."""
        return dataclasses.asdict(self)


@dataclass
class RenderResult:
    """Picture and figures of a render."""

    frame: Frame
    statistics: RenderStatistics
    stopped: bool
    """Whether should_stop ended it before its iterations or time limit did."""


def empty_result(scene: Scene, device: str) -> RenderResult:
    """Return the result of a render that was stopped before there was anything to see."""
    width, height = scene.camera.resolution
    passes = {entry.name: _nothing(entry, height, width) for entry in scene.settings.picture_passes}
    frame = Frame(np.zeros((height, width, 4), np.float32), passes)
    statistics = RenderStatistics(0, 0, 0.0, 0.0, device, scene.triangle_count, 0.0, warnings=list(scene.warnings))
    return RenderResult(frame, statistics, stopped=True)


def _nothing(entry: RenderPass, height: int, width: int) -> np.ndarray:
    shape = (height, width, len(entry.channels)) if len(entry.channels) > 1 else (height, width)
    return np.full(shape, entry.nothing, np.float32)

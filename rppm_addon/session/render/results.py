# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of a render: pictures, progress, and figures."""

import dataclasses
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...scene.common.declared import declared
from ...scene.passes import RenderPass
from ...scene.scene import Scene

if TYPE_CHECKING:
    from ...integrator.progressive import ProgressivePhotonMapper


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
    """Iterations with which the render is expected to end by its noise; 0 where nothing is known of that."""
    remaining_seconds: float | None = None
    """Seconds until the render is expected to end; None before the first iteration."""
    noise: float = 0.0
    """Noise of the noisiest block when it was measured last; 0 before, and without a threshold."""
    noise_threshold: float = 0.0
    """Noise with which the render ends; 0 is none."""
    memory_bytes: int = 0
    """Bytes on the device."""
    build_seconds: float = 0.0
    """Part of elapsed_seconds that passed before the first iteration began."""

    @property
    def fraction(self) -> float:
        """Part done, 0 to 1, of the iterations or of the time limit, whichever is nearer its end."""
        by_iterations = self.iteration / min(self.iterations, self.expected_iterations or self.iterations)
        by_time = self.elapsed_seconds / self.time_limit if self.time_limit > 0 else 0.0
        return min(1.0, max(by_iterations, by_time))

    @property
    def photons_per_iteration(self) -> int:
        """Mean number of photons of an iteration."""
        return self.photons // max(self.iteration, 1)

    @property
    def rendering_seconds(self) -> float:
        """Seconds of the iterations, without export and compilation."""
        return max(self.elapsed_seconds - self.build_seconds, 1e-9)

    @property
    def iterations_per_second(self) -> float:
        """Rate while rendering; 0 before the first iteration."""
        return self.iteration / self.rendering_seconds

    @property
    def photons_per_second(self) -> float:
        """Rate while rendering; 0 before the first iteration."""
        return self.photons / self.rendering_seconds


@dataclass(frozen=True)
class PhotonStatistics:
    """Radius, routes and light sources of the photons of an iteration."""

    radius_meters: float = 0.0
    """r_max of the iteration."""
    density_estimation: str = ""
    """The route that was taken, a name of DensityEstimation; empty before the first iteration."""
    first_photon_hits: str = ""
    """The route that was taken, a name of FirstPhotonHits; empty before the first iteration."""
    source_watts: dict[str, float] = field(default_factory=dict)
    """Power by light source, as integrator/lights/sources.py names them; the channels' mean."""
    source_photons: dict[str, int] = field(default_factory=dict)
    """Photons by light source."""

    @classmethod
    def of(cls, mapper: "ProgressivePhotonMapper") -> "PhotonStatistics":
        """Statistics of the last iteration of a photon mapper."""
        return cls(
            mapper.splat_radii[0],
            mapper.density_estimation.name,
            mapper.first_photon_hits.name,
            mapper.source_watts,
            mapper.source_photons,
        )


@dataclass
class RenderStatistics:
    """Figures of a finished render."""

    iterations: int
    photons: int
    seconds: float
    build_seconds: float
    device: str
    triangles: int
    photon_statistics: PhotonStatistics = field(default_factory=PhotonStatistics)
    """Statistics of the last iteration."""
    noise: float = 0.0
    """Noise of the noisiest block, in the unit of the noise threshold; 0 where there is none."""
    stage_seconds: dict[str, float] = field(default_factory=dict)
    """Seconds of the device by stage, if the renderer times stages."""
    memory_bytes: dict[str, int] = field(default_factory=dict)
    flux_watts: dict[str, float] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)

    def as_dict(self) -> dict:
        """Plain values for JSON, those of the photons beside the others."""
        values = dataclasses.asdict(self)
        photons = values.pop("photon_statistics")
        return {**values, **photons}


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
    statistics = RenderStatistics(0, 0, 0.0, 0.0, device, scene.triangle_count, warnings=list(scene.warnings))
    return RenderResult(frame, statistics, stopped=True)


def _nothing(entry: RenderPass, height: int, width: int) -> np.ndarray:
    shape = (height, width, len(entry.channels)) if len(entry.channels) > 1 else (height, width)
    return np.full(shape, entry.nothing, np.float32)

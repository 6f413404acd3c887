# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render gives: pictures, how far it is, and figures."""

import dataclasses
from dataclasses import dataclass, field

import numpy as np

from ..scene.scene import Scene

NOTHING_HIT = 1e10
"""Depth where nothing is hit, as Cycles writes it."""


@dataclass
class Frame:
    """A picture: arrays with row 0 at the bottom."""

    combined: np.ndarray
    """(height, width, 4) float32 scene-linear Rec.709, premultiplied alpha."""
    depth: np.ndarray
    """(height, width) float32, metres along the view axis; NOTHING_HIT where nothing is."""
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
    density_estimation: str = ""
    """The route that was taken, a name of DensityEstimation."""
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


def empty_result(scene: Scene, device: str) -> RenderResult:
    """What a render gives that was stopped before there was anything to see."""
    width, height = scene.camera.resolution
    frame = Frame(
        np.zeros((height, width, 4), np.float32),
        np.full((height, width), NOTHING_HIT, np.float32),
        np.zeros((height, width, 3), np.float32),
        np.zeros((height, width, 3), np.float32) if scene.settings.deep_cubemap_pass else None,
    )
    statistics = RenderStatistics(0, 0, 0.0, 0.0, device, scene.triangle_count, 0.0, warnings=list(scene.warnings))
    return RenderResult(frame, statistics, stopped=True)


def frame_arrays(frame: Frame) -> list[np.ndarray]:
    """The pictures that a frame has, in the order of its fields, so that Frame(*frame_arrays(frame)) is the same."""
    return [frame.combined, frame.depth, frame.normal, *([] if frame.deep_cubemap is None else [frame.deep_cubemap])]

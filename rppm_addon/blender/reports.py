# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of the last renders of each scene, for the panels; kept while Blender runs, never saved."""

import enum
import threading
from dataclasses import dataclass, field, replace

from ..scene import RenderSettings, Scene
from ..session.transport.sessions import SessionStatus

FINALS_KEPT = 5
"""Final renders of a scene, to compare."""
SCENES_KEPT = 16
"""Scenes that were rendered last; older ones are forgotten."""
WARNINGS_KEPT = 200
"""Warnings of a render; the log has them all."""


class RenderKind(enum.Enum):
    """Kind of render that a report is about."""

    FINAL = "Final"
    VIEWPORT = "Viewport"


@dataclass(frozen=True)
class RenderReport:
    """Figures of a render, finished or, in a viewport, so far."""

    kind: RenderKind
    width: int
    height: int
    settings: RenderSettings
    """Settings with which the scene was rendered."""
    iterations: int
    photons: int
    """Emitted in all iterations."""
    seconds: float
    """Since the render began, building included."""
    radius_meters: float
    """r_max of the last iteration."""
    memory_bytes: int
    """On the device."""
    build_seconds: float = 0.0
    device: str = ""
    triangles: int = 0
    source_watts: dict[str, float] = field(default_factory=dict)
    """Power by light source, as integrator/lights/sources.py names them."""
    source_photons: dict[str, int] = field(default_factory=dict)
    """Photons of the last iteration by light source."""
    density_estimation: str = ""
    """The route that was taken, a name of DensityEstimation; empty before the first iteration."""
    first_photon_hits: str = ""
    """The route of the last iteration, a name of FirstPhotonHits; empty before the first."""
    noise: float = 0.0
    """When it was measured last, in the unit of the noise threshold; 0 without one."""
    warnings: tuple[str, ...] = ()
    warning_count: int = 0
    """All of them, where ``warnings`` was cut short."""

    @property
    def photons_per_iteration(self) -> int:
        """Photons of each iteration; all iterations have equally many."""
        return self.photons // max(self.iterations, 1)

    @property
    def rendering_seconds(self) -> float:
        """Without export and compilation."""
        return max(self.seconds - self.build_seconds, 1e-9)

    @property
    def iterations_per_second(self) -> float:
        """While rendering; 0 before the first."""
        return self.iterations / self.rendering_seconds

    @property
    def photons_per_second(self) -> float:
        """While rendering; 0 before the first iteration."""
        return self.photons / self.rendering_seconds


def viewport_report(status: SessionStatus, scene: Scene) -> RenderReport:
    """Return the report, so far, of a viewport that shows a scene."""
    width, height = scene.camera.resolution
    rendering = status.iteration / status.iterations_per_second if status.iterations_per_second > 0.0 else 0.0
    return RenderReport(
        RenderKind.VIEWPORT,
        width,
        height,
        scene.settings,
        status.iteration,
        status.photons,
        status.elapsed_seconds,
        status.radius_meters,
        status.memory_bytes,
        build_seconds=max(0.0, status.elapsed_seconds - rendering),
        triangles=scene.triangle_count,
        source_watts=status.source_watts,
        source_photons=status.source_photons,
        density_estimation=status.density_estimation,
        first_photon_hits=status.first_photon_hits,
        noise=status.noise,
        warnings=tuple(status.warnings),
    )


@dataclass(frozen=True)
class SceneReports:
    """All that is kept of a scene; replaced as a whole, so that a panel reads it while a render records."""

    finals: tuple[RenderReport, ...] = ()
    """The newest first."""
    viewport: RenderReport | None = None
    latest: RenderReport | None = None
    error: str = ""
    """Why the last final render gave no picture."""
    viewport_error: str = ""
    """Why viewports cannot show the scene as it is now."""


_EMPTY = SceneReports()
_reports: dict[int, SceneReports] = {}
_lock = threading.Lock()


def record(scene_uid: int, report: RenderReport) -> None:
    """Keep a report for the scene of that session_uid; a viewport's replaces its last one. From any thread."""
    report = replace(
        report,
        warnings=tuple(report.warnings[:WARNINGS_KEPT]),
        warning_count=max(report.warning_count, len(report.warnings)),
    )
    with _lock:
        known = _reports.get(scene_uid, _EMPTY)
        if report.kind is RenderKind.FINAL:
            known = replace(known, finals=(report, *known.finals)[:FINALS_KEPT], error="")
        else:
            known = replace(known, viewport=report)
        _keep(scene_uid, replace(known, latest=report))


def record_error(scene_uid: int, text: str) -> None:
    """Keep why a final render failed until one succeeds."""
    with _lock:
        _keep(scene_uid, replace(_reports.get(scene_uid, _EMPTY), error=text))


def record_viewport_error(scene_uid: int, text: str) -> None:
    """Keep why viewports cannot show a scene; "" once they can."""
    with _lock:
        _keep(scene_uid, replace(_reports.get(scene_uid, _EMPTY), viewport_error=text))


def _keep(scene_uid: int, kept: SceneReports) -> None:
    _reports.pop(scene_uid, None)
    _reports[scene_uid] = kept
    while len(_reports) > SCENES_KEPT:
        del _reports[next(iter(_reports))]


def reports_of(scene_uid: int) -> SceneReports:
    """Return the reports that are kept of a scene; empty before its first render."""
    return _reports.get(scene_uid, _EMPTY)


def forget() -> None:
    """Forget all scenes."""
    with _lock:
        _reports.clear()

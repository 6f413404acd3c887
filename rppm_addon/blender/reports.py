# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of the last renders of each scene, for the panels; kept while Blender runs, never saved."""

import enum
import threading
from dataclasses import dataclass, field, replace

from ..scene import RenderSettings, Scene
from ..session.render.results import PhotonStatistics, Progress, RenderStatistics
from ..session.transport.sessions import SessionStatus

FINALS_KEPT = 5
"""Number of final renders that are kept of a scene, to compare."""
SCENES_KEPT = 16
"""Number of scenes with reports, those that were rendered last."""
WARNINGS_KEPT = 200
"""Number of warnings that are kept of a render; the log has all."""


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
    """Pixels."""
    settings: RenderSettings
    """Settings with which the scene was rendered."""
    progress: Progress
    photon_statistics: PhotonStatistics = field(default_factory=PhotonStatistics)
    """Statistics of the last iteration."""
    device: str = ""
    triangles: int = 0
    warnings: tuple[str, ...] = ()
    warning_count: int = 0
    """Number of all warnings, where ``warnings`` was cut short."""


def viewport_report(status: SessionStatus, scene: Scene) -> RenderReport:
    """Return the report, so far, of a viewport that shows a scene."""
    width, height = scene.camera.resolution
    return RenderReport(
        RenderKind.VIEWPORT,
        width,
        height,
        scene.settings,
        status.progress or Progress(0, scene.settings.iterations, 0.0, photons=0),
        status.photon_statistics,
        triangles=scene.triangle_count,
        warnings=tuple(status.warnings),
    )


def final_report(statistics: RenderStatistics, scene: Scene) -> RenderReport:
    """Return the report of a final render."""
    width, height = scene.camera.resolution
    progress = Progress(
        statistics.iterations,
        scene.settings.iterations,
        statistics.seconds,
        statistics.photons,
        noise=statistics.noise,
        noise_threshold=scene.settings.adaptive_threshold,
        memory_bytes=sum(statistics.memory_bytes.values()),
        build_seconds=statistics.build_seconds,
    )
    return RenderReport(
        RenderKind.FINAL,
        width,
        height,
        scene.settings,
        progress,
        statistics.photon_statistics,
        statistics.device,
        statistics.triangles,
        tuple(statistics.warnings),
    )


@dataclass(frozen=True)
class SceneReports:
    """Reports of a scene. They are replaced as a whole, so that panels read them while a render records."""

    finals: tuple[RenderReport, ...] = ()
    """Final renders, the newest first."""
    viewport: RenderReport | None = None
    latest: RenderReport | None = None
    error: str = ""
    """Reason why the last final render has no picture; empty if it has one."""
    viewport_error: str = ""
    """Reason why viewports cannot show the scene as it is now; empty if they can."""


_EMPTY = SceneReports()
_reports: dict[int, SceneReports] = {}
_lock = threading.Lock()


def record(scene_uid: int, report: RenderReport) -> None:
    """Keep a report of the scene with this session_uid; a viewport's replaces its last one. Any thread may call it."""
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
    """Keep why a final render has failed, until one succeeds."""
    with _lock:
        _keep(scene_uid, replace(_reports.get(scene_uid, _EMPTY), error=text))


def record_viewport_error(scene_uid: int, text: str) -> None:
    """Keep why viewports cannot show a scene; "" if they can."""
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

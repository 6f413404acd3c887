# SPDX-License-Identifier: GPL-3.0-or-later
"""The line over a rendered viewport, and what panels learn of it."""

from types import SimpleNamespace

import pytest
from blender_scenes import CAMERA
from drawing import preferences_context

from rppm_addon.blender import reports
from rppm_addon.blender.engine import viewport_status
from rppm_addon.blender.engine.viewport_status import ViewportStatus, status_text
from rppm_addon.blender.export import ExportProgress
from rppm_addon.scene import Scene
from rppm_addon.session.client.client import ProcessState
from rppm_addon.session.render.results import PhotonStatistics, Progress
from rppm_addon.session.transport.sessions import CompilationProgress, SessionStatus

PHOTONS = PhotonStatistics(0.01)
PROGRESS = Progress(3, 8, 4.0, 3000, noise=0.5, noise_threshold=0.1, build_seconds=1.0)
UNDER_WAY = SessionStatus(1, progress=PROGRESS, photon_statistics=PHOTONS)


@pytest.mark.parametrize(
    ("status", "is_paused", "letters", "text"),
    [
        (SessionStatus(), False, 99, "Compiling shaders and building the scene"),
        (SessionStatus(compilation=CompilationProgress(0.254)), False, 99, "Compiling shaders: 25%"),
        (UNDER_WAY, False, 99, "Sample 3/8 | 1.00 k photons/s | Noise 0.5 of 0.1 | Radius 1 cm"),
        (UNDER_WAY, False, 40, "Sample 3/8 | 1.00 k photons/s"),
        (UNDER_WAY, False, 1, "Sample 3/8"),
        (UNDER_WAY, True, 22, "Sample 3/8 | Paused"),
        (SessionStatus(progress=Progress(8, 8, 4.0, 8000), settled=True), False, 25, "Sample 8/8 | Finished"),
        (
            SessionStatus(compilation=CompilationProgress(stood_in_for=2), progress=PROGRESS),
            False,
            40,
            "Sample 3/8 | Materials to compile: 2",
        ),
    ],
)
def test_the_line_says_what_fits(status, is_paused, letters, text):
    assert status_text(status, is_paused, "1 cm", letters) == text


@pytest.fixture
def shown(scene, monkeypatch):
    lines, process = [], SimpleNamespace(state=ProcessState.RUNNING, error="")
    lines, process = [], SimpleNamespace(state=ProcessState.RUNNING, error="")
    monkeypatch.setattr(viewport_status, "renderer_process", lambda: process)
    monkeypatch.setattr(viewport_status, "failure", lambda: process.error)
    engine = SimpleNamespace(update_stats=lambda _, text: lines.append(text))
    context = preferences_context()
    context.scene, context.region.width = scene, 2000
    shown = ViewportStatus(engine)

    def show(status=UNDER_WAY, error="", export=None):
        shown.show(context, status, error, export)
        return lines[-1]

    return SimpleNamespace(show=show, report=lambda *found: shown.report(context, *found), process=process)


def test_an_error_takes_the_place_of_all_else_until_it_is_gone(shown, scene):
    assert shown.show(error="no lights") == "no lights"
    assert reports.reports_of(scene.session_uid).viewport_error == "no lights"
    assert shown.show(SessionStatus(error="no memory")) == "no memory"
    assert shown.show().startswith("Sample 3/8")
    assert reports.reports_of(scene.session_uid).viewport_error == ""


def test_what_the_process_and_the_export_are_at(shown):
    assert shown.show(export=ExportProgress(2, 5)) == "Exporting: 40%"
    assert shown.show(export=ExportProgress()) == "Exporting"
    shown.process.state = ProcessState.STARTING
    assert shown.show() == "Starting the renderer"
    shown.process.state = ProcessState.FAILED
    assert shown.show() == "The renderer has stopped: Restart is in the header"


def test_each_iteration_is_reported_once(shown, scene):
    exported = Scene(CAMERA)
    shown.report(SessionStatus(), exported)
    assert reports.reports_of(scene.session_uid).viewport is None
    shown.report(UNDER_WAY, exported)
    first = reports.reports_of(scene.session_uid).viewport
    assert first.progress == PROGRESS and first.photon_statistics == PHOTONS
    shown.report(UNDER_WAY, exported)
    assert reports.reports_of(scene.session_uid).viewport is first

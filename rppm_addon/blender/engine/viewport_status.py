# SPDX-License-Identifier: GPL-3.0-or-later
"""The status of a viewport: the text over it, and the report that panels show."""

import time

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...scene import Scene
from ...scene.common.quantities import noise_text, rate_text
from ...session.client.client import ProcessState
from ...session.transport.sessions import SessionStatus
from .. import panels, reports
from ..export import ExportProgress
from ..panels.base import length_text, letters_across
from ..render_client.renderer_process import failure, renderer_process

REDRAW_SECONDS = 1.0
"""Time between two drawings of the panels while a viewport renders, which take Blender's time as well."""


class ViewportStatus:
    """Shows the status of a viewport's session to the user."""

    def __init__(self, engine: bpy.types.RenderEngine) -> None:
        self._engine = engine
        self._error: str | None = None
        """Error that panels show; None makes them forget the error of the previous viewport."""
        self._reported: SessionStatus | None = None
        """Status of the last report."""
        self._redrawn_at = 0.0

    def show(
        self, context: bpy.types.Context, status: SessionStatus, export_error: str, export: ExportProgress | None
    ) -> None:
        """Show the status over the viewport, and its error in panels.

        Args:
            context: context of the viewport.
            status: status of the session.
            export_error: why the scene could not be exported; empty if it could.
            export: progress of the export; None when there is none.
        """
        process = renderer_process()
        is_starting = process.state is ProcessState.STARTING
        error = export_error or ("" if is_starting else failure() or status.error)
        if process.state is ProcessState.FAILED:
            text = iface_("The renderer has stopped: Restart is in the header")
        elif error:
            text = error
        elif export is not None:
            share = iface_("Exporting: {:.0%}").format(export.objects / export.of) if export.of else ""
            text = share or iface_("Exporting")
        elif is_starting:
            text = iface_("Starting the renderer")
        else:
            radius = length_text(context.scene, status.photon_statistics.radius_meters)
            text = status_text(status, context.scene.rppm.preview_pause, radius, letters_across(context))
        self._engine.update_stats("", text)
        if error != self._error:
            self._error = error
            reports.record_viewport_error(context.scene.session_uid, error)
            panels.redraw()

    def report(self, context: bpy.types.Context, status: SessionStatus, scene: Scene) -> None:
        """Record a report for the panels, once for each iteration."""
        if status.iteration == 0 or status == self._reported:
            return
        self._reported = status
        reports.record(context.scene.session_uid, reports.viewport_report(status, scene))
        now = time.monotonic()
        if status.settled or now - self._redrawn_at >= REDRAW_SECONDS:
            self._redrawn_at = now
            panels.redraw()


def status_text(status: SessionStatus, is_paused: bool, radius: str, letters: int) -> str:
    """Return the line over a viewport that is rendered.

    Args:
        status: status of the session.
        is_paused: whether the viewport is paused.
        radius: radius of the sample, with its unit.
        letters: number of letters that fit; the line has fewer parts where it would be longer.
    """
    progress, compilation = status.progress, status.compilation
    if progress is None and compilation.fraction is not None:
        return iface_("Compiling shaders: {:.0%}").format(compilation.fraction)
    if progress is None:
        return iface_("Compiling shaders and building the scene")
    if is_paused or status.settled:
        state = iface_("Paused") if is_paused else iface_("Finished")
    else:
        state = iface_("{} photons/s").format(rate_text(progress.photons_per_second))
    parts = [iface_("Sample {}/{}").format(progress.iteration, progress.iterations), state]
    if progress.noise > 0.0:
        parts.append(iface_("Noise {}").format(noise_text(progress.noise, progress.noise_threshold)))
    parts.append(iface_("Radius {}").format(radius))
    if compilation.stood_in_for:
        parts.insert(1, iface_("Materials to compile: {}").format(compilation.stood_in_for))
    while len(parts) > 1 and len(" | ".join(parts)) > letters:
        parts.pop()
    return " | ".join(parts)

# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM's part of the header of a rendered viewport: pause, warnings, and restarting a renderer that has stopped."""

import bpy

from ..render_client.renderer_process import failure
from ..reports import reports_of
from .base import ENGINE, restart_button


def draw_header(self: bpy.types.Header, context: bpy.types.Context) -> None:
    """Show whether rendered viewports are paused and what they warn of, and let them go on."""
    space = context.space_data
    if context.engine != ENGINE or space.type != "VIEW_3D" or space.shading.type != "RENDERED":
        return
    settings, layout = context.scene.rppm, self.layout
    layout.prop(settings, "preview_pause", text="", icon="PLAY" if settings.preview_pause else "PAUSE")
    if failure():
        restart_button(layout)
    reports = reports_of(context.scene.session_uid)
    count = 0 if reports.viewport is None else reports.viewport.warning_count
    error = failure() or reports.viewport_error
    if error or count:
        icon = "CANCEL" if error else "ERROR"
        layout.popover("RPPM_PT_viewport_warnings", text=str(count) if count else "", icon=icon)


def register() -> None:
    """Add to the header."""
    bpy.types.VIEW3D_HT_header.append(draw_header)


def unregister() -> None:
    """Take it out of the header."""
    bpy.types.VIEW3D_HT_header.remove(draw_header)

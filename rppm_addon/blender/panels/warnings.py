# SPDX-License-Identifier: GPL-3.0-or-later
"""Warnings of the last render: a panel of the render tab, and a popover of the viewport's header."""

import textwrap
import zlib

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ..render_client.renderer_process import failure
from ..reports import RenderReport, reports_of
from ..subjects import SubjectKind
from ..warning_groups import WarnedThing, WarningGroup, grouped
from .base import EnginePanel, RppmPanel, letters_across, paragraph, restart_button

GROUPS_SHOWN = 20
THINGS_SHOWN = 16
"""Things of one group."""
LETTERS_OF_POPOVER = 44
LINES_OF_POPOVER = 12
"""Lines of an error, and of the warnings: a popover does not scroll, and is to stay on the screen."""
_ICONS = {SubjectKind.OBJECT: "OBJECT_DATA", SubjectKind.MATERIAL: "MATERIAL", SubjectKind.WORLD: "WORLD"}


class RPPM_PT_warnings(RppmPanel, bpy.types.Panel):
    bl_label = "Warnings"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        latest = reports_of(context.scene.session_uid).latest
        return latest is not None and latest.warning_count > 0

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        count = reports_of(context.scene.session_uid).latest.warning_count
        self.layout.label(text=f"{count} ", translate=False)

    def draw(self, context: bpy.types.Context) -> None:
        report, letters = reports_of(context.scene.session_uid).latest, letters_across(context)
        groups = grouped(report.warnings)
        for group in groups[:GROUPS_SHOWN]:
            header, body = self.layout.panel(f"rppm_{zlib.crc32(group.identifier.encode()):08x}", default_closed=True)
            header.label(text=group.title, icon="ERROR", translate=False)
            if body is not None:
                _draw_group(body, group, letters)
        listed = sum(group.count for group in groups[:GROUPS_SHOWN])
        if listed < report.warning_count:
            text = iface_("{} more are in the log").format(report.warning_count - listed)
            self.layout.label(text=text, icon="INFO", translate=False)


def _draw_group(layout: bpy.types.UILayout, group: WarningGroup, letters: int) -> None:
    paragraph(layout, group.sentence[:1].upper() + group.sentence[1:], letters)
    if group.operator:
        layout.operator(group.operator)
    column = layout.column(align=True)
    for thing in group.things[:THINGS_SHOWN]:
        row = column.row()
        icon = _ICONS[thing.kind] if thing.kind is not None else "NONE"
        row.label(text=thing.label, icon=icon, translate=False)
        _draw_select(row, thing)
    if len(group.things) > THINGS_SHOWN:
        column.label(text=iface_("and {} more").format(len(group.things) - THINGS_SHOWN), translate=False)


def _draw_select(row: bpy.types.UILayout, thing: WarnedThing) -> None:
    if thing.kind is not None:
        button = row.operator("rppm.select_subject", text="", icon="RESTRICT_SELECT_OFF")
        button.kind, button.name, button.node = thing.kind.name, thing.name, thing.node


class RPPM_PT_viewport_warnings(EnginePanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_label = "Warnings"
    bl_ui_units_x = 16

    def draw(self, context: bpy.types.Context) -> None:
        reports, layout = reports_of(context.scene.session_uid), self.layout
        if failure():
            restart_button(layout)
        error = failure() or reports.viewport_error
        if error:
            paragraph(layout, error, LETTERS_OF_POPOVER, icon="ERROR", most_lines=LINES_OF_POPOVER)
        if reports.viewport is not None:
            _draw_titles(layout, reports.viewport)


def _draw_titles(layout: bpy.types.UILayout, report: RenderReport) -> None:
    """Draw a line for each group, with the button that selects the first thing."""
    groups = grouped(report.warnings)
    column = layout.column(align=True)
    for group in groups[:LINES_OF_POPOVER]:
        row = column.row()
        title = textwrap.shorten(group.title, LETTERS_OF_POPOVER, placeholder="...")
        row.label(text=title, icon="ERROR", translate=False)
        for thing in group.things[:1]:
            _draw_select(row, thing)
    more = len(groups) - LINES_OF_POPOVER
    if groups:
        template = (
            "Names are in the render tab: Warnings"
            if more <= 0
            else "{} more, and names, are in the render tab: Warnings"
        )
        layout.label(text=iface_(template).format(more), icon="INFO", translate=False)


CLASSES = (RPPM_PT_warnings, RPPM_PT_viewport_warnings)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Warnings of the last render: a panel of the render tab, and a popover of the viewport's header."""

import bpy

from ..render_client.renderer_process import failure
from ..reports import RenderReport, reports_of
from ..subjects import Subject, SubjectKind, subjects
from .base import EnginePanel, RppmPanel, letters_across, paragraph, restart_button

SUBJECTS_SHOWN = 20
TEXTS_SHOWN = 4
"""Warnings of one object or material."""
_ICONS = {SubjectKind.OBJECT: "OBJECT_DATA", SubjectKind.MATERIAL: "MATERIAL", SubjectKind.WORLD: "WORLD"}


class RPPM_PT_warnings(RppmPanel, bpy.types.Panel):
    bl_label = "Warnings"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        latest = reports_of(context.scene.session_uid).latest
        return latest is not None and latest.warning_count > 0

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        self.layout.label(text=f"{reports_of(context.scene.session_uid).latest.warning_count} ")

    def draw(self, context: bpy.types.Context) -> None:
        _draw_warnings(self.layout, reports_of(context.scene.session_uid).latest, letters_across(context))


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
            paragraph(layout, error, LETTERS_OF_POPOVER, icon="ERROR")
        if reports.viewport is not None:
            _draw_warnings(layout, reports.viewport, LETTERS_OF_POPOVER)


LETTERS_OF_POPOVER = 44


def _draw_warnings(layout: bpy.types.UILayout, report: RenderReport, letters: int) -> None:
    found = subjects(report.warnings)
    for subject in found[:SUBJECTS_SHOWN]:
        _draw_subject(layout.box(), subject, letters)
    listed = sum(min(len(subject.texts), TEXTS_SHOWN) for subject in found[:SUBJECTS_SHOWN])
    if listed < report.warning_count:
        layout.label(text=f"{report.warning_count - listed} more are in the log", icon="INFO")


def _draw_subject(box: bpy.types.UILayout, subject: Subject, letters: int) -> None:
    if subject.kind is not None:
        row = box.row()
        row.label(text=f"{subject.name} ({len(subject.texts)})", icon=_ICONS[subject.kind])
        button = row.operator("rppm.select_subject", text="", icon="RESTRICT_SELECT_OFF")
        button.kind, button.name, button.node = subject.kind.name, subject.name, subject.node
    for text in subject.texts[:TEXTS_SHOWN]:
        paragraph(box, text, letters)


CLASSES = (RPPM_PT_warnings, RPPM_PT_viewport_warnings)

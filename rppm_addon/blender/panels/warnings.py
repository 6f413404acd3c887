# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel that lists what the last render warned of."""

import bpy

from ..reports import reports_of
from ..subjects import Subject, SubjectKind, subjects
from .base import RppmPanel, paragraph

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
        reports = reports_of(context.scene.session_uid)
        return bool(reports.error or (reports.latest is not None and reports.latest.warnings))

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        report = reports_of(context.scene.session_uid).latest
        self.layout.label(text=f"{0 if report is None else report.warning_count} ")

    def draw(self, context: bpy.types.Context) -> None:
        reports = reports_of(context.scene.session_uid)
        if reports.error:
            paragraph(self.layout, reports.error, context, icon="ERROR")
        if reports.latest is None:
            return
        found = subjects(reports.latest.warnings)
        for subject in found[:SUBJECTS_SHOWN]:
            self._draw_subject(subject, context)
        listed = sum(min(len(subject.texts), TEXTS_SHOWN) for subject in found[:SUBJECTS_SHOWN])
        if listed < reports.latest.warning_count:
            self.layout.label(text=f"{reports.latest.warning_count - listed} more are in the log", icon="INFO")

    def _draw_subject(self, subject: Subject, context: bpy.types.Context) -> None:
        box = self.layout.box()
        if subject.kind is not None:
            row = box.row()
            row.label(text=f"{subject.name} ({len(subject.texts)})", icon=_ICONS[subject.kind])
            button = row.operator("rppm.select_subject", text="", icon="RESTRICT_SELECT_OFF")
            button.kind, button.name, button.node = subject.kind.name, subject.name, subject.node
        for text in subject.texts[:TEXTS_SHOWN]:
            paragraph(box, text, context)


CLASSES = (RPPM_PT_warnings,)

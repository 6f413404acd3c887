# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab on memory, rates and the last renders."""

import bpy

from ...scene.quantities import bytes_text, count_text, rate_text, seconds_text
from ..export.settings import export_settings
from ..readings import memory_reading
from ..reports import RenderReport, reports_of
from .base import RppmPanel, reading, rendered_size


class RPPM_PT_performance(RppmPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        scene = context.scene
        column = self.column()
        reports = reports_of(scene.session_uid)
        last = reports.finals[0] if reports.finals else None
        settings = export_settings(scene, context.view_layer)
        memory = memory_reading(settings, *rendered_size(scene.render), last)
        photons = memory.by_settings.ppm.get("photons", 0)
        reading(column, "Photons", bytes_text(photons))
        reading(column, "Picture and Paths", bytes_text(memory.by_settings.total_bytes - photons))
        if memory.scene_bytes is None:
            reading(column, "Scene", "known once it was rendered")
        else:
            reading(column, "Scene", bytes_text(memory.scene_bytes))
        reading(column, "Expected Memory", bytes_text(memory.total_bytes))


class RPPM_PT_deep_cubemap(RppmPanel, bpy.types.Panel):
    bl_label = "Deep Cubemap"
    bl_parent_id = "RPPM_PT_performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.rppm
        column = self.column()
        column.prop(settings, "cubemap_resolution", text="Resolution")
        column.prop(settings, "cubemap_center_object", text="Center")


class RPPM_PT_status(RppmPanel, bpy.types.Panel):
    bl_label = "Status"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and reports_of(context.scene.session_uid).latest is not None

    def draw(self, context: bpy.types.Context) -> None:
        reports = reports_of(context.scene.session_uid)
        for report in (reports.viewport, reports.finals[0] if reports.finals else None):
            if report is not None:
                self.layout.label(text=report.kind.value)
                _show(self.column(), report, context.scene)


def _show(column: bpy.types.UILayout, report: RenderReport, scene: bpy.types.Scene) -> None:
    reading(column, "Samples", f"{report.iterations} of {report.settings.iterations}")
    reading(column, "Photons", f"{count_text(report.photons_per_iteration)} a sample")
    radius = bpy.utils.units.to_string(scene.unit_settings.system, "LENGTH", report.radius_meters, precision=4)
    reading(column, "Largest Radius", radius)
    reading(column, "Memory", bytes_text(report.memory_bytes))
    rates = f"{rate_text(report.iterations_per_second)} samples, {rate_text(report.photons_per_second)} photons"
    reading(column, "Per Second", rates)
    reading(column, "Time", f"{seconds_text(report.seconds)}, {seconds_text(report.build_seconds)} of it building")
    if report.density_estimation:
        routes = scene.rppm.bl_rna.properties["density_estimation"].enum_items
        reading(column, "Density Estimation", routes[report.density_estimation].name)
    if report.device:
        reading(column, "Device", report.device)


class RPPM_PT_last_renders(RppmPanel, bpy.types.Panel):
    bl_label = "Last Renders"
    bl_parent_id = "RPPM_PT_performance"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(reports_of(context.scene.session_uid).finals)

    def draw(self, context: bpy.types.Context) -> None:
        finals = reports_of(context.scene.session_uid).finals
        table = self.layout.column(align=True)
        for name, text in _COMPARED:
            row = table.row(align=True)
            row.label(text=name)
            for report in finals:
                row.label(text=text(report))


_COMPARED = (
    ("Resolution", lambda report: f"{report.width} x {report.height}"),
    ("Samples", lambda report: str(report.iterations)),
    ("Photons", lambda report: count_text(report.photons)),
    ("Time", lambda report: seconds_text(report.seconds)),
    ("Building", lambda report: seconds_text(report.build_seconds)),
    ("Photons/s", lambda report: rate_text(report.photons_per_second)),
    ("Samples/s", lambda report: rate_text(report.iterations_per_second)),
    ("Memory", lambda report: bytes_text(report.memory_bytes)),
    ("Triangles", lambda report: count_text(report.triangles)),
    ("Warnings", lambda report: str(report.warning_count)),
)
"""Lines of the table and what they say of a render, the newest on the left."""


STATUS = (RPPM_PT_status,)
CLASSES = (RPPM_PT_performance, RPPM_PT_deep_cubemap, RPPM_PT_last_renders)

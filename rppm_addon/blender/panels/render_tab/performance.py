# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab on memory, how renders get on, and diagnostics."""

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ....scene.common.quantities import bytes_text, count_text, noise_text, rate_text, seconds_text
from ....scene.settings import AccelerationStructure
from ...export.view_layer.settings import export_settings
from ...readings import memory_reading
from ...render_client.renderer_process import failure
from ...reports import RenderReport, reports_of
from ..base import RppmPanel, length_text, letters_across, paragraph, reading, rendered_size, restart_button
from ..switches import draw_setting


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
        reading(column, "Picture", bytes_text(memory.by_settings.total_bytes - photons))
        if memory.scene_bytes is None:
            reading(column, "Scene", iface_("once rendered"))
        else:
            reading(column, "Scene", bytes_text(memory.scene_bytes))
        reading(column, "Expected", bytes_text(memory.total_bytes))


class RPPM_PT_performance_final(RppmPanel, bpy.types.Panel):
    bl_label = "Final Render"
    bl_parent_id = "RPPM_PT_performance"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.scene.render, "use_persistent_data", text="Persistent Data")
        column.prop(context.scene.rppm, "checkpoint_path")


class RPPM_PT_performance_viewport(RppmPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "RPPM_PT_performance"

    def draw(self, context: bpy.types.Context) -> None:
        self.column().prop(context.scene.render, "preview_pixel_size", text="Pixel Size")


class RPPM_PT_diagnostics(RppmPanel, bpy.types.Panel):
    bl_label = "Diagnostics"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """All is in the panels inside."""


class RPPM_PT_acceleration_structure(RppmPanel, bpy.types.Panel):
    bl_label = "Acceleration Structure"
    bl_parent_id = "RPPM_PT_diagnostics"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.prop(context.scene.rppm, "acceleration_structure", text="Structure")
        column.prop(context.scene.rppm, "instancing", text="Instances")


class RPPM_PT_status(RppmPanel, bpy.types.Panel):
    bl_label = "Status"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        reports = reports_of(context.scene.session_uid)
        return reports.latest is not None or bool(failure() or reports.error or reports.viewport_error)

    def draw(self, context: bpy.types.Context) -> None:
        reports, letters = reports_of(context.scene.session_uid), letters_across(context)
        if failure():
            text = iface_("The renderer has stopped: {}").format(failure())
            paragraph(self.layout, text, letters, icon="ERROR")
            restart_button(self.layout)
        for title, error in (("Viewport", reports.viewport_error), ("Last render", reports.error)):
            if error and error != failure():
                paragraph(self.layout, f"{iface_(title)}: {error}", letters, icon="ERROR")
        for report in (reports.viewport, reports.finals[0] if reports.finals else None):
            if report is not None:
                self.layout.label(text=iface_(report.kind.value), translate=False)
                _show(self.column(), report, context.scene)


def _show(column: bpy.types.UILayout, report: RenderReport, scene: bpy.types.Scene) -> None:
    progress, photons = report.progress, report.photon_statistics
    reading(column, "Samples", iface_("{} of {}").format(progress.iteration, report.settings.iterations))
    if progress.noise > 0.0:
        reading(column, "Noise", noise_text(progress.noise, report.settings.adaptive_threshold))
    reading(column, "Photons", iface_("{} a sample").format(count_text(progress.photons_per_iteration)))
    reading(column, "Radius", length_text(scene, photons.radius_meters))
    reading(column, "Memory", bytes_text(progress.memory_bytes))
    reading(column, "Speed", iface_("{} samples/s").format(rate_text(progress.iterations_per_second)))
    reading(column, "", iface_("{} photons/s").format(rate_text(progress.photons_per_second)))
    reading(column, "Time", seconds_text(progress.elapsed_seconds))
    reading(column, "Building", seconds_text(progress.build_seconds))
    for title, name, taken in (
        ("Density", "density_estimation", photons.density_estimation),
        ("First Hits", "first_photon_hits", photons.first_photon_hits),
    ):
        if taken:
            reading(column, title, iface_(scene.rppm.bl_rna.properties[name].enum_items[taken].name))
    if report.device:
        reading(column, "Device", report.device)


class RPPM_PT_last_renders(RppmPanel, bpy.types.Panel):
    bl_label = "Last Renders"
    bl_parent_id = "RPPM_PT_diagnostics"
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
                row.label(text=text(report), translate=False)


_COMPARED = (
    ("Resolution", lambda report: f"{report.width} x {report.height}"),
    ("Samples", lambda report: str(report.progress.iteration)),
    ("Photons", lambda report: count_text(report.progress.photons)),
    ("Time", lambda report: seconds_text(report.progress.elapsed_seconds)),
    ("Building", lambda report: seconds_text(report.progress.build_seconds)),
    ("Photons/s", lambda report: rate_text(report.progress.photons_per_second)),
    ("Samples/s", lambda report: rate_text(report.progress.iterations_per_second)),
    ("Memory", lambda report: bytes_text(report.progress.memory_bytes)),
    ("Triangles", lambda report: count_text(report.triangles)),
    ("Warnings", lambda report: str(report.warning_count)),
)
"""Lines of the table and what they say of a render, the newest on the left."""


class RPPM_PT_developer(RppmPanel, bpy.types.Panel):
    """Settings by which RPPM itself is tested and measured; their defaults serve every scene."""

    bl_label = "Developer"
    bl_parent_id = "RPPM_PT_diagnostics"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the preference Developer Extras is on, without which Cycles hides its debug panel too."""
        return super().poll(context) and context.preferences.view.show_developer_ui

    def draw(self, context: bpy.types.Context) -> None:
        scene, settings = context.scene, context.scene.rppm
        column = self.column()
        column.prop(settings, "density_estimation")
        column.prop(settings, "first_camera_hits")
        column.prop(settings, "first_photon_hits")
        cubemap = column.column()
        cubemap.active = settings.acceleration_structure != AccelerationStructure.BVH.name
        draw_setting(cubemap, scene, "cubemap_resolution", "Cubemap Resolution")
        cubemap.prop(settings, "cubemap_center_object")
        draw_setting(column, scene, "radius_minimum", "Minimum Radius")
        draw_setting(column, scene, "radius_maximum", "Maximum Radius")


STATUS = (RPPM_PT_status,)
CLASSES = (
    RPPM_PT_performance,
    RPPM_PT_performance_final,
    RPPM_PT_performance_viewport,
    RPPM_PT_diagnostics,
    RPPM_PT_acceleration_structure,
    RPPM_PT_last_renders,
    RPPM_PT_developer,
)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel that shares photons among the lights."""

from dataclasses import dataclass

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ....integrator.lights.sources import ENVIRONMENT, SURFACES, VOLUMES, source_name
from ....session.render.results import PhotonStatistics
from ...readings import photon_allocation
from ...reports import reports_of
from ..base import RppmPanel

LIGHTS_SHOWN = 24
"""Sources that are listed, those with the most photons first."""


@dataclass
class SourceRow:
    """A light source in the list."""

    name: str
    icon: str
    light: bpy.types.Light | None
    """Whose photon weight is shown; None where there is none to set."""
    allocated: float | None
    """Fraction of the photons, by the powers of the last render and the weights as they are; None before a render."""
    sent: float | None
    """Fraction of the photons of the last render's last iteration, which knew what photons are good for."""


def source_statistics(scene: bpy.types.Scene) -> PhotonStatistics | None:
    """Return the photon statistics of the last render that has light sources; None if there is none."""
    reports = reports_of(scene.session_uid)
    candidates = (reports.latest, reports.viewport, *reports.finals)
    found = (report.photon_statistics for report in candidates if report is not None)
    return next((statistics for statistics in found if statistics.source_watts), None)


def source_rows(scene: bpy.types.Scene) -> list[SourceRow]:
    """All light sources that the last render knew, and the lights that it did not know."""
    statistics = source_statistics(scene)
    rows: list[SourceRow] = []
    listed: set[bpy.types.Light] = set()
    if statistics is not None:
        # By name rather than by all of the scene's objects, which may be many thousands.
        lights = {name: _light_of(name) for name in statistics.source_watts}
        weights = {name: light.rppm.photon_weight for name, light in lights.items() if light is not None}
        allocation = photon_allocation(statistics.source_watts, weights)
        emitted = max(sum(statistics.source_photons.values()), 1)
        for name in statistics.source_watts:
            icon = {SURFACES: "MATERIAL", VOLUMES: "VOLUME_DATA", ENVIRONMENT: "WORLD"}.get(name, "LIGHT")
            shown = _object_name(name)
            rows.append(
                SourceRow(shown, icon, lights[name], allocation[name], statistics.source_photons.get(name, 0) / emitted)
            )
        listed = {light for light in lights.values() if light is not None}
        rows.sort(key=lambda row: -row.allocated)
    rows += [SourceRow(light.name, "LIGHT", light, None, None) for light in bpy.data.lights if light not in listed]
    return rows


def _object_name(source: str) -> str:
    start, end = source_name("\0").split("\0")
    return source[len(start) : -len(end)] if source.startswith(start) and source.endswith(end) else source


def _light_of(source: str) -> bpy.types.Light | None:
    found = bpy.data.objects.get(_object_name(source)) if source not in {SURFACES, VOLUMES, ENVIRONMENT} else None
    return found.data if found is not None and found.type == "LIGHT" else None


class RPPM_PT_photon_allocation(RppmPanel, bpy.types.Panel):
    bl_label = "Photon Allocation"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        rows = source_rows(context.scene)
        if not rows:
            layout.label(text="The scene has no lights", icon="INFO")
            return
        known = any(row.allocated is not None for row in rows)
        heading = layout.row()
        for text in ("Light", "Weight", "Allocated", "Sent") if known else ("Light", "Weight"):
            heading.label(text=text)
        column = layout.column(align=True)
        for source in rows[:LIGHTS_SHOWN]:
            line = column.row()
            line.label(text=source.name, icon=source.icon, translate=False)
            if source.light is not None:
                line.prop(source.light.rppm, "photon_weight", text="")
            else:
                line.label(text="")
            if known:
                for fraction in (source.allocated, source.sent):
                    line.label(text="" if fraction is None else f"{fraction:.1%}", translate=False)
        if len(rows) > LIGHTS_SHOWN:
            layout.label(text=iface_("and {} more").format(len(rows) - LIGHTS_SHOWN), translate=False)
        if known:
            layout.label(text="Allocated: by power and weight; Sent: with what was learned", icon="INFO")
        else:
            layout.label(text="The allocation is shown once the scene was rendered", icon="INFO")


CLASSES = (RPPM_PT_photon_allocation,)

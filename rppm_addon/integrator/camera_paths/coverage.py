# SPDX-License-Identifier: GPL-3.0-or-later
"""Fraction of the disks in which photons count that lies on surfaces, at the ends of the final gather's rays."""

from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.programs.programs import ProgramLibrary
from ..common.band import Band
from ..device_scene.stage_context import StageContext
from .importons import Importons

Record("CoverageParameters", segment="uint", first_pixel="uint")

MAX_PROBES = 8
"""Largest number of points that a disk is probed at; disks with less surface stay too dark."""
Constants("Coverage", MAX_PROBES=MAX_PROBES)


class Coverage:
    """Multiplies the global photons that importons will take where gathering rays end, and the path does not gather
    again, by the disk's area over that of the surface in it (Importon.gathers)."""

    def __init__(self, library: ProgramLibrary) -> None:
        self._library = library

    def probe(self, context: StageContext, importons: Importons, band: Band, segment: int) -> None:
        """Probe the disks of the importons that the active paths have just left."""
        if not context.gathers or segment == 0:
            return
        with context.timers.stage("coverage"):
            acceleration = context.acceleration
            program = self._library.compute("camera_paths/coverage/probe.comp", acceleration.traversal_defines)
            importons.active.run(
                program,
                {**context.blocks, **importons.lit_blocks},
                {"segment": segment, "first_pixel": band.first_pixel},
            )

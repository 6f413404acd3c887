# SPDX-License-Identifier: GPL-3.0-or-later
"""Random walks of camera paths and photons below surfaces with subsurface scattering."""

from collections.abc import Mapping

from ...gl.buffer_sets import ComputeShader, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable, ComputeProgram
from ...gl.programs.programs import ProgramLibrary
from ..acceleration.instances import HitPaths
from ..common.active_paths import ActivePaths, PathList
from ..common.band import Band
from ..common.records.random_stages import RandomStage
from ..common.records.rays import HIT, RAY
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes, subsurface_walks
from ..device_scene.stage_context import StageContext
from .importons import Importons

SUBSURFACE_WALK = Record(
    "SubsurfaceWalk",
    throughput="vec3",
    instance="uint",
    entry="vec3",
    opposite="float",
    extinction="vec3",
    anisotropy="float",
    albedo="vec3",
    normal="uint",
)
"""A random walk below a surface of an instance: where it went in, the ``normal`` there (packed), and how far behind
that the surface is met again, meters, less than 0 where it is not near; ``extinction``, 1/m, and ``albedo`` are those
of single scattering."""
StorageBlock("SubsurfaceWalks", "SubsurfaceWalk subsurface_walks[];")
StorageBlock("WalkRays", "Ray walk_rays[];")
StorageBlock("ExitHits", "Hit exit_hits[];")
"""Where walks have come out; none of those that have not."""


Record("EnterParameters", segment="uint", first_path="uint")
Record(
    "WalkParameters",
    segment="uint",
    first_path="uint",
    stage="uint",
    first_step="uint",
    end_step="uint",
    first_hit="uint",
)

_LAST_STEPS = (4, 8, 16, 32, 64, 96, 128, 160, 192, 224, 256)
"""After how many steps walks that have come out are left aside; after the last, those that have not are absorbed, as in
Cycles. Drivers on the processor end the loops of a thread after 65535 rounds."""


class Subsurface(Stage):
    """Paths that go below a surface walk until they come out of the same object, and are then on a diffuse surface."""

    memory_group = "subsurface"
    remedy = "lower the resolution or the photons per iteration"
    _walks = StorageBuffer("subsurface walks", SUBSURFACE_WALK, subsurface_walks, block="SubsurfaceWalks")
    _rays = StorageBuffer("subsurface rays", RAY, subsurface_walks, block="WalkRays")
    _hits = StorageBuffer("subsurface hits", HIT, subsurface_walks, block="ExitHits")
    _entered = PathList("paths below surfaces")
    _walking = PathList("walking paths", to_keep=True)
    _enter = ComputeShader("camera_paths/subsurface/enter.comp")
    _leave = ComputeShader("camera_paths/subsurface/leave.comp")
    _enter_photons = ComputeShader("camera_paths/subsurface/enter_photons.comp")
    _leave_photons = ComputeShader("camera_paths/subsurface/leave_photons.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._library = library

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where materials have subsurface scattering."""
        return sizes.has_subsurface

    def walk_camera_paths(self, context: StageContext, importons: Importons, band: Band, segment: int) -> None:
        """Fill the exit closures of the active camera paths, whose hits are resolved."""
        if not self.is_on:
            return
        with context.timers.stage("camera subsurface"):
            programs = self._enter, self._leave
            self._walk(context, importons.active, importons.blocks, programs, segment, RandomStage.SUBSURFACE, band)

    def walk_photons(
        self,
        context: StageContext,
        active: ActivePaths,
        blocks: Mapping[str, Bindable],
        segment: int,
    ) -> None:
        """Send active photons that a surface scatters diffusely on from where they come out of it.

        blocks: what they are, where they are and go, and the AdjointQueries that are still to be asked.
        """
        if not self.is_on:
            return
        with context.timers.stage("photon subsurface"):
            programs = self._enter_photons, self._leave_photons
            self._walk(context, active, blocks, programs, segment, RandomStage.SUBSURFACE_PHOTONS)

    def _walk(
        self,
        context: StageContext,
        active: ActivePaths,
        blocks: Mapping[str, Bindable],
        programs: tuple[ComputeProgram, ComputeProgram],
        segment: int,
        stage: RandomStage,
        band: Band | None = None,
    ) -> None:
        blocks = {**context.blocks, **self.blocks, **blocks}
        parameters = {
            "segment": segment,
            "first_path": band.first_pixel if band else 0,
        }
        enter, leave = programs
        walk = self._library.compute("camera_paths/subsurface/walk.comp", context.acceleration.traversal_defines)
        first_hit = context.acceleration.first_hit(HitPaths.SUBSURFACE)

        active.run(enter, blocks, parameters)
        self._entered.take(active, self._rays.buffer)
        walking = self._walking
        walking.require(active.capacity, to_keep=True)
        walking.take(self._entered, self._rays.buffer)
        first = 0
        for end in _LAST_STEPS:
            if walking.known_empty:
                break
            steps = {"stage": stage, "first_step": first, "end_step": end, "first_hit": first_hit}
            walking.run(walk, blocks, parameters | steps)
            walking.keep(self._rays.buffer)
            first = end
        context.acceleration.gather_hits(self._hits.buffer, self._entered, HitPaths.SUBSURFACE)
        self._entered.run(leave, blocks, parameters)

# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectPhotonHits and TracePhotons: photons from the lights through the scene."""

import numpy as np

from ...gl.buffer_sets import Part, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import GROUP_SIZE
from ...gl.programs.programs import ProgramLibrary
from ...scene.settings import DirectLight
from ..acceleration.instances import HitPaths
from ..camera_paths.subsurface import Subsurface
from ..common.active_paths import ActivePaths, PathList
from ..common.iteration import Iteration
from ..common.records.closures import CLOSURE
from ..common.records.photon_paths import PHOTON_ORIGIN, PHOTON_PATH, PhotonFlag
from ..common.records.photons import PHOTON, PHOTON_SEGMENT_SHIFT
from ..common.records.rays import HIT, RAY
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes, photon_paths, photon_slots
from ..density_estimation.radii import EXPECTED_CAUSTIC_PHOTONS, Radii
from ..density_estimation.stored_photons import PhotonList, StoredPhotons
from ..device_scene.stage_context import StageContext
from .first_hits import FirstHits
from .photon_emission import PhotonEmission
from .photon_groups import PhotonGroups
from .photon_links import PhotonLinks

PHOTON_DIFFERENTIAL = Record(
    "PhotonDifferential",
    place_u="vec3",
    known="uint",
    turn_u="vec3",
    blur="float",
    place_v="vec3",
    spread="float",
    turn_v="vec3",
    before="float",
)
"""How far from a photon's ray its neighbors' run, along two directions: ``place`` in meters at the ray's origin,
``turn`` by how much their directions differ. ``blur`` is the radius, meters, over which the light's own size spreads
what comes there, before the first hit the light's, and ``spread`` by how much it grows with the distance; ``before`` is
how far the ray's origin is from the light, INFINITY_DISTANCE from those without a place, or behind the first hit from
the surface that turned the photon last. ``known`` is 0 where neighbors are not followed any more."""
StorageBlock("PhotonDifferentials", "PhotonDifferential photon_differentials[];")
ADJOINT_QUERY = Record(
    "AdjointQuery", bsdf="vec3", part="uint", ior="float", flags="uint", reach="float", unused="uint"
)
"""A scattered photon at a surface whose scattering depends on where it is seen from, until the BSDF is evaluated from
the side that the photon goes to (shaders/photons/adjoint.comp): the ``part`` of the closure that scattered it
(shaders/photons/parts.glsl), the value ``bsdf`` of this part from the side that it came from, and the ``ior`` of a
sharp refraction. ``flags`` are those of its path from here on, and its ray ends at ``reach``, meters. A value of 0 is
not compared."""
StorageBlock("AdjointQueries", "AdjointQuery adjoint_queries[];")
FLUX_GROUP = GROUP_SIZE
"""Paths whose fluxes the device sums (shaders/photons/balance.comp)."""
FLUX_NAMES = ("emitted", "absorbed", "deposited", "escaped", "lost")
FLUX_SUMS = Record("FluxSums", **dict.fromkeys((*FLUX_NAMES, "unused0", "unused1", "unused2"), "float"))


Record("BeginSegmentParameters", segment="uint")
Record(
    "ScatterPhotonsParameters",
    segment="uint",
    has_adjoint_queries="uint",
    footprint_photons="float",
)
Record("BalanceParameters", photon_count="uint")


def _flux_groups(sizes: StageSizes) -> int:
    return -(-sizes.photons // FLUX_GROUP)


class Photons(Stage):
    """The photons of one iteration: those of a segment follow those of the segments before, one for each path that
    lives, so that they take as much memory as there are; ``photon_origins`` has the place where each path began."""

    memory_group = "photon paths"
    remedy = "lower the photons per iteration or the photon path length"
    photons = StorageBuffer("photons", PHOTON, photon_slots, texel_bytes=4, block="Photons")
    _range = StorageBuffer("range of photons", "uint", 2, block="PhotonRange")
    photon_origins = StorageBuffer("photon origins", PHOTON_ORIGIN, photon_paths, block="PhotonOrigins")
    _paths = StorageBuffer("photon paths", PHOTON_PATH, photon_paths, block="PhotonPaths")
    _rays = StorageBuffer("photon rays", RAY, photon_paths, block="Rays")
    _hits = StorageBuffer("photon hits", HIT, photon_paths, block="Hits")
    closures = StorageBuffer("photon closures", CLOSURE, photon_paths, texel_bytes=4, block="Closures")
    _adjoint_queries = StorageBuffer("adjoint queries", ADJOINT_QUERY, photon_paths, block="AdjointQueries")
    _differentials = StorageBuffer(
        "photon differentials", PHOTON_DIFFERENTIAL, photon_paths, block="PhotonDifferentials"
    )
    _emitted = StorageBuffer("emitted photons", PHOTON_PATH, photon_paths, block="Emitted")
    _sums = StorageBuffer("flux sums", FLUX_SUMS, _flux_groups, block="Sums")
    _active = PathList("active photon paths", photon_paths, to_keep=True)
    first_hits = Part(FirstHits)
    _groups = Part(PhotonGroups)
    _links = Part(PhotonLinks)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._context = context
        self._scatter = library.compute("photons/scatter.comp")
        self._adjoint = library.compute("photons/adjoint.comp")
        self._begin = library.compute("photons/begin_segment.comp")
        self._balance = library.compute("photons/balance.comp")
        self.photon_count = sizes.photons
        self.slots = 0
        """Photons of the last iteration: no more than so many."""
        self._emission = PhotonEmission(library)

    @property
    def active(self) -> ActivePaths:
        """The list of the paths that go on."""
        return self._active

    def emit(self, context: StageContext, iteration: Iteration) -> None:
        """DirectPhotonHits: the iteration's photons leave the lights and find their first hits."""
        self.photon_count, self.slots = iteration.photon_count, 0
        rays, hits, paths = self._rays.buffer, self._hits.buffer, self._paths.buffer
        with context.timers.stage("emission"):
            self._active.fill(self.photon_count)
            self._emission.emit(context, self.blocks, self.photon_count)
            if context.lights.emitters.instances.are_there:
                context.acceleration.gather_sources(rays, self._active, HitPaths.PHOTON)
            self._groups.find(context, rays, self.photon_origins.buffer, self.photon_count)
            self._links.find(context, rays, self.photon_count)
            context.lights.emitters.tint_photons(
                context.resolve, rays, hits, self.closures.buffer, paths, self._active, iteration.number
            )
        with context.timers.stage("first photon hits"):
            self.first_hits.find(context, rays, hits, self._active)
            if context.lights.has_falloff and not context.materials.media.scatter:  # which have them where they scatter
                self._emission.apply_falloff(context, self.blocks, self.photon_count)
            if context.lights.are_cut:
                self._emission.cut_soft_lights(context, self.blocks, self._active)
        self._context.moderngl.copy_buffer(self._emitted.buffer, paths)
        self._begin_segment(0)

    def trace(self, context: StageContext, segment: int) -> bool:
        """Find what the photons that go on hit; whether any may do so."""
        with context.timers.stage("photon tracing"):
            self._active.keep(self._rays.buffer)
            if not self._active.bound(segment):
                return False
            context.acceleration.trace(self._rays.buffer, self._hits.buffer, self._active, HitPaths.PHOTON)
        self._begin_segment(segment)
        return True

    def resolve(
        self, context: StageContext, iteration: Iteration, segment: int, has_adjoint_queries: bool = False
    ) -> None:
        """Hits to closures; ``has_adjoint_queries``: as seen from where the photons go."""
        with context.timers.stage("photon resolve"):
            context.resolve.run(
                self._rays.buffer,
                self._hits.buffer,
                self.closures.buffer,
                self._active,
                iteration.number,
                segment,
                photon_paths=self._paths.buffer,
                has_adjoint_queries=has_adjoint_queries,
            )
            self._links.link(context, self.closures.buffer, self._paths.buffer, self._active)

    def scatter(self, context: StageContext, subsurface: Subsurface, iteration: Iteration, segment: int) -> None:
        """Store photons, and send them on with the flux that a viewer would see from where they go."""
        has_adjoint_queries = context.materials.any_depends_on_view
        with context.timers.stage("photon scattering"):
            self._active.run(
                self._scatter,
                {**context.blocks, **self.blocks},
                {
                    "segment": segment,
                    "has_adjoint_queries": has_adjoint_queries,
                    "footprint_photons": EXPECTED_CAUSTIC_PHOTONS,
                },
            )
        if has_adjoint_queries:
            subsurface.walk_photons(context, self._active, self.blocks, segment)
            self.resolve(context, iteration, segment, has_adjoint_queries=True)
            with context.timers.stage("photon scattering"):
                self._active.run(self._adjoint, self.blocks)

    def _begin_segment(self, segment: int) -> None:
        """Make room for a photon of each active path behind those of the segments before."""
        self.slots += self._active.bound(segment)
        self.photons.extend_items(self.slots)
        self._begin.run(1, {**self.blocks, "ActivePaths": self._active.buffer}, {"segment": segment})

    def list_stored(self, context: StageContext, listed: PhotonList) -> PhotonList:
        """List the photons that importons may take. Where shadow rays find direct light, direct ones would count it
        twice."""
        takes_direct = context.settings.direct_light is DirectLight.PHOTONS
        with context.timers.stage("photon list"):
            listed.collect(self.blocks, self.slots, takes_direct)
        return listed

    def stored(self, context: StageContext, listed: PhotonList, radii: Radii) -> StoredPhotons:
        """Return the listed photons, with the data that their estimate depends on."""
        bounds = context.geometry.bounds_low, context.geometry.bounds_high
        return StoredPhotons(
            self.photons.buffer,
            listed.buffer,
            listed.count,
            listed.count - listed.global_photon_count,
            listed.global_photon_count,
            listed.indirect_count,
            self.photon_origins.buffer,
            context.lights.photon_flux,
            radii.splats,
            float(np.max(np.abs(bounds))),
            context.iteration_block.buffer,
        )

    def flux_balance(self) -> dict[str, float]:
        """Balance of the flux of the last iteration, W summed over the channels.

        ``deposited`` is what paths still carried to the vertex where a limit cut them off; ``lost`` is flux on a ray
        that no segment followed: it must be zero. ``absorbed`` is the rest, changes of index included.
        Russian roulette makes single events absorb more or less than their fraction, the sum being right.
        """
        groups = -(-self.photon_count // FLUX_GROUP)
        self._balance.run(
            self.photon_count,
            self.blocks,
            {"photon_count": self.photon_count},
        )
        sums = self._sums.read(FLUX_SUMS.dtype, groups)
        return {name: float(sums[name].sum(dtype=np.float64)) for name in FLUX_NAMES}

    def count_segments(self) -> int:
        """Number of rays of the photons of the last iteration. Waits for the device."""
        return int(self._range.read(np.uint32, 2)[1])

    def read(self) -> np.ndarray:
        """(segments, photon_count) PHOTON records of the last iteration by segment and path: zeros where none is."""
        records = self.photons.read(PHOTON.dtype, self.count_segments())
        records = records[records["flags"] & PhotonFlag.ACTIVE != 0]
        segments, paths = np.divmod(records["path"], 1 << PHOTON_SEGMENT_SHIFT)
        result = np.zeros((int(segments.max(initial=0)) + 1, self.photon_count), PHOTON.dtype)
        result[segments, paths] = records
        return result

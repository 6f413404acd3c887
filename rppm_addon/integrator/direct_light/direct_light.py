# SPDX-License-Identifier: GPL-3.0-or-later
"""Light straight from the sources, by shadow rays from the camera paths' vertices."""

from collections.abc import Mapping

import moderngl

from ...gl.buffer_sets import StorageBuffer
from ...gl.buffers.buffers import GrowingBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable, ComputeProgram
from ...gl.programs.programs import ProgramLibrary
from ...scene.settings import DirectLight as DirectLightMode
from ..acceleration.instances import HitPaths
from ..camera_paths.importons import Importons
from ..common.active_paths import ActivePaths, PathList
from ..common.band import Band
from ..common.iteration import Iteration
from ..common.records.closures import CLOSURE
from ..common.records.rays import HIT, RAY
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes, band_pixels, grouped_pixels, split_pixels
from ..device_scene.stage_context import StageContext
from ..lights.emitters.programs import EmitterProgram

LIGHT_SPLIT = Record("LightSplit", glossy="vec3", light="uint", transmission="vec3", unused="float")
"""Fractions of the light of a shadow ray that glossy and transmission lobes scatter, by channel; the rest is diffuse.
``light`` is the number of the light that the ray goes to, if that is no triangle."""
StorageBlock("LightSplits", "LightSplit light_splits[];")


Record(
    "DirectLightParameters",
    segment="uint",
    first_pixel="uint",
    light_sample="uint",
    sample_weight="float",
    splits_light="uint",
    crosses_media="uint",
)

StorageBlock("ShadowMedia", "uint shadow_media[];")
"""Flags of paths in the media that shadow rays have come into (shaders/materials/medium.glsl)."""
Record("PassSurfaceParameters", surface_count="uint")

_SURFACES_AT_ONCE = 16
"""Transparent surfaces between two readings of the number of shadow rays from a GPU, each of which waits for it."""


MOST_VOLUME_SURFACES = 64
"""Surfaces of volumes alone that a shadow ray passes at most, beside those that it counts as transparent."""
Constants("VolumeSurfaces", signed=True, MOST_VOLUME_SURFACES=MOST_VOLUME_SURFACES)


def _media_pixels(sizes: StageSizes) -> int:
    return band_pixels(sizes) if sizes.features.has_media else 0


def _pass_pixels(sizes: StageSizes) -> int:
    return max(split_pixels(sizes), grouped_pixels(sizes))


class DirectLight(Stage):
    """A sampled light and a shadow ray, or several, for every camera path and segment."""

    memory_group = "direct light"
    remedy = "lower the resolution"
    _rays = StorageBuffer("shadow rays", RAY, band_pixels, block="ShadowRays")
    contributions = StorageBuffer("direct light", "vec4", band_pixels, block="Contributions")
    splits = StorageBuffer("split of direct light", LIGHT_SPLIT, _pass_pixels, block="LightSplits")
    visibility = StorageBuffer("visibility", "uint", band_pixels, block="Visibility")
    triangles = StorageBuffer("triangles of sampled lights", "uint", band_pixels, block="LightTriangles")
    _media = StorageBuffer("media of shadow rays", "uint", _media_pixels, block="ShadowMedia")
    active_rays = PathList("active shadow rays", band_pixels)
    # Of scenes with transparent surfaces.
    _hits = StorageBuffer("hits of shadow rays", HIT)
    _own_closures = StorageBuffer("closures that shadow rays pass", CLOSURE)
    _passing = PathList("shadow rays that pass surfaces", to_keep=True)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self.lent_closures: GrowingBuffer | None = None
        """Closures that another stage does not need meanwhile."""
        self._block_limit = context.storage_block_limit
        self._library = library
        self._sample = EmitterProgram(library, "direct_light/sample.comp")
        defines = library.scene_defines
        self._media_defines: dict[str, object] = {
            name: defines[name] for name in ("MEDIA", "HETEROGENEOUS_MEDIA") if name in defines
        }
        if sizes.features.has_media:
            self._sample_in_media = EmitterProgram(library, "media/in_scattering/sample_lights.comp")
        self._soften = library.compute("direct_light/terminator.comp")
        self._meet = library.compute("direct_light/meet.comp")
        self._pass = library.compute("direct_light/pass.comp")
        self._add = library.compute("direct_light/add.comp")
        self._splits_light = _pass_pixels(sizes) > 0

    def add(
        self,
        context: StageContext,
        importons: Importons,
        band: Band,
        iteration: Iteration,
        segment: int,
    ) -> None:
        """Add the direct light of the resolved vertices of the active camera paths to the band's radiance, or to what
        their gathering rays found.

        To be called before the paths scatter on. Nothing is added where photons bring direct light, or where none of
        it would come to the film.
        """
        if context.settings.direct_light is not DirectLightMode.RAYS or not iteration.needs_radiance:
            return
        with context.timers.stage("direct light"):
            for ray in range(iteration.shadow_rays):
                self._sample_lights(
                    self._sample.of(context.lights.emitters.instances),
                    context,
                    importons,
                    band,
                    iteration,
                    segment,
                    ray,
                    iteration.shadow_rays,
                )
                self._cast(context, importons, iteration, segment, context.resolve.has_terminators)

    def add_in_media(
        self, context: StageContext, importons: Importons, band: Band, iteration: Iteration, segment: int
    ) -> bool:
        """Add the direct light that media scatter along the rays of the active camera paths, whose hits are resolved.

        Returns whether shadow rays were cast: nothing is added where photons bring direct light, or where none of it
        would come to the film.
        """
        if not context.materials.media.scatter or not iteration.needs_radiance:
            return False
        if context.settings.direct_light is not DirectLightMode.RAYS:
            return False
        with context.timers.stage("direct light in media"):
            self._sample_lights(
                self._sample_in_media.of(context.lights.emitters.instances),
                context,
                importons,
                band,
                iteration,
                segment,
                0,
                1,
            )
            self._cast(context, importons, iteration, segment, has_terminators=False)
        return True

    def _cast(
        self, context: StageContext, importons: Importons, iteration: Iteration, segment: int, has_terminators: bool
    ) -> None:
        """Trace the shadow rays of sampled lights, and add what arrives."""
        active = self.active_rays
        active.take(importons.active, self._rays.buffer)
        if active.known_empty:
            return
        if context.lights.emitters.instances.are_there:
            context.acceleration.gather_lights(self.triangles.buffer, active)
        if has_terminators:
            self._soften_terminator(context, importons)
        context.lights.emitters.tint_contributions(
            context.resolve,
            self._rays.buffer,
            self.triangles.buffer,
            self.contributions.buffer,
            self._require_closures(),
            active,
            iteration.number,
        )
        self._trace(context, importons, context.lights.linking_blocks(self.contributions.buffer), iteration, segment)
        active.run(self._add, {**context.blocks, **importons.blocks, **self.blocks})

    def trace_rays(self, context: StageContext, importons: Importons, iteration: Iteration, segment: int) -> None:
        """Trace shadow rays that another stage has left in ``blocks`` for the active camera paths, to no light.

        Afterwards ``active_rays`` are those with a length, ``visibility`` says of each whether it arrives, and
        ``contributions`` have lost what transparent surfaces take.
        """
        self.active_rays.take(importons.active, self._rays.buffer)
        if not self.active_rays.known_empty:
            self._trace(context, importons, None, iteration, segment)

    def _trace(
        self,
        context: StageContext,
        importons: Importons,
        linking: Mapping[str, moderngl.Buffer] | None,
        iteration: Iteration,
        segment: int,
    ) -> None:
        if not context.materials.any_passes_shadow_rays:
            context.acceleration.occluded(
                self._rays.buffer, self.triangles.buffer, self.visibility.buffer, self.active_rays, linking
            )
        elif self._media_defines and not linking and not context.materials.any_resolves_shadow_rays:
            blocks = {**context.blocks, **importons.blocks, **self.blocks}
            self._run_in_media("direct_light/occluded_in_media.comp", context, blocks, self.active_rays)
        else:
            self._pass_surfaces(context, importons, linking, iteration, segment)

    def _pass_surfaces(
        self,
        context: StageContext,
        importons: Importons,
        linking: Mapping[str, moderngl.Buffer] | None,
        iteration: Iteration,
        segment: int,
    ) -> None:
        """Trace shadow rays through transparent surfaces, which take of what they bring."""
        rays, hits, closures, passing = self._rays, self._hits, self._require_closures(), self._passing
        hits.require_items(self.active_rays.capacity)
        passing.require(self.active_rays.capacity, to_keep=True)
        passing.take(self.active_rays, rays.buffer)
        blocks = {
            **context.blocks,
            **importons.blocks,
            **self.blocks,
            "Hits": hits.buffer,
            "Closures": closures,
        }
        most = context.settings.transparent_max_bounces + (MOST_VOLUME_SURFACES if self._media.size else 0)
        for surfaces in range(most + 1):
            if surfaces > 0 and surfaces % _SURFACES_AT_ONCE == 0 and passing.read_count() == 0:
                return
            self._find_hits(context, blocks, passing, linking)
            passing.run(self._meet, blocks)
            passing.keep(rays.buffer)
            if passing.known_empty:
                return
            context.resolve.shadow_rays(
                rays.buffer,
                hits.buffer,
                closures,
                self.contributions.buffer,
                passing,
                iteration.number,
                segment,
            )
            passing.run(self._pass, blocks, {"surface_count": surfaces})
            passing.keep(rays.buffer)
            if passing.known_empty:
                return

    def _require_closures(self) -> moderngl.Buffer:
        """Room for the closure of a surface for each shadow ray: what was lent, if that is enough and a plain block."""
        lent, count = self.lent_closures, self.active_rays.capacity
        if lent is not None and lent.capacity >= count and lent.size <= self._block_limit:
            return lent.buffer
        self._own_closures.require_items(count)
        return self._own_closures.buffer

    def _find_hits(
        self,
        context: StageContext,
        blocks: dict[str, Bindable],
        passing: ActivePaths,
        linking: Mapping[str, moderngl.Buffer] | None,
    ) -> None:
        """Find the nearest hits of shadow rays. In media they pass the surfaces that only bound volumes, as far as the
        program has storage blocks enough."""
        acceleration, hits = context.acceleration, self._hits.buffer
        if not self._media_defines or (linking and acceleration.has_instances):
            acceleration.shadow_hits(self._rays.buffer, self.triangles.buffer, hits, passing, linking)
            return
        kernel = "direct_light/hits_in_media_linked.comp" if linking else "direct_light/hits_in_media.comp"
        self._run_in_media(kernel, context, {**blocks, **(linking or {})}, passing)
        acceleration.gather_hits(hits, passing, HitPaths.SHADOW)

    def _run_in_media(self, kernel: str, context: StageContext, blocks: dict[str, Bindable], rays: ActivePaths) -> None:
        """Run a program that traces shadow rays behind the surfaces that only bound volumes."""
        acceleration = context.acceleration
        levels = {"HITS": "media/two_levels"} if acceleration.has_instances else {}
        program = self._library.compute(
            kernel, {**acceleration.lean_traversal_defines, **self._media_defines, **levels}
        )
        buffers = {**blocks, **context.geometry.mesh_blocks, **acceleration.traversal_buffers}
        rays.run(program, buffers, {"first_hit": acceleration.first_hit(HitPaths.SHADOW)})

    def _soften_terminator(self, context: StageContext, importons: Importons) -> None:
        """Move and weaken shadow rays where the flat triangles of smooth surfaces would show in their shadows."""
        self.active_rays.run(self._soften, {**context.blocks, **importons.lit_blocks, **self.blocks})

    def _sample_lights(
        self,
        program: ComputeProgram,
        context: StageContext,
        importons: Importons,
        band: Band,
        iteration: Iteration,
        segment: int,
        ray: int,
        rays: int,
    ) -> None:
        """Sample a light for each vertex, the ``ray``-th of so many, and what it adds where nothing is in between."""
        importons.active.run(
            program,
            {**context.blocks, **importons.lit_blocks, **self.blocks},
            {
                "segment": segment,
                "first_pixel": band.first_pixel,
                "light_sample": (iteration.number - 1) * rays + ray,
                "sample_weight": 1.0 / rays,
                "splits_light": self._splits_light,
                "crosses_media": context.materials.any_passes_shadow_rays,
            },
        )

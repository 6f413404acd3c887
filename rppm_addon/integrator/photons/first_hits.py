# SPDX-License-Identifier: GPL-3.0-or-later
"""DirectPhotonHits: photons find their first hits by one of two routes, which give the same hits bit for bit.

They are looked up in light G-buffers (light_gbuffer.py), as in the paper, or traced through the deep cubemap.
"""

import functools
import logging

import moderngl

from ...gl.buffer_sets import BufferSet
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.errors import DeviceError
from ...scene.settings import FirstPhotonHits
from ..acceleration.instances import HitPaths
from ..common.active_paths import ActivePaths, PathList
from ..common.require import require
from ..device_scene.stage_context import StageContext
from .light_gbuffer import LightGBuffer

log = logging.getLogger(__name__)

_TRACED_BEFORE_TRIAL = 8
"""Iterations of a scene that are traced: it takes a few until light G-buffers have paid for themselves."""
_FEWEST_TO_TRY = 1000
"""Photons to try both routes with."""


class FirstHits(BufferSet):
    """Finds photons' first hits by the route that the settings ask for.

    AUTOMATIC traces for some iterations, lest scenes in motion cost more, then tries both and takes the faster one
    until lights or geometry change.
    """

    _left = PathList("photons to trace", remedy="lower the photons per iteration")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._context, self._library = context, library
        self._gbuffer: LightGBuffer | None = None
        self._stands = self._has_views = False
        self._lights_built = 0
        """Lights.times_built when this began with the scene's lights."""
        self._traced = 0
        self._faster: FirstPhotonHits | None = None
        self.route = FirstPhotonHits.TRACED
        """The one that was taken last, which nothing but speed depends on."""

    def forget(self) -> None:
        """Begin anew, as when lights or geometry have changed."""
        self._stands, self._traced, self._faster = False, 0, None

    def find(self, context: StageContext, rays: moderngl.Buffer, hits: moderngl.Buffer, active: ActivePaths) -> None:
        """Write the hits (HIT) of all photons' rays (RAY), those of ``active``.

        Raises DeviceError where light G-buffers are asked for that the device has no room for.
        """
        if self._lights_built != context.lights.times_built:
            self._lights_built = context.lights.times_built
            self.forget()
        wanted = context.settings.first_photon_hits
        if context.geometry.instanced is not None:  # a light G-buffer draws world triangles
            wanted = FirstPhotonHits.TRACED
        elif wanted is FirstPhotonHits.AUTOMATIC:
            wanted = self._automatic(context, rays, hits, active)
        if wanted is FirstPhotonHits.TRACED and self._gbuffer is not None:
            self.disown(self._gbuffer)
            self._gbuffer, self._stands = None, False
        rasterized = wanted is FirstPhotonHits.RASTERIZED and self._build(context)
        self.route = FirstPhotonHits.RASTERIZED if rasterized else FirstPhotonHits.TRACED
        self._run(self.route, context, rays, hits, active)

    def _automatic(
        self, context: StageContext, rays: moderngl.Buffer, hits: moderngl.Buffer, active: ActivePaths
    ) -> FirstPhotonHits:
        if self._faster is None:
            self._traced += 1
            if self._traced <= _TRACED_BEFORE_TRIAL or active.capacity < _FEWEST_TO_TRY:
                return FirstPhotonHits.TRACED
            self._faster = self._try_both(context, rays, hits, active)
        return self._faster

    def _try_both(
        self, context: StageContext, rays: moderngl.Buffer, hits: moderngl.Buffer, active: ActivePaths
    ) -> FirstPhotonHits:
        try:
            if not self._build(context):
                return FirstPhotonHits.TRACED
        except DeviceError as error:
            log.debug("first photon hits are traced: %s", error)
            return FirstPhotonHits.TRACED
        seconds = {}
        # The first time compiles.
        for route in 2 * (FirstPhotonHits.RASTERIZED, FirstPhotonHits.TRACED):
            seconds[route] = self._seconds(route, context, rays, hits, active)
        log.debug("first photon hits: %.1f ms rasterized, %.1f ms traced", *(1e3 * s for s in seconds.values()))
        return min(seconds, key=lambda route: seconds[route])

    def _seconds(
        self,
        route: FirstPhotonHits,
        context: StageContext,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        active: ActivePaths,
    ) -> float:
        return self._context.seconds_of(functools.partial(self._run, route, context, rays, hits, active))

    def _build(self, context: StageContext) -> bool:
        """Whether there are light G-buffers, made now if they are not those of the scene."""
        if not self._stands:
            if self._gbuffer is None:
                self._gbuffer = self.own(LightGBuffer(self._context, self._library))
            lights, geometry = context.lights, context.geometry
            self._has_views = self._gbuffer.build(lights.table, geometry.center, lights.scene_radius, geometry) > 0
            self._stands = True
        return self._has_views

    def _run(
        self,
        route: FirstPhotonHits,
        context: StageContext,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        active: ActivePaths,
    ) -> None:
        if route is FirstPhotonHits.TRACED:
            context.acceleration.trace(rays, hits, active, HitPaths.PHOTON)
            return
        require(self._gbuffer).find(context.blocks, rays, hits, active.capacity, self._left)
        if not self._left.known_empty:
            context.acceleration.trace(rays, hits, self._left, HitPaths.PHOTON)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Where photons end first, by rays and by light G-buffers."""

import numpy as np

from rppm_addon.integrator.common.active_paths import ActivePaths
from rppm_addon.integrator.common.iteration import Iteration
from rppm_addon.integrator.common.records.rays import HIT
from rppm_addon.integrator.photons.light_gbuffer import LightGBuffer
from rppm_addon.integrator.photons.photon_emission import PhotonEmission
from rppm_addon.scene import Scene


def both_hits(mapper, library, scene: Scene) -> tuple[np.ndarray, np.ndarray, float]:
    """HIT records of an iteration's photons, traced and rasterized, and the share that light G-buffers settle."""
    mapper.build(scene)
    mapper.iterate()
    context, photons = mapper.device_scene.context, mapper.stages.photons
    rays, hits = photons._rays.buffer, photons._hits
    count, lights = scene.settings.photons, context.lights
    photons._active.fill(count)
    context.begin(Iteration(2, seed=3))
    PhotonEmission(library).emit(context, photons.blocks, count)
    context.acceleration.trace(rays, hits.buffer, photons._active)
    traced = hits.read(HIT.dtype, count).copy()
    hits.clear()
    gbuffer = LightGBuffer(mapper.context, library)
    left = ActivePaths(mapper.context, library, "left", "")
    geometry = context.geometry
    gbuffer.build(lights.table, geometry.center, lights.scene_radius, geometry)
    gbuffer.find(context.blocks, rays, hits.buffer, count, left)
    settled = 1.0 - left.read_count() / count
    context.acceleration.trace(rays, hits.buffer, left)
    rasterized = hits.read(HIT.dtype, count).copy()
    gbuffer.release()
    left.release()
    return traced, rasterized, settled

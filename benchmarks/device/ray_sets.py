# SPDX-License-Identifier: GPL-3.0-or-later
"""The rays that a render traces, taken from a real one, by their kind."""

import numpy as np

from rppm_addon.integrator.acceleration.acceleration_structure import AccelerationStructure
from rppm_addon.integrator.algorithm import trace_photons
from rppm_addon.integrator.common.active_paths import ActivePaths
from rppm_addon.integrator.common.iteration import Iteration
from rppm_addon.integrator.common.records.rays import HIT, NO_TRIANGLE, RAY
from rppm_addon.integrator.progressive import ProgressivePhotonMapper

KINDS = ("camera", "diffuse bounce", "photon")
_MOST_ITERATIONS = 16


def record_rays(mapper: ProgressivePhotonMapper, count: int, seed: int = 0) -> dict[str, np.ndarray]:
    """At most ``count`` RAY records of each kind, from a mapper whose scene is built.

    Camera rays are those through the pixels; diffuse bounces leave their hits by the cosine; photon
    rays are all that iterations trace, from the lights and on. There may be fewer of these, or none
    of a kind, in scenes that few rays reach.
    """
    rng = np.random.default_rng(seed)
    camera = mapper.scene.camera
    rays = RAY.zeros(count)
    left, right, bottom, top = camera.window
    u, v = rng.uniform(left, right, count), rng.uniform(bottom, top, count)
    axes, position = camera.matrix[:3, :3], camera.matrix[:3, 3]
    if camera.orthographic:
        origins = position + np.stack([u, v, -camera.clip_start * np.ones(count)], 1) @ axes.T
        directions = np.tile(-axes[:, 2], (count, 1))
    else:
        directions = np.stack([u, v, -np.ones(count)], 1) @ axes.T
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        origins = position + camera.clip_start * directions
    # neighbors in the buffer are neighbors in the picture, as pixels are
    rows = np.lexsort([u, np.floor((v - bottom) / (top - bottom) * np.sqrt(count) / 4)])
    rays["origin"], rays["direction"] = origins[rows], directions[rows]
    rays["maximum_distance"], rays["source_triangle"] = 1e30, NO_TRIANGLE
    hits = trace(mapper, rays)
    found = np.nonzero(hits["triangle"] != NO_TRIANGLE)[0]
    found = np.sort(np.resize(found, count if len(found) else 0))  # several from each where few hit
    bounces = RAY.zeros(len(found))
    corners = triangles(mapper)[hits["triangle"][found]].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    normals *= -np.sign(np.einsum("ij,ij->i", normals, rays["direction"][found]))[:, None]
    directions = rng.normal(size=normals.shape)
    directions = directions / np.linalg.norm(directions, axis=1, keepdims=True) + normals
    directions /= np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-30)
    bounces["origin"] = rays["origin"][found] + rays["direction"][found] * hits["distance"][found, None]
    bounces["direction"] = directions
    bounces["maximum_distance"], bounces["source_triangle"] = 1e30, hits["triangle"][found]
    return {"camera": rays, "diffuse bounce": bounces, "photon": _photon_rays(mapper, count)}


def triangles(mapper: ProgressivePhotonMapper) -> np.ndarray:
    """(n, 3, 3) float32, world space."""
    buffer = mapper.device_scene.geometry.triangles
    return buffer.read(np.dtype((np.float32, 4)), 3 * mapper.triangle_count).reshape(-1, 3, 4)[:, :, :3].copy()


def trace(mapper: ProgressivePhotonMapper, rays: np.ndarray) -> np.ndarray:
    gl = mapper.context.moderngl
    ray_buffer, hits = gl.buffer(rays.tobytes()), gl.buffer(reserve=HIT.size * len(rays))
    active = ActivePaths(mapper.context, mapper._library, "rays to measure with", "take fewer")
    active.fill(len(rays))
    mapper.acceleration.trace(ray_buffer, hits, active)
    result = np.frombuffer(hits.read(), HIT.dtype)
    for resource in (ray_buffer, hits, active):
        resource.release()
    return result


def photon_origins(mapper: ProgressivePhotonMapper) -> np.ndarray:
    """(n, 3) where an iteration's photons leave the lights, meters; sunlight starts outside of the scene."""
    return _record_photons(mapper, 1)[0]["origin"].astype(float)


def different(hits: np.ndarray, expected: np.ndarray) -> int:
    """How many HIT records differ in a bit that has a meaning."""
    unequal = hits["triangle"] != expected["triangle"]
    both = (hits["triangle"] != NO_TRIANGLE) & ~unequal
    for name in ("b1", "b2", "distance"):
        unequal |= both & (hits[name].view(np.uint32) != expected[name].view(np.uint32))
    return int(unequal.sum())


def _photon_rays(mapper: ProgressivePhotonMapper, count: int) -> np.ndarray:
    taken: list[np.ndarray] = []
    for iteration in range(1, _MOST_ITERATIONS + 1):
        taken += _record_photons(mapper, iteration)
        if sum(map(len, taken)) >= count:
            break
    rays = np.concatenate(taken)
    return rays[np.linspace(0, len(rays) - 1, min(count, len(rays))).astype(int)]


def _record_photons(mapper: ProgressivePhotonMapper, iteration: int) -> list[np.ndarray]:
    """The rays of an iteration's photons that are to be traced, a RAY array a segment."""
    taken = []
    plain = AccelerationStructure.trace

    def take(structure, rays, hits, active, *paths):
        records = np.frombuffer(rays.read(RAY.size * active.capacity), RAY.dtype)[np.sort(active.read())]
        taken.append(records[records["maximum_distance"] > 0.0])
        plain(structure, rays, hits, active, *paths)

    AccelerationStructure.trace = take
    try:
        this = Iteration(iteration, mapper.scene.settings.seed, mapper.scene.photon_count)
        for _ in trace_photons(mapper.device_scene.context, mapper.stages, this):
            pass
    finally:
        AccelerationStructure.trace = plain
    return taken

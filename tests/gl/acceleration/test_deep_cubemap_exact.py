# SPDX-License-Identifier: GPL-3.0-or-later
"""Hits equal those of a hierarchy of boxes walked by the same intersection routine, bit for bit.

Scenes of 200 to a million triangles, made and real ones; rays of all kinds that are hard for either.
"""

from collections import Counter
from pathlib import Path

import numba
import numpy as np
import pytest
from deep_cubemap_files import blend_triangles, ply_triangles
from deep_cubemap_hard_rays import KINDS, HardRays
from deep_cubemap_scenes import box, furnished_room, room_with_meshes, sphere, torus

from benchmarks.device.bounding_volumes import BoundingVolumes, build_nodes
from rppm_addon.integrator.bvh.bvh import Bvh
from rppm_addon.integrator.common.records.rays import HIT, NO_TRIANGLE
from rppm_addon.self_test.ray_queries import TracedTriangles

RAYS = 6600
"""Rays of each kind about each center: more than two million in all."""
_CHUNK = 30_000  # triangles that are tested one by one in a dispatch; llvmpipe ends loops after 65535 rounds


def teapot_in_a_stadium(_: Path) -> np.ndarray:
    """Fifteen thousand triangles of about 1e-2, in a room of 1000, where floats are 3e-5 apart.

    With a vessel of a tenth of that size all triangles share the few finest cells that it is seen in, and
    llvmpipe's 65535 rounds for the loops of eight rays together do not suffice to test them.
    """
    around = np.array([310.0, -120.0, -47.0])
    vessel = np.concatenate([sphere((0, 0, 0), 0.4, 50, bumps=0.1), torus((0.5, 0, 0), 0.16, 0.04, 35)])
    return np.concatenate([box((-500, -500, -50), (500, 500, 300), 4), vessel + around]).astype(np.float32)


SCENES = {
    "furnished room": lambda _: furnished_room(4),
    "room_10k": lambda _: room_with_meshes(10_000),
    "room_100k": lambda _: room_with_meshes(100_000),
    "room_1M": lambda _: room_with_meshes(1_000_000),
    "teapot in a stadium": teapot_in_a_stadium,
    "stanford_bunny": lambda _: ply_triangles("stanford_bunny"),
    "bmw27": lambda folder: blend_triangles("bmw27", folder, 700_000),
    "sponza_dabrovic_1M": lambda folder: blend_triangles("sponza_dabrovic_1M", folder),
    "grass_instances": lambda folder: blend_triangles("grass_instances", folder, 500_000),
}

LARGE = {
    "room_1M": "on a vertex",
    "bmw27": "in the middle",
    "sponza_dabrovic_1M": "in the middle",
    "grass_instances": "on a vertex",
}
"""The one center of scenes that take long to build."""


def centers(triangles: np.ndarray) -> dict[str, np.ndarray]:
    """Where a cubemap may be put: somewhere between the things, and the awkward places."""
    rng = np.random.default_rng(1)
    low, high = triangles.min((0, 1)).astype(float), triangles.max((0, 1)).astype(float)
    area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1)
    chosen = triangles[rng.choice(np.flatnonzero(area > 0))].astype(float)
    return {
        "in the middle": low + (high - low) * [0.47, 0.55, 0.52],
        "on a vertex": chosen[0],
        "on a triangle's plane": 3.5 * chosen[0] - 1.5 * chosen[1] - chosen[2],
        "outside": low + (high - low) * [1.4, 0.8, 0.3],
    }


def bits(hits: np.ndarray) -> np.ndarray:
    """Rows of what has a meaning."""
    rows = hits.view(np.uint32).reshape(-1, 4).copy()
    rows[hits["triangle"] == NO_TRIANGLE] = NO_TRIANGLE
    return rows


def boxes_trace(scene: TracedTriangles, volumes: BoundingVolumes, rays: np.ndarray) -> np.ndarray:
    return scene._run(rays, HIT.dtype, lambda *buffers: volumes.trace(scene.triangles, *buffers))


def tried_one_by_one(scene: TracedTriangles, rays: np.ndarray) -> np.ndarray:
    """Hits of few rays in any number of triangles, each of which is tested."""
    best = None
    for first in range(0, len(scene.host_triangles), _CHUNK):
        part = scene.host_triangles[first : first + _CHUNK]
        vertices = np.zeros((3 * len(part), 4), np.float32)
        vertices[:, :3] = part.reshape(-1, 3)
        part_rays = rays.copy()
        source = rays["source_triangle"].astype(np.int64) - first
        part_rays["source_triangle"] = np.where((source >= 0) & (source < len(part)), source, NO_TRIANGLE)
        whole = scene.triangles, scene.host_triangles
        scene.triangles, scene.host_triangles = scene.context.moderngl.buffer(vertices.tobytes()), part
        try:
            hits = scene.brute_force(part_rays)
        finally:
            scene.triangles.release()
            scene.triangles, scene.host_triangles = whole
        found = hits["triangle"] != NO_TRIANGLE
        hits["triangle"][found] += first
        if best is None:
            best = hits
        else:  # of equal distances the lower number wins, which was there before
            nearer = found & ((best["triangle"] == NO_TRIANGLE) | (hits["distance"] < best["distance"]))
            best[nearer] = hits[nearer]
    return best


@pytest.mark.long
@pytest.mark.parametrize("name", SCENES)
def test_hits_of_the_bvh_equal_those_of_the_deep_cubemap(context, library, tmp_path, name):
    """But for slivers that rounding puts past their boxes: where they differ all triangles are tested."""
    triangles = SCENES[name](tmp_path)
    place = centers(triangles)["in the middle"]
    with (
        TracedTriangles(context, library, triangles, place, 0) as scene,
        TracedTriangles(context, library, triangles, place, structure=Bvh(context, library)) as by_bvh,
    ):
        maker = HardRays(triangles, scene.center, seed=4)
        number = missed = 0
        for kind in KINDS:
            rays = maker.rays(kind, RAYS)
            hits, others = scene.trace(rays), by_bvh.trace(rays)
            different = np.flatnonzero(np.any(bits(hits) != bits(others), axis=1))
            if len(different):
                truth = tried_one_by_one(scene, rays[different])
                missed += np.count_nonzero(np.any(bits(others[different]) != bits(truth), axis=1))
            np.testing.assert_array_equal(by_bvh.occluded(rays) == 0, others["triangle"] != NO_TRIANGLE)
            number += len(rays)
    assert missed <= 1e-4 * number


@pytest.mark.long
@pytest.mark.parametrize("name", SCENES)
def test_hits_equal_those_of_boxes(context, library, tmp_path, name):
    """Where they differ all triangles are tested: it must be the boxes that missed one by rounding."""
    triangles = SCENES[name](tmp_path)
    volumes = BoundingVolumes(context, library, build_nodes(triangles))
    places = centers(triangles)
    number = found = by_boxes = 0
    wrong = []
    for place in places if len(triangles) < 200_000 else [LARGE[name]]:
        with TracedTriangles(context, library, triangles, places[place], 0) as scene:
            maker = HardRays(triangles, scene.center, seed=2)
            for kind in KINDS:
                rays = maker.rays(kind, RAYS)
                hits, expected = scene.trace(rays), boxes_trace(scene, volumes, rays)
                other = np.flatnonzero(np.any(bits(hits) != bits(expected), axis=1))
                assert len(other) < 100, f"{len(other)} differences of {kind} rays about the center {place}"
                if len(other):
                    truth = tried_one_by_one(scene, rays[other])
                    by_boxes += np.count_nonzero(np.any(bits(expected[other]) != bits(truth), axis=1))
                    for i in np.flatnonzero(np.any(bits(hits[other]) != bits(truth), axis=1)):
                        wrong.append(f"{place}, {kind}: {rays[other[i]]} hits {hits[other[i]]}, not {truth[i]}")
                occluded = scene.occluded(rays) == 0
                assert np.array_equal(occluded, hits["triangle"] != NO_TRIANGLE), f"{kind}, {place}: any hit"
                number += len(rays)
                found += np.count_nonzero(occluded)
    volumes.release()
    assert not wrong, "\n".join([f"{len(wrong)} hits differ", *wrong[:10]])
    assert found > 0.2 * number
    assert by_boxes <= 1e-4 * number


@numba.njit(cache=True)
def nearest_in_float64(triangles, origins, directions, sources):
    """Moeller and Trumbore's test of all triangles: distances (infinite where nothing is hit) and triangles."""
    count = len(origins)
    nearest, hit = np.full(count, np.inf), np.full(count, -1, np.int64)
    for ray in range(count):
        o, d = origins[ray], directions[ray]
        for i in range(len(triangles)):
            if i == sources[ray]:
                continue
            a, b, c = triangles[i, 0], triangles[i, 1], triangles[i, 2]
            e0, e1, e2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
            f0, f1, f2 = c[0] - a[0], c[1] - a[1], c[2] - a[2]
            p0, p1, p2 = d[1] * f2 - d[2] * f1, d[2] * f0 - d[0] * f2, d[0] * f1 - d[1] * f0
            volume = e0 * p0 + e1 * p1 + e2 * p2
            if volume == 0.0:
                continue
            s0, s1, s2 = o[0] - a[0], o[1] - a[1], o[2] - a[2]
            u = (s0 * p0 + s1 * p1 + s2 * p2) / volume
            if u < 0.0 or u > 1.0:
                continue
            q0, q1, q2 = s1 * e2 - s2 * e1, s2 * e0 - s0 * e2, s0 * e1 - s1 * e0
            v = (d[0] * q0 + d[1] * q1 + d[2] * q2) / volume
            t = (f0 * q0 + f1 * q1 + f2 * q2) / volume
            if v >= 0.0 and u + v <= 1.0 and t > 0.0 and t < nearest[ray]:
                nearest[ray], hit[ray] = t, i
    return nearest, hit


def edge_distance(point: np.ndarray, corners: np.ndarray) -> float:
    """Meters from a point to the nearest of a triangle's edges."""
    found = []
    for a, b in zip(corners, np.roll(corners, -1, 0)):
        along = np.clip((point - a) @ (b - a) / max((b - a) @ (b - a), 1e-300), 0.0, 1.0)
        found.append(np.linalg.norm(point - a - along * (b - a)))
    return min(found)


def explain(ray: np.void, hit: np.void, distance: float, triangle: int, triangles: np.ndarray) -> str:
    """Why a hit differs from that in float64: a tie, an edge or the start within rounding, or nothing of these.

    Rounding is that of positions as seen from the ray's origin; where a triangle is seen edge-on, its distance is
    off by as much more as it is slanted.
    """
    origin, direction = ray["origin"].astype(float), ray["direction"].astype(float)
    reach = 4.0 * np.abs(triangles - origin).max() * 2.0**-23

    def slanted(number: int) -> float:
        corners = triangles[number].astype(float)
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        return reach * np.linalg.norm(normal) / max(abs(normal @ direction), 1e-300)

    found = -1 if hit["triangle"] == NO_TRIANGLE else int(hit["triangle"])
    both = found >= 0 and triangle >= 0
    if both and abs(float(hit["distance"]) - distance) <= slanted(found) + slanted(triangle):
        return "distance within rounding" if found == triangle else "tie within rounding"
    # the nearer of the two should not, or should, have been hit
    suspects = [(n, t) for n, t in ((found, float(hit["distance"])), (triangle, distance)) if n >= 0]
    number, t = min(suspects, key=lambda suspect: suspect[1])
    if t <= slanted(number):
        return "starts on the surface within rounding"
    if edge_distance(origin + t * direction, triangles[number].astype(float)) <= reach + 1e-6 * t:
        return "edge within rounding"
    corners = triangles[number].astype(float)
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    normal /= max(np.linalg.norm(normal), 1e-300)
    if np.abs((corners - origin) @ normal).max() <= reach and abs(normal @ direction) <= 1e-4:
        return "runs in the triangle's plane"
    return ""


@pytest.mark.parametrize("name, count", [("furnished room", 20_000), ("room_10k", 2000)])
def test_differences_from_float64_are_explained(context, library, name, count):
    triangles = SCENES[name](None)
    reasons = Counter()
    number = 0
    with TracedTriangles(context, library, triangles, centers(triangles)["in the middle"], 0) as scene:
        maker = HardRays(triangles, scene.center, seed=3)
        for kind in KINDS:
            rays = maker.rays(kind, count)
            hits = scene.trace(rays)
            distances, expected = nearest_in_float64(
                triangles.astype(float),
                rays["origin"].astype(float),
                rays["direction"].astype(float),
                rays["source_triangle"].astype(np.int64),
            )
            triangle = np.where(hits["triangle"] == NO_TRIANGLE, -1, hits["triangle"].astype(np.int64))
            close = np.abs(hits["distance"] - np.where(expected < 0, 0, distances)) <= 1e-6 * hits["distance"]
            for i in np.flatnonzero((triangle != expected) | ((expected >= 0) & ~close)):
                reason = explain(rays[i], hits[i], distances[i], int(expected[i]), triangles)
                assert reason, f"{kind}: {rays[i]} hits {hits[i]}, in float64 {expected[i]} at {distances[i]}"
                reasons[reason] += 1
            number += count
    assert reasons.total() < 0.2 * number

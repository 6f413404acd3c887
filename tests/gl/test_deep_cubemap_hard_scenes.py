# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact hits where a cubemap has a hard time: thin shells, far meshes, crowds in few cells, ties, centres at surfaces.

Hits equal those of a hierarchy of boxes walked by the same intersection routine, bit for bit, but for what the
routine itself makes up: of slivers seen edge-on it computes areas that are nothing but rounding, and from these a
distance at which the ray is not at the triangle at all. No structure in space finds such a hit for certain. Every
one of them is checked to be that, and that the hits agree without it.
"""

from collections import Counter

import numpy as np
import pytest
from deep_cubemap_device import Scene, ray_records
from deep_cubemap_hard_rays import KINDS, HardRays
from deep_cubemap_hard_scenes import SCENES, SHELL_RADIUS, hard_centres, thin_shell
from test_deep_cubemap_exact import (
    BoundingVolumes,
    bits,
    boxes_trace,
    build_nodes,
    explain,
    nearest_in_float64,
    tried_one_by_one,
)

from rppm_addon.integrator.records import NO_TRIANGLE

RAYS = 1000
"""Of each kind about each centre: more than nine hundred thousand in all."""
_OFF = 1e-4
"""A hit this far from its triangle, as a share of the scene's radius, is made up: a hundred margins of the cubemap."""


def distance_to_triangle(point: np.ndarray, corners: np.ndarray) -> float:
    """Metres, in float64; degenerate triangles are taken for their edges."""
    sides = np.roll(corners, -1, 0) - corners
    normal = np.cross(sides[0], -sides[2])
    length = np.linalg.norm(normal)
    if length > 0 and np.all(np.cross(sides, point - corners) @ normal >= 0):
        return abs((point - corners[0]) @ normal) / length
    along = np.sum((point - corners) * sides, 1) / np.maximum(np.sum(sides * sides, 1), 1e-300)
    return float(np.linalg.norm(point - corners - np.clip(along, 0, 1)[:, None] * sides, axis=1).min())


def is_made_up(ray: np.void, hit: np.void, scene: Scene) -> bool:
    """Whether the ray is nowhere near the triangle at the distance of the hit."""
    if hit["triangle"] == NO_TRIANGLE:
        return False
    point = ray["origin"].astype(float) + float(hit["distance"]) * ray["direction"].astype(float)
    corners = scene.host_triangles[hit["triangle"]].astype(float)
    radius = np.linalg.norm(scene.host_triangles.reshape(-1, 3) - scene.centre, axis=1).max()
    return distance_to_triangle(point, corners) > _OFF * radius


def made_up_before(scene: Scene, ray: np.ndarray, hit: np.ndarray) -> int:
    """How many hits the routine makes up before the one given is the nearest of all; -1 if it is not that then either.

    ``ray`` and ``hit``: arrays of one record.
    """
    whole = scene.host_triangles
    scene.host_triangles = whole.copy()
    try:
        for number in range(20):
            nearest = tried_one_by_one(scene, ray)
            if np.array_equal(bits(nearest), bits(hit)):
                return number
            if not is_made_up(ray[0], nearest[0], scene):
                return -1
            scene.host_triangles[nearest["triangle"][0]] = np.nan
    finally:
        scene.host_triangles = whole
    return -1


def compare(scene: Scene, volumes: BoundingVolumes, rays: np.ndarray, kind: str, counts: Counter) -> list[str]:
    """What is wrong with the scene's hits; counts rays, hits, and the routine's made-up hits."""
    hits, expected = scene.trace(rays), boxes_trace(scene, volumes, rays)
    wrong = []
    differing = np.flatnonzero(np.any(bits(hits) != bits(expected), axis=1))
    assert len(differing) < 0.02 * len(rays), f"{len(differing)} differences of {kind} rays"
    for i in differing:
        for name, found in (("the cubemap", hits), ("the boxes", expected)):
            number = made_up_before(scene, rays[i : i + 1], found[i : i + 1])
            counts[f"made up before the hit of {name}"] += max(number, 0)
            if number < 0 and name == "the cubemap":
                wrong.append(f"{kind}: {rays[i]} hits {hits[i]}; by boxes {expected[i]}")
    free = hits["triangle"] == NO_TRIANGLE
    different_occlusion = np.count_nonzero((scene.occluded(rays) == 1) != free)
    if different_occlusion:
        wrong.append(f"{kind}: any hit decides otherwise for {different_occlusion} rays")
    counts["rays"] += len(rays)
    counts["hits"] += np.count_nonzero(~free)
    return wrong


@pytest.mark.parametrize("name", SCENES)
def test_hits_equal_those_of_boxes(context, library, name):
    triangles = SCENES[name]()
    volumes = BoundingVolumes(context, library, build_nodes(triangles))
    counts, wrong = Counter(), []
    for number, (place, centre) in enumerate(hard_centres(triangles, seed=1).items()):
        # every other centre by the compute shader
        with Scene(context, library, triangles, centre, 0, rasterize=number % 2 == 0) as scene:
            maker = HardRays(triangles, scene.centre, seed=2)
            for kind in KINDS:
                found = compare(scene, volumes, maker.rays(kind, RAYS), kind, counts)
                wrong += [f"centre {place}, {text}" for text in found]
    volumes.release()
    print(f"\n{name}: {len(triangles)} triangles, {dict(counts)}")
    assert not wrong, "\n".join([f"{len(wrong)} differences", *wrong[:10]])
    assert counts["hits"] > 0.3 * counts["rays"]
    assert counts["made up before the hit of the cubemap"] <= 1e-4 * counts["rays"]


@pytest.mark.parametrize("gap", [1e-3, 1e-4, 1e-5])
def test_nothing_escapes_from_between_thin_shells(context, library, gap):
    """Rays that start within the shell stop at it, rays from inside at the inner sphere."""
    triangles = thin_shell(gap)
    inner = len(triangles) // 2
    volumes = BoundingVolumes(context, library, build_nodes(triangles))
    rng = np.random.default_rng(9)
    count = 20_000
    weights = rng.dirichlet((1, 1, 1), count)[:, :, None]
    corners = triangles[rng.integers(0, inner, count)].astype(float)
    origins = np.sum(weights * corners, 1)
    directions = rng.normal(size=(count, 3))
    # half of them run along the shell
    outwards = origins / np.linalg.norm(origins, axis=1, keepdims=True)
    directions[::2] -= np.sum(directions * outwards, 1)[::2, None] * outwards[::2]
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    between = ray_records(origins * (1 + gap * rng.uniform(0.1, 0.9, (count, 1))), directions)
    inside = ray_records(origins * rng.uniform(0.0, 1 - 2 * gap, (count, 1)), directions)
    for centre in ((0.0, 0.0, 0.0), origins[0] * (1 + 0.5 * gap), (2.0, 0.3, 0.1)):
        with Scene(context, library, triangles, centre, 0) as scene:
            assert not compare(scene, volumes, between, "between", Counter())
            hits = scene.trace(between)
            assert np.all(hits["triangle"] != NO_TRIANGLE)
            assert np.all(hits["distance"] <= 2.01 * SHELL_RADIUS)
            assert np.all(scene.trace(inside)["triangle"] < inner)
    volumes.release()


@pytest.mark.parametrize("name", [name for name in SCENES if name != "dense meshes"])
def test_differences_from_float64_are_explained(context, library, name):
    triangles = SCENES[name]()
    reasons, count = Counter(), 200
    with Scene(context, library, triangles, hard_centres(triangles, seed=1)["at the origin"], 0) as scene:
        maker = HardRays(triangles, scene.centre, seed=3)
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
    print(f"\n{name}, {count * len(KINDS)} rays: {dict(reasons)}")

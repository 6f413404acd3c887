# SPDX-License-Identifier: GPL-3.0-or-later
"""Small random scenes on a coarse grid: coincident, degenerate, edge-on and overlapping triangles.

All coordinates are multiples of 1/4, so that rays meet edges, vertices, the center's planes and
cell borders exactly, again and again.
"""

import hypothesis.extra.numpy as arrays
import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rppm_addon.integrator.common.records.rays import NO_TRIANGLE
from rppm_addon.self_test.ray_queries import TracedTriangles, ray_records

grid = st.integers(-4, 4).map(lambda i: i / 4)
triangles_on_grid = st.integers(1, 12).flatmap(lambda n: arrays.arrays(np.float32, (n, 3, 3), elements=grid))
points_on_grid = arrays.arrays(np.float32, (32, 3), elements=grid)
resolutions = st.sampled_from([4, 8, 16, 64])
ODD = ["sliver", "huge", "needle", "duplicate", "point", "line", "plain"]


def tried(count: int):
    """So many examples, the same each time."""
    return settings(max_examples=count, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


def vectors(shape, least: int, most: int):
    return arrays.arrays(np.float32, shape, elements=st.floats(least, most, width=32))


def check(context, library, triangles, center, origins, targets, resolution):
    directions = (targets - origins).astype(np.float64)
    directions /= np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-30)
    rays = ray_records(origins, directions.astype(np.float32))
    rays["source_triangle"][::4] = 0
    with TracedTriangles(context, library, triangles, center, resolution) as scene:
        hits, expected, free = scene.trace(rays), scene.brute_force(rays), scene.occluded(rays)
    rays_without_direction = np.all(rays["direction"] == 0, axis=1)
    expected["triangle"][rays_without_direction] = NO_TRIANGLE
    np.testing.assert_array_equal(hits["triangle"], expected["triangle"])
    hit = hits["triangle"] != NO_TRIANGLE
    np.testing.assert_array_equal(hits["distance"][hit], expected["distance"][hit])
    np.testing.assert_array_equal(free, ~hit)


@tried(150)
@given(triangles_on_grid, arrays.arrays(np.float32, 3, elements=grid), points_on_grid, points_on_grid, resolutions)
def test_soups_about_any_grid_point(context, library, triangles, center, origins, targets, resolution):
    check(context, library, triangles, center, origins, targets, resolution)


@tried(50)
@given(triangles_on_grid, vectors(3, -1, 1), vectors((32, 3), -2, 2), points_on_grid, resolutions)
def test_soups_about_any_point(context, library, triangles, center, origins, targets, resolution):
    check(context, library, triangles, center, origins, targets, resolution)


@st.composite
def hard_triangles(draw):
    """Slivers, huge triangles, needles through the center, duplicates, degenerate ones; and the center."""
    seed = draw(st.integers(0, 2**32 - 1))
    kinds = draw(st.lists(st.sampled_from(ODD), min_size=1, max_size=14))
    place = draw(st.sampled_from(["anywhere", "vertex", "edge", "plane"]))
    rng = np.random.default_rng(seed)
    center = rng.uniform(-0.5, 0.5, 3).astype(np.float32)
    triangles = []
    for kind in kinds:
        corners = rng.uniform(-1, 1, (3, 3))
        if kind == "sliver":
            corners[2] = corners[0] + (corners[1] - corners[0]) * rng.random() + rng.normal(size=3) * 1e-6
        elif kind == "huge":
            corners *= 1e4
        elif kind == "needle":
            corners[1] = 2 * center.astype(float) - corners[0]
            corners[2] = corners[1] + rng.normal(size=3) * 1e-6
        elif kind == "duplicate" and triangles:
            corners = triangles[rng.integers(0, len(triangles))][rng.permutation(3)]
        elif kind == "point":
            corners[:] = corners[0]
        elif kind == "line":
            corners[2] = corners[rng.integers(0, 2)]
        triangles.append(corners)
    triangles = np.array(triangles, np.float32)
    if place != "anywhere":
        weights = {"vertex": (1, 0, 0), "edge": (0.5, 0.5, 0), "plane": (2, -3, 2)}[place]
        center = (np.array(weights) @ triangles[rng.integers(0, len(triangles))]).astype(np.float32)
    return triangles, center, rng


@tried(150)
@given(hard_triangles(), st.sampled_from([0, 4, 64, 1024]))
def test_soups_of_hard_triangles(context, library, scene, resolution):
    triangles, center, rng = scene
    corners = triangles[rng.integers(0, len(triangles), 64)].astype(float)
    weights = rng.dirichlet((0.5, 0.5, 0.5), 64)
    weights[:16] = np.eye(3)[rng.integers(0, 3, 16)]
    targets = np.einsum("nk,nkx->nx", weights, corners)
    targets[32:40] = center
    origins = rng.uniform(-1.5, 1.5, (64, 3)).astype(np.float32)
    origins[40:48] = center
    check(context, library, triangles, center, origins, targets, resolution)

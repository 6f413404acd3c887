# SPDX-License-Identifier: GPL-3.0-or-later
"""Small random scenes on a coarse grid: coincident, degenerate, edge-on and overlapping triangles.

All coordinates are multiples of 1/4, so that rays meet edges, vertices, the centre's planes and
cell borders exactly, again and again.
"""

import hypothesis.extra.numpy as arrays
import numpy as np
from deep_cubemap_device import Scene, ray_records
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rppm_addon.integrator.records import NO_TRIANGLE

grid = st.integers(-4, 4).map(lambda i: i / 4)
triangles_on_grid = st.integers(1, 12).flatmap(lambda n: arrays.arrays(np.float32, (n, 3, 3), elements=grid))
points_on_grid = arrays.arrays(np.float32, (32, 3), elements=grid)
resolutions = st.sampled_from([4, 8, 16, 64])


def check(context, library, triangles, centre, origins, targets, resolution):
    directions = (targets - origins).astype(np.float64)
    directions /= np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-30)
    rays = ray_records(origins, directions.astype(np.float32))
    rays["source_triangle"][::4] = 0
    with Scene(context, library, triangles, centre, resolution) as scene:
        hits, expected, free = scene.trace(rays), scene.brute_force(rays), scene.occluded(rays)
    rays_without_direction = np.all(rays["direction"] == 0, axis=1)
    expected["triangle"][rays_without_direction] = NO_TRIANGLE
    np.testing.assert_array_equal(hits["triangle"], expected["triangle"])
    hit = hits["triangle"] != NO_TRIANGLE
    np.testing.assert_array_equal(hits["distance"][hit], expected["distance"][hit])
    np.testing.assert_array_equal(free, ~hit)


@settings(max_examples=150, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(triangles_on_grid, arrays.arrays(np.float32, 3, elements=grid), points_on_grid, points_on_grid, resolutions)
def test_soups_about_any_grid_point(context, library, triangles, centre, origins, targets, resolution):
    check(context, library, triangles, centre, origins, targets, resolution)


@settings(max_examples=50, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(
    triangles_on_grid,
    arrays.arrays(np.float32, 3, elements=st.floats(-1, 1, width=32)),
    arrays.arrays(np.float32, (32, 3), elements=st.floats(-2, 2, width=32)),
    points_on_grid,
    resolutions,
)
def test_soups_about_any_point(context, library, triangles, centre, origins, targets, resolution):
    check(context, library, triangles, centre, origins, targets, resolution)

# SPDX-License-Identifier: GPL-3.0-or-later
"""What building must guarantee, without a ray: every point of every triangle is on file.

A ray that is computed in float32 comes to a surface at points that are off by rounding, so the
points are shaken by as much.
"""

import numpy as np
import pytest
from deep_cubemap_device import Scene
from deep_cubemap_scenes import CENTRES, furnished_room, room_with_meshes
from deep_cubemap_structure import block_indices, locate, read_structure

POINTS = 200_000


def points_on(triangles: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Triangle numbers and points on them (float64); many on edges and vertices."""
    chosen = rng.integers(0, len(triangles), POINTS)
    weights = rng.dirichlet((0.3, 0.3, 0.3), POINTS)
    weights[: POINTS // 3, 2] = 0.0
    weights[: POINTS // 3] /= weights[: POINTS // 3].sum(1, keepdims=True)
    weights[: POINTS // 20] = np.eye(3)[rng.integers(0, 3, POINTS // 20)]
    return chosen, np.einsum("nk,nkx->nx", weights, triangles[chosen].astype(float))


@pytest.mark.parametrize("resolution", [64, 128])
@pytest.mark.parametrize("place", CENTRES)
@pytest.mark.parametrize("name", ["furnished room", "room with meshes"])
def test_every_point_is_on_file(context, library, name, place, resolution):
    triangles = furnished_room(4) if name == "furnished room" else room_with_meshes(10_000)
    rng = np.random.default_rng(21)
    with Scene(context, library, triangles, CENTRES[place], resolution) as scene:
        structure = read_structure(scene.cubemap)
        centre = scene.centre.astype(float)
    chosen, points = points_on(triangles, rng)
    points = points - centre + rng.uniform(-4e-7, 4e-7, points.shape)
    outside_core = np.linalg.norm(points, axis=1) > structure.state["core_radius"]
    chosen, points = chosen[outside_core], points[outside_core]
    face, cell, depth = locate(points, resolution)
    levels = block_indices(face, cell, resolution)

    for level, index in enumerate(levels):
        blocks = structure.cells[index]
        assert np.all(blocks["slices"] != 0), f"level {level}: a block with triangles is empty"
        assert np.all((structure.near[index] <= depth) & (depth <= structure.far[index])), f"level {level}: depth range"
        bit = np.clip(depth * structure.state["slices_per_metre"], 0, 31).astype(np.uint32)
        assert np.all((blocks["slices"] >> bit) & 1), f"level {level}: depth slice"

    near, far = structure.near[levels[0]].astype(float), structure.far[levels[0]].astype(float)
    fraction = (depth - near) / np.maximum(far - near, 1e-30)
    count = structure.bin_counts[levels[0]]
    bins = np.clip(np.floor(fraction * count), 0, count - 1).astype(np.int64)
    most = 1 << 16

    def key(cell, bin_, triangle):
        return (cell * most + bin_) * most + triangle

    assert len(triangles) < most
    keys = key(*structure.entries[:, :3].T)
    order = np.argsort(keys)
    wanted = key(levels[0], bins, chosen)
    found = order[np.minimum(np.searchsorted(keys[order], wanted), len(order) - 1)]
    listed = keys[found] == wanted
    assert np.all(listed), f"{np.count_nonzero(~listed)} of {len(points)} points are in no list"
    least, greatest = structure.entries[found, 4], structure.entries[found, 5]
    quantised = fraction * 65535
    assert np.all((least <= quantised + 1) & (quantised - 1 <= greatest))


def test_continued_marks_all_but_a_triangles_first_bin(context, library):
    with Scene(context, library, room_with_meshes(10_000), CENTRES["plain"], 64) as scene:
        entries = read_structure(scene.cubemap).entries
    cell, bin_, triangle, continued = entries[:, 0], entries[:, 1], entries[:, 2], entries[:, 3]
    order = np.lexsort((bin_, triangle, cell))
    cell, bin_, triangle, continued = cell[order], bin_[order], triangle[order], continued[order]
    same = (cell[1:] == cell[:-1]) & (triangle[1:] == triangle[:-1])
    assert np.all(continued[1:] == same) and continued[0] == 0
    assert np.all(bin_[1:][same] == bin_[:-1][same] + 1)  # consecutive bins, and none twice


def test_depth_bins_follow_a_cells_content(context, library):
    """Cells with one or two triangles have one bin; crowded ones many."""
    with Scene(context, library, room_with_meshes(10_000), CENTRES["plain"], 32) as scene:
        structure = read_structure(scene.cubemap)
    first_entries = structure.entries[structure.entries[:, 3] == 0]
    held = np.bincount(first_entries[:, 0], minlength=len(structure.bin_counts))
    assert np.all(structure.bin_counts[(held > 0) & (held <= 2)] == 1)
    assert np.all(structure.bin_counts[held == 0] == 0)
    assert np.all(structure.bin_counts[held > 2] <= held[held > 2])
    assert structure.bin_counts.max() >= 16


def test_lists_are_the_same_every_time(context, library):
    """But for the order within a bin, which no result depends on."""
    triangles = room_with_meshes(10_000)
    with Scene(context, library, triangles, CENTRES["plain"], 64) as scene:
        first = read_structure(scene.cubemap)
        scene.build(64)
        second = read_structure(scene.cubemap)
    for structure in (first, second):
        structure.entries = structure.entries[np.lexsort(structure.entries.T)]
    np.testing.assert_array_equal(first.entries, second.entries)
    np.testing.assert_array_equal(first.near, second.near)
    np.testing.assert_array_equal(first.cells["slices"], second.cells["slices"])


@pytest.mark.parametrize("place", CENTRES)
def test_the_compute_route_builds_the_same(context, library, place):
    """Rasterized rectangles and those walked by a compute shader leave the same fragments behind."""
    triangles = room_with_meshes(10_000)
    structures = []
    for rasterize in (True, False):
        with Scene(context, library, triangles, CENTRES[place], 128, rasterize) as scene:
            structure = read_structure(scene.cubemap)
            structure.entries = structure.entries[np.lexsort(structure.entries.T)]
            structures.append(structure)
    first, second = structures
    np.testing.assert_array_equal(first.entries, second.entries)
    np.testing.assert_array_equal(first.near, second.near)
    np.testing.assert_array_equal(first.far, second.far)

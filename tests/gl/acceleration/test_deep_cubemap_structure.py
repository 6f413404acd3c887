# SPDX-License-Identifier: GPL-3.0-or-later
"""Guarantees of building, without a ray: every point of every triangle is on file.

A ray that is computed in float32 comes to a surface at points that are off by rounding, so the
points are shaken by as much.
"""

import numpy as np
import pytest
from deep_cubemap_scenes import CENTERS, furnished_room, room_with_meshes, sphere
from deep_cubemap_structure import BEFORE, BEHIND, BINS, LIST, TILE, Structure, as_sets, read_structure

from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap
from rppm_addon.integrator.deep_cubemap.records import MAX_JOIN
from rppm_addon.self_test.ray_queries import TracedTriangles

POINTS = 200_000
BASE_LEVEL = 2
MAX_LISTED = 6
MAX_TOUCHED = 7  # of the 16 cells of a tile by each triangle, on average


def points_on(triangles: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Triangle numbers and points on them (float64); many on edges and vertices."""
    chosen = rng.integers(0, len(triangles), POINTS)
    weights = rng.dirichlet((0.3, 0.3, 0.3), POINTS)
    weights[: POINTS // 3, 2] = 0.0
    weights[: POINTS // 3] /= weights[: POINTS // 3].sum(1, keepdims=True)
    weights[: POINTS // 20] = np.eye(3)[rng.integers(0, 3, POINTS // 20)]
    return chosen, np.einsum("nk,nkx->nx", weights, triangles[chosen].astype(float))


def spread(triangle_count: int) -> np.ndarray:
    """A crowd of small triangles in the room, such as makes cells with bins of few slices."""
    rng = np.random.default_rng(5)
    crowd = np.array([0.3, 0.4, 0.5]) + rng.normal(size=(triangle_count, 1, 3)) * 0.02
    sizes = 10.0 ** rng.uniform(-5, -0.5, (triangle_count, 1, 1))
    crowd = crowd + rng.normal(size=(triangle_count, 3, 3)) * sizes
    return np.concatenate([furnished_room(2), np.clip(crowd, -1, 1)]).astype(np.float32)


SCENES = {
    "furnished room": lambda: furnished_room(4),
    "room with meshes": lambda: room_with_meshes(10_000),
    "crowd": lambda: spread(4000),
}


@pytest.mark.parametrize("resolution", [0, 64, 128])
@pytest.mark.parametrize("place", CENTERS)
@pytest.mark.parametrize("name", SCENES)
def test_every_point_is_on_file(context, library, name, place, resolution):
    triangles = SCENES[name]()
    rng = np.random.default_rng(21)
    with TracedTriangles(context, library, triangles, CENTERS[place], resolution) as scene:
        structure = read_structure(scene.structure)
        center = scene.center.astype(float)
    chosen, points = points_on(triangles, rng)
    points = points - center + rng.uniform(-4e-7, 4e-7, points.shape)
    outside_core = np.linalg.norm(points, axis=1) > structure.state["core_radius"]
    chosen, points = chosen[outside_core], points[outside_core]
    levels, depths = structure.rows_of(points)
    codes = structure.codes(depths)

    leaves = levels[0]
    for level, all_rows in enumerate(levels):
        inside = all_rows >= 0
        rows, inner_codes = all_rows[inside], codes[inside]
        assert np.all(structure.cells["slices"][rows] != 0), f"level {level}: a cell with triangles is empty"
        within = (structure.near[rows] <= inner_codes) & (inner_codes <= structure.far[rows])
        assert np.all(within), f"level {level}: depth range"
        part = structure.parts(rows, inner_codes, 32)
        assert np.all(structure.cells["slices"][rows] >> part & 1), f"level {level}: depth slice"
        leaves = np.where(inside, all_rows, leaves)

    kinds = structure.kind[leaves]
    assert np.all((kinds == LIST) | (kinds == BINS))
    bins = np.where(kinds == BINS, structure.bins(leaves, codes), 0)
    assert np.all(bins < np.maximum(structure.bin_counts[leaves], 1))

    def key(row, bin_, triangle):
        return ((row << 12) + bin_ << 16) + triangle

    assert len(triangles) < 1 << 16 and structure.bin_counts.max() < 1 << 12
    keys = key(*structure.entries[:, :3].T)
    order = np.argsort(keys)
    wanted = key(leaves, bins, chosen)
    found = order[np.minimum(np.searchsorted(keys[order], wanted), len(order) - 1)]
    listed = keys[found] == wanted
    assert np.all(listed), f"{np.count_nonzero(~listed)} of {len(points)} points are in no list"
    least, greatest = structure.entries[found, 4], structure.entries[found, 5]
    fraction = structure.parts(leaves, codes, 1 << 16)
    assert np.all((least <= fraction) & (fraction <= greatest))


@pytest.mark.parametrize("resolution", [0, 16, 64])
@pytest.mark.parametrize("name", SCENES)
def test_marks_tell_of_the_bins_before_and_behind(context, library, name, resolution):
    with TracedTriangles(context, library, SCENES[name](), CENTERS["plain"], resolution) as scene:
        structure = read_structure(scene.structure)
    row, bin_, triangle, marks = structure.entries[:, :4].T
    order = np.lexsort((bin_, triangle, row))
    row, bin_, triangle, marks = row[order], bin_[order], triangle[order], marks[order]
    same = (row[1:] == row[:-1]) & (triangle[1:] == triangle[:-1])
    np.testing.assert_array_equal((marks[1:] & BEFORE) != 0, same)
    np.testing.assert_array_equal((marks[:-1] & BEHIND) != 0, same)
    assert not marks[0] & BEFORE and not marks[-1] & BEHIND
    assert np.all(bin_[1:][same] == bin_[:-1][same] + 1)  # consecutive bins, and none twice
    whole = structure.entries[order][:, 4:]
    assert np.all(whole[1:][same] == whole[:-1][same])  # the same interval in all of them
    assert np.all(whole[:, 0] <= whole[:, 1])
    if resolution == 16 and name != "furnished room":
        assert np.count_nonzero(same) > 100


def test_lists_are_for_few_triangles_and_bins_for_many(context, library):
    used = set()
    for name in SCENES:
        for resolution in (0, 16, 64):
            with TracedTriangles(context, library, SCENES[name](), CENTERS["plain"], resolution) as scene:
                structure = read_structure(scene.structure)
            held = np.bincount(distinct(structure)[:, 0], minlength=len(structure.kind))
            leaf, binned = structure.kind != TILE, structure.kind == BINS
            np.testing.assert_array_equal(held[leaf] == 0, structure.kind[leaf] == -1)
            np.testing.assert_array_equal(leaf & (held > MAX_LISTED), binned)
            assert np.all(structure.cells["slices"][leaf & (held == 0)] == 0)
            most = int(structure.state["max_bins"])
            assert np.all(structure.bin_counts[binned] >= 1)
            assert np.all(structure.bin_counts[binned] <= np.minimum(held[binned], most))
            # each bin begins and ends at a slice in use, so that none is empty unless a slice was cut
            joined = binned & (structure.cells["content"] & 15 <= MAX_JOIN)
            filled = np.bincount(np.unique(structure.entries[:, :2], axis=0)[:, 0], minlength=len(structure.kind))
            np.testing.assert_array_equal(filled[joined], structure.bin_counts[joined])
            used |= set(structure.cells["content"][binned] & 15)
    assert min(used) < 5 < max(used), "slices are both joined and cut"


def distinct(structure: Structure) -> np.ndarray:
    """(row, triangle) of all leaves, each once."""
    return np.unique(structure.entries[:, [0, 2]], axis=0)


def clipped_extent(triangle: np.ndarray, face: int) -> np.ndarray | None:
    """Least and greatest position, 0 to 1, of a triangle about the center as seen on a face; None if it is not."""
    axis = face >> 1
    turned = triangle[:, [(axis + 1) % 3, (axis + 2) % 3, axis]] * [1, 1, -1 if face & 1 else 1]
    polygon = list(turned)
    for plane in np.array([[1, 0, 1], [-1, 0, 1], [0, 1, 1], [0, -1, 1]]):
        clipped = []
        for a, b in zip(polygon, polygon[1:] + polygon[:1]):
            inside_a, inside_b = a @ plane, b @ plane
            if inside_a >= 0:
                clipped.append(a)
            if (inside_a >= 0) != (inside_b >= 0):
                clipped.append(a + (b - a) * (inside_a / (inside_a - inside_b)))
        polygon = clipped
    points = np.array(polygon).reshape(-1, 3)
    if not len(points) or points[:, 2].min() < 1e-3:
        return None
    positions = points[:, :2] / points[:, 2:] * 0.5 + 0.5
    return np.concatenate([positions.min(0), positions.max(0)])


def touched_cells(extents: np.ndarray, x: int, y: int, side: int, slack: float) -> int:
    """Cells of the tile that would divide a cell that extents touch, added up; at least one each."""
    first = np.floor((extents[:, :2] - slack) * side * 4) - [4 * x, 4 * y]
    last = np.floor((extents[:, 2:] + slack) * side * 4) - [4 * x, 4 * y]
    return int((np.clip(last, 0, 3) - np.clip(first, 0, 3) + 1).prod(1).sum())


@pytest.mark.parametrize("name", SCENES)
def test_cells_that_hold_much_are_divided_where_that_gains(context, library, name):
    triangles, resolution = SCENES[name](), 1024
    with TracedTriangles(context, library, triangles, CENTERS["plain"], resolution) as scene:
        structure = read_structure(scene.structure)
        about = triangles.astype(float) - scene.center.astype(float)
    # triangles of each cell, handed up from the leaves
    pairs, held = distinct(structure), {}
    parent = np.full(len(structure.kind), -1)
    divided = np.flatnonzero(structure.kind == TILE)
    parent[structure.children[divided]] = divided[:, None]
    while len(pairs):
        order = np.argsort(pairs[:, 0], kind="stable")
        rows, starts = np.unique(pairs[order, 0], return_index=True)
        for row, group in zip(rows, np.split(pairs[order, 1], starts[1:])):
            held[row] = np.union1d(held.get(row, group), group)
        pairs = np.stack([parent[pairs[:, 0]], pairs[:, 1]], 1)
        pairs = np.unique(pairs[pairs[:, 0] >= 0], axis=0)
    extents, seen = {}, set()
    rng = np.random.default_rng(6)
    levels = int(np.log2(resolution)) // 2
    for row in rng.permutation([row for row in held if structure.level[row] >= BASE_LEVEL])[:4000]:
        is_divided = structure.kind[row] == TILE
        if structure.level[row] == levels:
            assert not is_divided
            continue
        face = structure.face[row]
        found = []
        for triangle in held[row]:
            if (face, triangle) not in extents:
                extents[face, triangle] = clipped_extent(about[triangle], face)
            found.append(extents[face, triangle])
        if any(extent is None for extent in found):
            continue  # touched by the margin only, or near the center
        side = structure.root_side << (2 * int(structure.level[row]))
        x, y = structure.x[row], structure.y[row]
        min_gain = int(structure.state["min_gain"])

        number = len(found)

        def gains(touched, number=number, min_gain=min_gain):
            return touched <= MAX_TOUCHED * number and touched + 16 * min_gain < 16 * number

        if is_divided:
            assert gains(touched_cells(np.array(found), x, y, side, 0.0))
        else:
            assert not gains(touched_cells(np.array(found), x, y, side, 3e-5))
        seen.add(bool(is_divided))
    assert seen == ({False} if name == "furnished room" else {False, True})


@pytest.mark.parametrize("max_bins", [1, 1024])
def test_other_numbers_of_bins(context, library, max_bins):
    with TracedTriangles(context, library, SCENES["crowd"](), CENTERS["plain"], 64) as scene:
        scene.structure.release()
        scene.structure = DeepCubemap(context, library, True, max_bins=max_bins)
        scene.build(64)
        structure = read_structure(scene.structure)
    assert structure.state["max_bins"] == max_bins
    assert structure.bin_counts.max() <= max_bins
    held = np.bincount(distinct(structure)[:, 0], minlength=len(structure.kind))
    assert np.all(structure.kind[held > MAX_LISTED] == BINS)


def assert_same(first: Structure, second: Structure) -> None:
    for one, other in zip(as_sets(first), as_sets(second)):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("name", SCENES)
def test_lists_are_the_same_every_time(context, library, name):
    """But for the order of cells and within a bin, which no result depends on."""
    with TracedTriangles(context, library, SCENES[name](), CENTERS["plain"], 256) as scene:
        first = read_structure(scene.structure)
        scene.build(64)
        scene.build(256)
        second = read_structure(scene.structure)
    assert_same(first, second)


@pytest.mark.parametrize("place", CENTERS)
@pytest.mark.parametrize("name", SCENES)
def test_the_compute_route_builds_the_same(context, library, name, place):
    """Rasterized rectangles and those walked by a compute shader leave the same fragments behind."""
    triangles = SCENES[name]()
    structures = []
    for rasterize in (True, False):
        with TracedTriangles(context, library, triangles, CENTERS[place], 0, rasterize) as scene:
            structures.append(read_structure(scene.structure))
    assert_same(*structures)


def test_small_things_in_the_distance_get_small_cells(context, library):
    """A bare room stays coarse; a detailed ball of a hundredth of its size gets the finest cells, nothing else does."""
    ball, radius = np.array([0.7, 0.3, 0.3]), 0.01
    triangles = np.concatenate([furnished_room(1), sphere(ball, radius, 70).astype(np.float32)])
    with TracedTriangles(context, library, furnished_room(1), CENTERS["plain"], 0) as scene:
        bare = read_structure(scene.structure)
    with TracedTriangles(context, library, triangles, CENTERS["plain"], 0) as scene:
        detailed = read_structure(scene.structure)
    assert bare.level.max() == BASE_LEVEL and detailed.level.max() >= BASE_LEVEL + 3
    finest = detailed.level == detailed.level.max()
    entries = detailed.entries[finest[detailed.entries[:, 0]]]
    assert len(entries) > 1000 and np.mean(entries[:, 2] >= len(furnished_room(1))) > 0.8
    assert len(detailed.kind) < len(bare.kind) + len(triangles)
    x, y = (detailed.x[finest], detailed.y[finest])
    side = detailed.root_side << 2 * int(detailed.level.max())
    assert np.all(detailed.face[finest] == 0)
    away = ball - np.array(CENTERS["plain"])
    for cells, lateral in ((x, away[1]), (y, away[2])):
        seen = np.abs((cells + 0.5) / side * 2 - 1 - lateral / away[0]) * away[0]
        assert seen.max() < 3 * radius

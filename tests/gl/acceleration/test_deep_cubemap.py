# SPDX-License-Identifier: GPL-3.0-or-later
"""Hits through the deep cubemap are those of testing every triangle."""

import re

import numpy as np
import pytest
from deep_cubemap_rays import KINDS, make_rays
from deep_cubemap_reference import Reference
from deep_cubemap_scenes import CENTERS, PLAIN, bits, box, furnished_room, room_with_meshes
from support.families import some_each_time

from rppm_addon.gl.context.context import Context
from rppm_addon.integrator.common.records.rays import NO_TRIANGLE
from rppm_addon.integrator.deep_cubemap import build_buffers
from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap
from rppm_addon.scene.errors import DeviceError
from rppm_addon.self_test.ray_queries import TracedTriangles, ray_records


def different(hits: np.ndarray, expected: np.ndarray) -> int:
    """Rays whose triangle differs or whose distance does, by more than an intersection rounds.

    Devices may round a division otherwise than the CPU does, hence not bit for bit.
    """
    same_triangle = hits["triangle"] == expected["triangle"]
    both_hit = (hits["triangle"] != NO_TRIANGLE) & (expected["triangle"] != NO_TRIANGLE)
    near = np.abs(hits["distance"] - expected["distance"]) <= 1e-6 * expected["distance"]
    return int(np.count_nonzero(~np.where(both_hit, near & (same_triangle | (hits["distance"] != 0)), same_triangle)))


@pytest.fixture(scope="module")
def meshes():
    return room_with_meshes(10_000)


@pytest.fixture(scope="module")
def reference(meshes):
    return Reference(meshes)


@pytest.mark.parametrize("count", [100_000, pytest.param(1_000_000, marks=pytest.mark.long)])
def test_random_rays(context, library, meshes, reference, count):
    rays = ray_records(*make_rays("uniform", count, PLAIN, seed=1))
    with TracedTriangles(context, library, meshes, PLAIN, 128) as scene:
        hits = scene.trace(rays)
    expected = reference.trace(rays)
    assert different(hits, expected) == 0
    assert np.all(hits["triangle"] != NO_TRIANGLE)
    corners = meshes[hits["triangle"]].astype(float)
    b1, b2 = hits["b1"].astype(float)[:, None], hits["b2"].astype(float)[:, None]
    points = (1 - b1 - b2) * corners[:, 0] + b1 * corners[:, 1] + b2 * corners[:, 2]
    on_ray = rays["origin"] + rays["direction"].astype(float) * hits["distance"][:, None]
    np.testing.assert_allclose(points, on_ray, atol=2e-6)
    assert np.all(b1 >= 0) and np.all(b2 >= 0) and np.all(b1 + b2 <= 1 + 1e-6)


def test_embree_agrees(context, library, meshes):
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

    origins, directions = make_rays("uniform", 1_000_000, PLAIN, seed=2)
    embree = rtcore_scene.EmbreeScene()
    TriangleMesh(embree, meshes)
    expected = embree.run(origins, directions, output=1)
    with TracedTriangles(context, library, meshes, PLAIN, 128) as scene:
        hits = scene.trace(ray_records(origins, directions))
    far = np.abs(hits["distance"] - expected["tfar"]) > 1e-4 * np.maximum(hits["distance"], 1e-2)
    assert far.sum() <= 3  # each is a ray that starts on a surface or grazes an edge
    assert np.all(hits["triangle"] != NO_TRIANGLE)


RAYS_EACH_TIME = ("plain", "on a corner of the table", "inside the sphere", "outside")
"""From all others the structure is compared each time."""


@pytest.mark.parametrize("place", some_each_time(CENTERS, lambda place: place in RAYS_EACH_TIME))
def test_all_kinds_of_rays_from_all_kinds_of_centers(context, library, meshes, reference, place):
    center = CENTERS[place]
    with TracedTriangles(context, library, meshes, center, 64) as scene:
        for kind in KINDS:
            rays = ray_records(*make_rays(kind, 60_000, center, seed=3))
            hits = scene.trace(rays)
            wrong = different(hits, reference.trace(rays))
            inside = np.all(np.abs(rays["origin"]) < 0.999, axis=1)
            escaped = np.count_nonzero(hits["triangle"][inside] == NO_TRIANGLE)
            assert wrong == 0
            assert escaped == 0


@pytest.mark.parametrize("place", ["plain", "on a corner of the table", "outside"])
def test_large_triangles_bit_for_bit(context, library, place):
    """Against a GPU kernel that tests all triangles with the same routine."""
    center = CENTERS[place]
    with TracedTriangles(context, library, furnished_room(4), center, 128) as scene:
        for kind in KINDS:
            rays = ray_records(*make_rays(kind, 30_000, center, seed=4))
            np.testing.assert_array_equal(bits(scene.trace(rays)), bits(scene.brute_force(rays)))


def test_the_resolution_does_not_matter(context, library, meshes):
    rays = ray_records(*make_rays("uniform", 50_000, PLAIN, seed=6))
    with TracedTriangles(context, library, meshes, PLAIN, 256) as scene:
        expected = scene.trace(rays)
        for resolution in (4, 8, 32, 64, 128, 512):
            scene.build(resolution)
            assert scene.structure.resolution == resolution
            np.testing.assert_array_equal(bits(scene.trace(rays)), bits(expected))


def test_texel_buffers_change_no_hit(context, library, meshes):
    rays = ray_records(*make_rays("uniform", 20_000, PLAIN, seed=8))
    found = []
    for texel_buffers in (False, True):
        with TracedTriangles(context, library, meshes, PLAIN, 256, texel_buffers=texel_buffers) as scene:
            found.append((bits(scene.trace(rays)), scene.occluded(rays)))
    for plain, texels in zip(*found, strict=True):
        np.testing.assert_array_equal(plain, texels)


def test_buffers_too_long_for_texels_are_read_as_storage(context, library, meshes, monkeypatch):
    rays = ray_records(*make_rays("uniform", 2_000, PLAIN, seed=8))
    with TracedTriangles(context, library, meshes, PLAIN, 256, texel_buffers=True) as scene:
        expected = scene.trace(rays)
        assert "TEXEL_BUFFERS" in scene.structure.traversal_defines
        monkeypatch.setattr(context, "max_texels", 64)
        assert "TEXEL_BUFFERS" not in scene.structure.traversal_defines
        np.testing.assert_array_equal(bits(scene.trace(rays)), bits(expected))


def test_source_triangles_are_never_hit(context, library, meshes, reference):
    """Rays that leave surfaces: from the hits of other rays on, with and without tracing through them."""
    first = ray_records(*make_rays("uniform", 100_000, PLAIN, seed=9))
    with TracedTriangles(context, library, meshes, PLAIN, 64) as scene:
        hits = scene.trace(first)
        rays = ray_records(*make_rays("uniform", 100_000, PLAIN, seed=10))
        rays["origin"] = first["origin"] + first["direction"] * hits["distance"][:, None]
        rays["source_triangle"] = hits["triangle"]
        onward = scene.trace(rays)
        assert not np.any(onward["triangle"] == rays["source_triangle"])
        assert different(onward, reference.trace(rays)) == 0


def test_an_empty_scene_after_a_full_one(context, library, meshes):
    """Nothing of the last build is left."""
    rays = ray_records(*make_rays("uniform", 1000, PLAIN, seed=13))
    with TracedTriangles(context, library, meshes, PLAIN) as scene:
        scene.structure.build(scene.triangles, 0, PLAIN, 2.0, 64)
        assert np.all(scene.trace(rays)["triangle"] == NO_TRIANGLE)


def test_lists_that_are_too_short_grow(context, library, meshes, monkeypatch):
    monkeypatch.setattr(build_buffers, "expected_lengths", lambda *_: {"tile": 200})
    center = meshes[len(meshes) // 2, 0]  # on a dense mesh: a long core list
    rays = ray_records(*make_rays("past the center", 20_000, center, seed=16))
    with TracedTriangles(context, library, meshes, center) as scene:
        first = scene.structure.memory_bytes
        hits = scene.trace(rays)
        scene.build(64)
        assert scene.structure.memory_bytes == first  # what has grown is kept
        np.testing.assert_array_equal(bits(scene.trace(rays)), bits(hits))
    assert different(hits, Reference(meshes).trace(rays)) == 0


def test_a_crowd_at_the_center(context, library):
    """The core list outgrows its first capacity many times over."""
    rng = np.random.default_rng(17)
    crowd = (rng.normal(size=(5000, 1, 3)) * 1e-5 + rng.normal(size=(5000, 3, 3)) * 1e-5).astype(np.float32)
    triangles = np.concatenate([box((-1, -1, -1), (1, 1, 1)).astype(np.float32), crowd])
    with TracedTriangles(context, library, triangles, (0, 0, 0), 32) as scene:
        assert scene.structure.counts["core"] > 4000
        for kind in KINDS:
            rays = ray_records(*make_rays(kind, 1000, (0, 0, 0), seed=18))
            np.testing.assert_array_equal(bits(scene.trace(rays)), bits(scene.brute_force(rays)))


def test_what_the_device_cannot_hold_makes_coarser_cells(context, library, meshes, monkeypatch, caplog):
    """And the same hits; with a warning where more than the fragments is too long."""
    rays = ray_records(*make_rays("uniform", 20_000, PLAIN, seed=19))
    with TracedTriangles(context, library, meshes, PLAIN, 0) as scene:
        expected, tiles, finest = scene.trace(rays), scene.structure.counts["tile"], scene.structure.resolution
        assert max(scene.structure.memory_bytes.values()) > 1 << 19
    monkeypatch.setattr(Context, "array_limit", lambda device, _: device.storage_block_limit)
    for limit in (1 << 19, 360_000):
        caplog.clear()
        monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", limit)
        with TracedTriangles(context, library, meshes, PLAIN, 0) as scene:
            assert max(scene.structure.memory_bytes.values()) <= limit
            assert scene.structure.counts["tile"] < tiles
            np.testing.assert_array_equal(bits(scene.trace(rays)), bits(expected))
            scene.build(0)  # again, starting with what was learned
            np.testing.assert_array_equal(bits(scene.trace(rays)), bits(expected))
    assert scene.structure.resolution < finest
    assert re.search(r"allows 0 MiB \([\d,]+ of [\d,]+ items\) in one buffer", caplog.text)
    assert "for now cells stay at a resolution" in caplog.text


@pytest.mark.parametrize("rasterize", [False, True])
def test_lists_that_are_longer_than_a_block(context, library, meshes, monkeypatch, rasterize):
    """Make the same cells, written and read as texels."""
    rays = ray_records(*make_rays("uniform", 20_000, PLAIN, seed=19))
    with TracedTriangles(context, library, meshes, PLAIN, 0, rasterize=rasterize) as scene:
        expected, counts, finest = scene.trace(rays), scene.structure.counts, scene.structure.resolution
    limit = 1 << 17  # enough for cells and bins
    monkeypatch.setattr(build_buffers, "expected_lengths", lambda *_: {"tile": 200})
    monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", limit)
    with TracedTriangles(context, library, meshes, PLAIN, 0, rasterize=rasterize) as scene:
        assert scene.structure.counts == counts and scene.structure.resolution == finest
        long = {name for name, size in scene.structure.memory_bytes.items() if size > limit}
        lists = {"jobs", "fragments", "fragments of the level above", "entries", "binned fragments"}
        assert long == {f"deep cubemap {name}" for name in lists}
        np.testing.assert_array_equal(bits(scene.trace(rays)), bits(expected))


def test_triangles_that_the_device_cannot_hold_are_an_error(context, library, meshes, monkeypatch):
    with TracedTriangles(context, library, meshes, PLAIN) as scene:
        rays = ray_records(*make_rays("uniform", 1000, PLAIN, seed=19))
        expected = scene.trace(rays)
        monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", 1 << 16)
        monkeypatch.setattr(Context, "array_limit", lambda device, _: device.storage_block_limit)
        fresh = DeepCubemap(context, library)
        with pytest.raises(DeviceError, match=r"MiB .* allows 0 MiB .*lower the cubemap resolution"):
            fresh.build(scene.triangles, len(meshes), PLAIN, 2.0)
        monkeypatch.undo()
        fresh.build(scene.triangles, len(meshes), PLAIN, 2.0)  # and it can be built after an error
        scene.structure, old = fresh, scene.structure
        np.testing.assert_array_equal(bits(scene.trace(rays)), bits(expected))
        old.release()


@pytest.mark.parametrize("resolution", [2, 48, -64, 1 << 15])
def test_resolutions_are_powers_of_two(context, library, resolution):
    with pytest.raises(ValueError, match=str(resolution)):
        TracedTriangles(context, library, furnished_room(), PLAIN, resolution)


def test_both_routes_are_tried_once(context, library, meshes):
    """Small scenes say nothing about speed; the first larger one decides."""
    with TracedTriangles(context, library, furnished_room(), PLAIN, 0, rasterize=None) as scene:
        assert scene.structure.route is None
        scene.structure.build(scene.triangles, len(furnished_room()), PLAIN, 2.0)
        rays = ray_records(*make_rays("uniform", 20_000, PLAIN, seed=20))
        np.testing.assert_array_equal(bits(scene.trace(rays)), bits(scene.brute_force(rays)))
    with TracedTriangles(context, library, meshes, PLAIN, 0, rasterize=None) as scene:
        assert scene.structure.route in ("rasterization", "compute shader")


@pytest.mark.parametrize(("count", "resolution"), [(10_000, 64), (10_000, 128), (100_000, 128)])
def test_most_triangles_lie_in_a_few_cells(context, library, count, resolution):
    """And in few of their depth bins."""
    with TracedTriangles(context, library, room_with_meshes(count), PLAIN, resolution) as scene:
        counts = scene.structure.counts
    assert counts["triangle"] <= counts["entry"] <= 12 * counts["triangle"]

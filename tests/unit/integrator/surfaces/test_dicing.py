# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are divided as finely as the camera sees them."""

import dataclasses

import numpy as np
import pytest

from rppm_addon.integrator.surfaces.dicing import diced_mesh
from rppm_addon.integrator.surfaces.dicing.diced_mesh import DicedMesh
from rppm_addon.integrator.surfaces.dicing.edge_lengths import EdgeLengths
from rppm_addon.scene import AttributeDomain, Camera, Deformation, Instance, MeshAttribute, Panorama, PanoramaKind
from rppm_addon.scene.meshes import Dicing, DicingView
from rppm_addon.self_test.meshes import placed, polygons, sphere

FLAT, CURVED = Dicing(1.0, True, False), Dicing(1.0, True, True)
CAMERA = Camera(placed(0.0, 0.0, 3.0), (-0.5, 0.5, -0.5, 0.5), 100, 100)
HERE = [Instance(0, np.eye(4))]


def ball(dicing):
    """A sphere of radius 1 from a cube, whose vertices have a normal each."""
    corners = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    cube = polygons("Ball", np.array(corners) / np.sqrt(3.0), faces, smooth=True)
    cube.attributes = {
        "point": MeshAttribute(AttributeDomain.POINT, cube.positions.copy()),
        "corner": MeshAttribute(AttributeDomain.CORNER, cube.positions[cube.corner_vertices, :2]),
        "triangle": MeshAttribute(AttributeDomain.TRIANGLE, np.arange(12, dtype=np.float32)[:, None]),
    }
    uv = cube.positions[cube.corner_vertices, :2]
    return dataclasses.replace(cube, corner_uv=uv, triangle_slots=np.arange(12, dtype=np.int32), dicing=dicing)


def plane(size, dicing=FLAT):
    """A square of two triangles that faces +Z."""
    corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
    return dataclasses.replace(polygons("Plane", size * corners, [(0, 1, 2, 3)]), dicing=dicing)


def walker(width=100):
    """A camera 2 m above the origin that looks along +Y, down by 10 degrees."""
    sine, cosine = np.sin(np.radians(80.0)), np.cos(np.radians(80.0))
    matrix = np.eye(4)
    matrix[:3, :3] = [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]]
    matrix[2, 3] = 2.0
    return Camera(matrix, (-0.5, 0.5, -0.4, 0.4), width, width * 4 // 5)


def edges_of(mesh):
    """(edges, 2) vertices of the edges of all triangles, in the direction of these."""
    vertices = mesh.corner_vertices[mesh.triangle_corners]
    return np.stack([vertices, np.roll(vertices, -1, axis=1)], axis=-1).reshape(-1, 2)


def assert_shut(mesh):
    """Each edge is there once in either direction: no crack and no vertex in the middle of an edge."""
    edges = edges_of(mesh)
    ways = {tuple(edge) for edge in edges.tolist()}
    assert len(ways) == len(edges) and all((b, a) in ways for a, b in ways)


def areas_of(mesh):
    corners = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float64)
    return 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


@pytest.mark.parametrize("x", [0.0, 0.4, 2.9])
@pytest.mark.parametrize("dicing", [FLAT, CURVED])
def test_divided_meshes_are_shut_and_carry_all(dicing, x):
    source = ball(dicing)
    camera = dataclasses.replace(CAMERA, matrix=placed(x, 0.0, 1.2))  # so near that faces differ in fineness
    mesh = DicedMesh(source, HERE, camera, DicingView(4.0)).mesh
    assert_shut(mesh)
    assert len(mesh.positions) - 3 * mesh.triangle_count // 2 + mesh.triangle_count == 2  # Euler
    assert mesh.triangle_count > 100
    np.testing.assert_array_equal(mesh.positions[: len(source.positions)], source.positions)
    np.testing.assert_allclose(mesh.attributes["corner"].values, mesh.corner_uv, atol=1e-6)
    np.testing.assert_array_equal(mesh.attributes["triangle"].values[:, 0], mesh.triangle_slots)
    assert np.bincount(mesh.triangle_slots, minlength=12).all()
    np.testing.assert_allclose(np.linalg.norm(mesh.corner_normals, axis=1), 1.0, atol=1e-6)
    if dicing is FLAT:
        np.testing.assert_allclose(mesh.attributes["point"].values, mesh.positions, atol=1e-6)
        np.testing.assert_allclose(mesh.corner_uv, mesh.positions[mesh.corner_vertices, :2], atol=1e-6)
        areas = np.array([areas_of(mesh)[mesh.triangle_slots == slot].sum(axis=0) for slot in range(12)])
        np.testing.assert_allclose(areas, areas_of(source), atol=1e-6)


def test_curved_faces_come_near_a_sphere():
    """Flat ones of a cube come to 0.58 of its radius."""
    flat, curved = (
        np.linalg.norm(DicedMesh(dataclasses.replace(ball(dicing)), HERE, CAMERA, DicingView()).mesh.positions, axis=1)
        for dicing in (FLAT, CURVED)
    )
    assert flat.min() < 0.6
    fine = DicedMesh(dataclasses.replace(sphere("Ball"), dicing=CURVED), HERE, CAMERA, DicingView()).mesh
    np.testing.assert_allclose(np.linalg.norm(fine.positions, axis=1), 1.0, atol=5e-3)  # at its seam it is open
    # The corners of a cube are too sharp to be bent round; twice as many faces are not.
    assert curved.min() == flat.min()


def test_creases_stay_straight():
    """Faces that meet in an edge do not bend towards each other."""
    roof = polygons("Roof", np.array([(0, 0, 1), (0, 4, 1), (-1, 0, 0), (-1, 4, 0), (1, 0, 0), (1, 4, 0)]),
                    [(0, 1, 3, 2), (1, 0, 4, 5)])  # fmt: skip
    means = np.sign(roof.positions[:, :1]) * [np.sqrt(0.5), 0.0, 0.0] + [0.0, 0.0, np.sqrt(0.5)]
    means[:2] = [0.0, 0.0, 1.0]
    roof.corner_normals = np.float32(means)[roof.corner_vertices]
    mesh = DicedMesh(dataclasses.replace(roof, dicing=CURVED), HERE, CAMERA, DicingView()).mesh
    assert mesh.triangle_count > 1000
    x = mesh.positions[:, 0]
    np.testing.assert_allclose(mesh.positions[:, 2], 1.0 - np.abs(x), atol=1e-6)
    # The edge is shaded sharply where it was smooth, though not where the mesh has normals of its own.
    vertices = mesh.corner_vertices[mesh.triangle_corners]
    sides = np.sign(x[vertices].sum(axis=1))
    across = mesh.corner_normals[mesh.triangle_corners][..., 0] * sides[:, None]
    np.testing.assert_allclose(across, np.sqrt(0.5), atol=1e-6)
    up = np.tile(np.float32([0.0, 0.6, 0.8]), (len(roof.corner_normals), 1))
    own = DicedMesh(dataclasses.replace(roof, dicing=CURVED, corner_normals=up), HERE, CAMERA, DicingView()).mesh
    np.testing.assert_allclose(own.corner_normals, np.tile(up[0], (len(own.corner_normals), 1)), atol=1e-6)


@pytest.mark.parametrize("height", [0.0, 1.0])
def test_borders_and_creases_are_curves(height):
    """A disk of 16 corners is round, and so is the edge between it and the side of a cylinder."""
    turns = np.arange(16) * np.pi / 8.0
    rim = np.stack([np.cos(turns), np.sin(turns), 0.0 * turns], axis=-1)
    points, faces = np.concatenate([rim, [(0.0, 0.0, 0.0)]]), [(16, k, (k + 1) % 16) for k in range(16)]
    if height:
        points = np.concatenate([points, rim - [0.0, 0.0, height]])
        faces += [((k + 1) % 16, k, 17 + k, 17 + (k + 1) % 16) for k in range(16)]
    mesh = DicedMesh(dataclasses.replace(polygons("Disk", points, faces), dicing=CURVED), HERE, CAMERA, DicingView())
    radii = np.linalg.norm(mesh.mesh.positions[:, :2], axis=1)
    edges = np.sort(edges_of(mesh.mesh), axis=1)
    on_rim = np.abs(mesh.mesh.positions[:, 2]) < 1e-6
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    border = np.unique(unique[counts == 1])
    assert len(border) > 64
    np.testing.assert_allclose(radii[border], 1.0, atol=5e-4)
    sides = np.unique(edges[(mesh.mesh.positions[edges][..., 2] < -1e-6).any(axis=1)])
    crease = np.intersect1d(np.flatnonzero(on_rim), sides)
    assert len(crease) > 64 or not height
    np.testing.assert_allclose(radii[crease], 1.0, atol=5e-4)


def test_shapes_are_divided_as_the_mesh_is():
    source = dataclasses.replace(sphere("Ball"), dicing=CURVED)
    shapes = np.stack([source.positions, 2.0 * source.positions])
    diced = DicedMesh(source, HERE, CAMERA, DicingView(4.0))
    bent = diced.deformed(Deformation(0, np.array([0.0, 1.0]), shapes, np.stack([source.corner_normals] * 2)))
    np.testing.assert_array_equal(bent.positions[0], diced.mesh.positions)
    np.testing.assert_allclose(bent.positions[1], 2.0 * bent.positions[0], rtol=1e-5)


def test_edges_are_as_long_in_pixels_as_it_is_asked_for():
    """A plane that faces the camera at 3 m, where a pixel is 3 cm wide: squares with sides of 4 pixels, as 2^-n."""
    mesh = DicedMesh(plane(0.75), HERE, CAMERA, DicingView(4.0)).mesh
    edges = edges_of(mesh)
    pixels = np.linalg.norm(mesh.positions[edges[:, 0]] - mesh.positions[edges[:, 1]], axis=1) / 0.03
    assert pixels.max() <= 4.0 * np.sqrt(2.0) * 1.001 and np.median(pixels) >= 2.0
    farther = DicedMesh(plane(0.75), [Instance(0, placed(0.0, 0.0, -9.0))], CAMERA, DicingView(4.0)).mesh
    assert mesh.triangle_count == pytest.approx(16 * farther.triangle_count, rel=0.3)
    both = DicedMesh(plane(0.75), [Instance(0, placed(0.0, 0.0, -9.0)), *HERE], CAMERA, DicingView(4.0)).mesh
    assert both.triangle_count == mesh.triangle_count  # as the nearest is seen


def test_near_parts_are_finer_than_far_ones():
    """With fewer triangles in all than even division to the same fineness makes."""
    camera = walker()
    mesh = DicedMesh(plane(200.0), HERE, camera, DicingView(4.0, max_subdivisions=30)).mesh
    corners = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].astype(np.float64)
    middles, areas = corners.mean(axis=1), np.linalg.norm(areas_of(mesh), axis=1)
    distances = np.linalg.norm(middles - camera.matrix[:3, 3], axis=1)
    seen = (middles[:, 1] > 4.0) & (np.abs(middles[:, 0]) < 0.4 * middles[:, 1])
    near, far = seen & (distances < 6.0), seen & (distances > 100.0)
    assert np.median(areas[near]) < 1e-2 * np.median(areas[far])
    # Triangles of at most half a square with sides of 4 pixels.
    assert (areas[seen] <= 1.01 * 0.5 * (1.5 * 4.0 * 0.01 * distances[seen]) ** 2).all()
    assert mesh.triangle_count < 0.01 * 400.0**2 / areas[near].mean()


def test_parts_outside_of_the_picture_are_coarser():
    def count(scale, camera=None):
        view = DicingView(4.0, offscreen_scale=scale, max_subdivisions=30)
        return DicedMesh(plane(20.0), HERE, camera or walker(40), view).mesh.triangle_count

    assert count(1.0) > 2 * count(4.0) > 2 * count(100.0)
    panorama = Panorama(PanoramaKind.EQUIRECTANGULAR)  # it sees all around
    around = dataclasses.replace(walker(40), panorama=panorama, window=(0.0, 1.0, 0.0, 1.0))
    assert count(1.0, around) == count(4.0, around)
    beside = dataclasses.replace(walker(40), orthographic=True, matrix=placed(200.0, 0.0, 5.0))
    assert count(1.0, beside) > count(4.0, beside)


@pytest.mark.parametrize(
    ("point", "distance"),
    [
        ((0.0, 0.0, -1.0), 0.0),
        ((2.0, 0.0, -2.0), 1.0 / np.sqrt(1.25)),  # 1 m beside the right edge
        ((0.0, 0.0, 5.0), 5.0),
        ((9.0, 0.0, 1.0), 9.5 / np.sqrt(1.25)),
        ((5.0, 0.0, 4.0), np.sqrt(41.0)),  # the side is nearest to it at the camera
    ],
)
def test_pixels_grow_with_the_distance_from_the_picture(point, distance):
    """As in Cycles: by the offscreen scale, less 1, times the distance."""
    camera = dataclasses.replace(CAMERA, matrix=np.eye(4))
    lengths = EdgeLengths(plane(1.0), HERE, camera, DicingView(offscreen_scale=3.0))
    ends = np.array(point) + np.array([(-0.005, 0.0, 0.0), (0.005, 0.0, 0.0)])
    (found,) = lengths.between(lengths.seen(ends), np.array([0]), np.array([1]))
    assert found == pytest.approx(1.0 / (np.linalg.norm(point) + 2.0 * distance), rel=1e-6)


def test_lengths_in_meters_do_not_depend_on_the_camera():
    def count(camera, rate=1.0):
        moved = [Instance(0, placed(0.0, 0.0, -50.0, 7.0))]
        return DicedMesh(plane(1.0, Dicing(0.1, False, False)), moved, camera, DicingView(rate)).mesh.triangle_count

    assert count(CAMERA) == count(walker()) == 4 * 16**2  # squares of 12.5 cm, whose diagonals are halved
    assert count(CAMERA, 2.0) == 4 * 8**2


def test_edges_are_halved_no_more_often_than_it_is_said():
    for level, expected in ((0, 2 * 8**2), (1, 2 * 4**2), (5, 2)):
        mesh = plane(1.0, dataclasses.replace(FLAT, base_level=level))
        assert DicedMesh(mesh, HERE, CAMERA, DicingView(0.1, max_subdivisions=3)).mesh.triangle_count == expected


def test_what_is_divided_a_few_times_only_is_not_taken_for_too_much():
    side = np.linspace(-1.0, 1.0, 101)
    points = np.array([(x, y, 0.0) for y in side for x in side])
    faces = [(k, k + 1, k + 102, k + 101) for j in range(100) for k in range(101 * j, 101 * j + 100)]
    mesh = dataclasses.replace(polygons("Grid", points, faces), dicing=Dicing(1e-3, True, False))
    diced = DicedMesh(mesh, HERE, CAMERA, DicingView(max_subdivisions=2))
    assert diced.mesh.triangle_count == 2 * 100**2 * 16 and diced.coarsening == 1.0


@pytest.mark.parametrize("instances", [1, 3])
def test_there_are_no_more_triangles_than_allowed(monkeypatch, instances):
    """Edges then are longer, by a factor that is told."""
    monkeypatch.setattr(diced_mesh, "MOST_TRIANGLES", 3000)
    diced = DicedMesh(ball(FLAT), HERE * instances, CAMERA, DicingView(1.0))
    assert 3000 / instances / 8 < diced.mesh.triangle_count <= 3000 / instances and diced.coarsening > 1.0
    assert_shut(diced.mesh)
    assert DicedMesh(ball(FLAT), HERE, CAMERA, DicingView(16.0)).coarsening == 1.0
    whole = DicedMesh(dataclasses.replace(sphere("Ball"), dicing=FLAT), HERE * 3000, CAMERA, DicingView(1.0)).mesh
    assert whole.triangle_count == sphere("Ball").triangle_count


def test_coordinates_that_are_no_numbers_stop_nothing_else(monkeypatch):
    """Neither a vertex of the mesh, where there are too many triangles, nor the place of an instance."""
    monkeypatch.setattr(diced_mesh, "MOST_TRIANGLES", 3000)
    mesh = ball(FLAT)
    mesh.positions[0] = np.nan
    diced = DicedMesh(mesh, HERE, CAMERA, DicingView(0.5))
    assert diced.coarsening > 1.0 and 500 < diced.mesh.triangle_count <= 3000
    nowhere = Instance(0, np.full((4, 4), np.nan))
    count = DicedMesh(plane(0.5), [nowhere, *HERE], CAMERA, DicingView(8.0)).mesh.triangle_count
    assert count == DicedMesh(plane(0.5), HERE, CAMERA, DicingView(8.0)).mesh.triangle_count > 2


def test_of_many_instances_the_largest_counts():
    far = [Instance(0, placed(0.0, 0.0, -500.0 - place)) for place in range(40)]
    count = DicedMesh(plane(0.75), [*far, *HERE], CAMERA, DicingView(4.0)).mesh.triangle_count
    assert count == DicedMesh(plane(0.75), HERE, CAMERA, DicingView(4.0)).mesh.triangle_count

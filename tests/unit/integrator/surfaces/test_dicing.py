# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are divided before they are displaced."""

import dataclasses

import numpy as np
import pytest

from rppm_addon.integrator.surfaces.dicing import MOST_TRIANGLES, DicedMesh, parts_of_edges, rounded_parts
from rppm_addon.scene import AttributeDomain, Camera, Deformation, Instance, MeshAttribute
from rppm_addon.scene.meshes import Dicing
from rppm_addon.self_test.meshes import placed, polygons, sphere

FLAT, CURVED = Dicing(1.0, True, False), Dicing(1.0, True, True)


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


@pytest.mark.parametrize("parts", [2, 3, 7])
def test_divided_meshes_are_shut_and_carry_all(parts):
    source = ball(FLAT)
    mesh = DicedMesh(source, parts).mesh
    assert mesh.triangle_count == 12 * parts**2 and len(mesh.positions) == 6 * parts**2 + 2  # Euler
    vertices = mesh.corner_vertices[mesh.triangle_corners]
    edges = np.stack([vertices, np.roll(vertices, -1, axis=1)], axis=-1).reshape(-1, 2)
    ways = {tuple(edge) for edge in edges.tolist()}
    assert len(ways) == len(edges) and all((b, a) in ways for a, b in ways)  # each edge once in either direction
    np.testing.assert_array_equal(mesh.positions[: len(source.positions)], source.positions)
    np.testing.assert_allclose(mesh.attributes["point"].values, mesh.positions, atol=1e-6)
    np.testing.assert_allclose(mesh.corner_uv, mesh.positions[mesh.corner_vertices, :2], atol=1e-6)
    np.testing.assert_allclose(mesh.attributes["corner"].values, mesh.corner_uv, atol=1e-6)
    np.testing.assert_array_equal(mesh.triangle_slots, np.repeat(np.arange(12), parts**2))
    np.testing.assert_array_equal(mesh.attributes["triangle"].values[:, 0], mesh.triangle_slots)


def test_curved_faces_come_near_a_sphere():
    """Flat ones of a cube come to 0.58 of its radius."""
    flat, curved = (np.linalg.norm(DicedMesh(ball(dicing), 8).mesh.positions, axis=1) for dicing in (FLAT, CURVED))
    assert flat.min() < 0.6 and curved.min() > 0.75 and curved.max() < 1.01
    fine = DicedMesh(dataclasses.replace(sphere("Ball"), dicing=CURVED), 4).mesh
    np.testing.assert_allclose(np.linalg.norm(fine.positions, axis=1), 1.0, atol=2e-4)


def test_shapes_are_divided_as_the_mesh_is():
    source = ball(CURVED)
    shapes = np.stack([source.positions, 2.0 * source.positions])
    bent = DicedMesh(source, 3).deformed(
        Deformation(0, np.array([0.0, 1.0]), shapes, np.stack([source.corner_normals] * 2))
    )
    np.testing.assert_array_equal(bent.positions[0], DicedMesh(source, 3).mesh.positions)
    np.testing.assert_allclose(bent.positions[1], 2.0 * bent.positions[0], rtol=1e-5)


def test_pixels_tell_how_far_edges_are_divided():
    """A square of side 1 whose longest edge of three is the diagonal, 100 pixels a meter 1 m before the camera."""
    square = polygons("Square", np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]) - [0.5, 0.5, 0], [(0, 1, 2, 3)])
    camera = Camera(placed(0.0, 0.0, 10.0), (-0.5, 0.5, -0.5, 0.5), 100, 100)

    def parts(dicing, *instances, rate=1.0):
        mesh = dataclasses.replace(square, dicing=dicing)
        return parts_of_edges(mesh, [Instance(0, matrix) for matrix in instances], camera, rate)

    # The 90th percentile of 1, 1, 1, 1 and twice the diagonal.
    assert parts(Dicing(1.0, True, False), np.eye(4)) == pytest.approx(np.sqrt(2.0) * 10.0, rel=0.02)
    assert parts(Dicing(2.0, True, False), placed(0.0, 0.0, 5.0), np.eye(4)) == pytest.approx(
        np.sqrt(2.0) * 10, rel=0.02
    )
    assert parts(Dicing(1.0, True, False), placed(0.0, 0.0, 0.0, 3.0), rate=8.0) == pytest.approx(5.3, rel=0.02)
    # What is beside the picture may be four times as coarse.
    assert parts(Dicing(1.0, True, False), placed(40.0, 0.0, 10.0)) == pytest.approx(np.sqrt(2.0) * 100 / 160, abs=0.5)
    assert parts(Dicing(0.1, False, False), placed(0.0, 0.0, 0.0, 9.0)) == pytest.approx(np.sqrt(2.0) * 10.0)


def test_parts_are_few_numbers_within_bounds():
    assert [rounded_parts(wanted, 12) for wanted in (1.0, 1.2, 2.5, 5.0, 9.0, 1e9)] == [1, 2, 3, 6, 12, 295]
    assert 12 * 295**2 <= MOST_TRIANGLES < 12 * 296**2
    assert rounded_parts(9.0, 1 << 22) == 1

# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangents of UV maps and colors of other spaces."""

import numpy as np
import pytest

from rppm_addon.blender.export.geometry.meshes.tangents import corner_tangents, sphere_uv
from rppm_addon.scene import Mesh


def square(uv_scale=(1.0, 1.0)) -> tuple[Mesh, np.ndarray]:
    """Two triangles in XY facing +Z, u along X and v along Y, times the scale."""
    positions = np.float32([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
    normals = np.tile(np.float32([0, 0, 1]), (4, 1))
    triangles = np.int32([(0, 1, 2), (0, 2, 3)])
    mesh = Mesh("Square", positions, np.arange(4, dtype=np.int32), normals, triangles, np.zeros(2, np.int32))
    return mesh, positions[:, :2] * np.float32(uv_scale)


def test_tangents_run_along_u():
    mesh, uv = square()
    assert corner_tangents(mesh, uv) == pytest.approx(np.tile([1.0, 0.0, 0.0, 1.0], (4, 1)))


def test_a_mirrored_map_turns_the_bitangent():
    mesh, uv = square((1.0, -2.0))
    assert corner_tangents(mesh, uv) == pytest.approx(np.tile([1.0, 0.0, 0.0, -1.0], (4, 1)))


def test_a_map_without_area_has_no_tangents():
    mesh, uv = square((1.0, 0.0))
    assert not corner_tangents(mesh, uv)[:, :3].any()


def test_corners_share_a_mean_weighted_by_angles():
    """Where normal, place and UV are the same, the triangles' own tangents are mixed by their angles there."""
    positions = np.float32([(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 1, 0)])
    normals = np.tile(np.float32([0, 0, 1]), (4, 1))
    triangles = np.int32([(0, 1, 2), (0, 2, 3)])
    mesh = Mesh("Fan", positions, np.arange(4, dtype=np.int32), normals, triangles, np.zeros(2, np.int32))
    # The first triangle, of 90 degrees at the origin, has u along X; the second, of 45, has it turned.
    uv = np.float32([(0, 0), (1, 0), (0, 1), (-2, 3)])
    first = np.array([1.0, 0.0, 0.0])
    # d position / du of the second: edges (0, 1) and (-1, 1), steps (0, 1) and (-2, 3).
    second = 3.0 * np.array([0.0, 1.0, 0.0]) - 1.0 * np.array([-1.0, 1.0, 0.0])
    mixed = 2.0 * first + second / np.linalg.norm(second)
    found = corner_tangents(mesh, uv)
    assert found[0, :3] == pytest.approx(mixed / np.linalg.norm(mixed), abs=1e-6)
    assert found[1, :3] == pytest.approx(first, abs=1e-6)


def test_sphere_uv():
    assert sphere_uv(np.array([(0.0, 1.0, 0.0), (0.0, 0.0, 2.0)])) == pytest.approx(np.array([(0.5, 0.5), (0.0, 1.0)]))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangents of UV maps and colors of other spaces."""

import numpy as np
import pytest

from rppm_addon.blender.export.geometry.meshes.tangents import corner_tangents, sphere_uv
from rppm_addon.scene import Mesh


def facing_up(name: str, positions, triangles) -> Mesh:
    """A mesh whose corners are its vertices, with normals along Z."""
    positions, triangles = np.float32(positions), np.int32(triangles)
    normals = np.tile(np.float32([0, 0, 1]), (4, 1))
    slots = np.zeros(len(triangles), np.int32)
    return Mesh(name, positions, np.arange(4, dtype=np.int32), normals, triangles, slots)


@pytest.mark.parametrize(
    ("uv_scale", "tangent"),
    [((1.0, 1.0), (1.0, 0.0, 0.0, 1.0)), ((1.0, -2.0), (1.0, 0.0, 0.0, -1.0)), ((1.0, 0.0), (0.0, 0.0, 0.0))],
    ids=["along u", "mirrored", "without area"],
)
def test_tangents_run_along_u(uv_scale, tangent):
    """A mirrored map turns the bitangent, a map without area has none. u is along X and v along Y, times the scale."""
    mesh = facing_up("Square", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    found = corner_tangents(mesh, mesh.positions[:, :2] * np.float32(uv_scale))
    assert found[:, : len(tangent)] == pytest.approx(np.tile(tangent, (4, 1)))


def test_corners_share_a_mean_weighted_by_angles():
    """Where normal, place and UV are the same, the triangles' own tangents are mixed by their angles there."""
    mesh = facing_up("Fan", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 1, 0)], [(0, 1, 2), (0, 2, 3)])
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

# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes of the light tree of a mesh, placed in the world, hold what is below them."""

import numpy as np
import pytest

from rppm_addon.integrator.lights.emitters.instances import placed_roots
from rppm_addon.integrator.lights.emitters.meshes import MeshEmitters, mesh_emitters
from rppm_addon.integrator.lights.light_records import EMISSIVE_TRIANGLE


def emitters(count: int, spread: float) -> tuple[MeshEmitters, np.ndarray]:
    """Emitters of triangles with corners (count, 3, 3), whose normals are up but for a spread; each fourth is dark."""
    generator = np.random.default_rng(count)
    flat = generator.normal(size=(count, 3, 3)) * (1.0, 1.0, spread)
    corners = generator.uniform(-1.0, 1.0, (count, 1, 3)) + 0.1 * flat
    records = EMISSIVE_TRIANGLE.zeros(count)
    records["area"] = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    records["radiance"] = generator.random((count, 3))
    records["radiance"][::4] = 0.0
    return mesh_emitters(records, corners, 2), corners


def placements() -> np.ndarray:
    """(n, 4, 4): similarities, then uneven, skewed and mirrored ones."""
    generator = np.random.default_rng(1)
    matrices = np.tile(np.eye(4), (12, 1, 1))
    turned = np.linalg.qr(generator.normal(size=(12, 3, 3)))[0]
    matrices[:, :3, :3] = turned * generator.uniform(0.2, 3.0, (12, 1, 1))
    matrices[6:, :3, :3] = generator.normal(size=(6, 3, 3))
    matrices[8, :3, 0] *= 0.01
    matrices[:, :3, 3] = generator.uniform(-9.0, 9.0, (12, 3))
    return matrices


def test_probabilities_within_a_mesh_come_to_one():
    mesh, _ = emitters(101, 1.0)
    records = mesh.records
    assert records["probability"].sum() == 1.0 and records["cumulated"][-1] == 1.0
    dark = ~records["radiance"].any(axis=1)
    assert dark.any() and not records["probability"][dark].any() and not records["triangle"][dark].any()
    members = mesh.nodes["member"][records["triangle"][~dark]]
    np.testing.assert_array_equal(members, np.flatnonzero(~dark))


@pytest.mark.parametrize("spread", [0.0, 0.1, 1.0])
def test_placed_nodes_hold_the_placed_triangles(spread):
    mesh, corners = emitters(101, spread)
    bright = mesh.records["radiance"].any(axis=1)
    for matrix in placements():
        nodes, scales, stretches = placed_roots(mesh, matrix[None])
        placed = corners[bright] @ matrix[:3, :3].T + matrix[:3, 3]
        node = nodes[0]
        assert (node["low"] <= placed.min(axis=(0, 1))).all() and (node["high"] >= placed.max(axis=(0, 1))).all()
        normals = np.cross(placed[:, 1] - placed[:, 0], placed[:, 2] - placed[:, 0])
        areas = 0.5 * np.linalg.norm(normals, axis=1)
        cosine = np.abs(normals @ node["axis"].astype(float)) / (2.0 * areas)
        reach = np.arccos(np.clip(cosine, -1.0, 1.0))
        assert (reach <= np.arccos(np.clip(float(node["cosine_normals"]), -1.0, 1.0)) + 2e-3).all()
        power = mesh.records["radiance"][bright].mean(axis=1) @ areas
        similar = stretches[0] < 1.001
        assert node["intensity"] == pytest.approx(power, rel=1e-4 if similar else 0.7)
        assert node["intensity"] >= power * (1.0 - 1e-4)  # a root mean square
        assert scales[0] > 0.0


def test_similarities_keep_the_cone():
    mesh, _ = emitters(101, 0.1)
    nodes, _, stretches = placed_roots(mesh, placements()[:6])
    np.testing.assert_allclose(stretches, 1.0, atol=1e-4)
    np.testing.assert_allclose(nodes["cosine_normals"], mesh.nodes["cosine_normals"][1], atol=1e-3)

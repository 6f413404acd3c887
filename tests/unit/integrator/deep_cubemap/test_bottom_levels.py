# SPDX-License-Identifier: GPL-3.0-or-later
"""Margins and centers of the deep cubemaps of meshes."""

import dataclasses

import numpy as np
import pytest

from rppm_addon.integrator.acceleration.acceleration_structure import MARGIN
from rppm_addon.integrator.deep_cubemap.bottom_levels import MAX_LISTED, MeshBounds, mesh_parameters, sortable_bits
from rppm_addon.self_test.meshes import rectangle, sphere

BALL = sphere("ball")
BOUNDS = MeshBounds.of_mesh(BALL)


def test_instances_of_like_margins_share_a_cubemap():
    margins = BOUNDS.least_margin * np.array([0.1, 1.0, 3.0, 5.0])
    np.testing.assert_array_equal(BOUNDS.margin_exponents(margins), 3)
    np.testing.assert_array_equal(BOUNDS.margin_exponents(margins * [1, 1, 1, 1000]), [2, 2, 2, 13])


def test_margins_are_never_less_than_needed():
    margins = BOUNDS.least_margin * 10.0 ** np.random.default_rng(1).uniform(-3, 9, 1000)
    found = BOUNDS.least_margin * 2.0 ** BOUNDS.margin_exponents(margins)
    assert (found >= margins).all()
    assert (found <= np.maximum(16.0 * margins, 16.0 * BOUNDS.least_margin)).all()


def test_margins_of_instances_without_a_place():
    np.testing.assert_array_equal(BOUNDS.margin_exponents(np.array([np.nan, 0.0])), 0)
    assert np.isfinite(mesh_parameters(BALL, BOUNDS, int(BOUNDS.margin_exponents(np.array([np.inf]))[0]), 0)["margin"])


@pytest.mark.parametrize("distance", [0.0, 100.0])
def test_a_center_lies_in_the_box_and_on_no_plane_of_symmetry(distance):
    mesh = dataclasses.replace(BALL, positions=BALL.positions + np.float32(distance))
    bounds = MeshBounds.of_mesh(mesh)
    assert (bounds.low < bounds.center).all() and (bounds.center < bounds.high).all()
    assert (np.abs(bounds.center - 0.5 * (bounds.low + bounds.high)) > 0.01).all()
    assert np.linalg.norm(mesh.positions - bounds.center, axis=1).max() <= bounds.radius
    assert bounds.least_margin >= MARGIN * np.abs(mesh.positions).max()


def test_cells_are_no_finer_than_the_margin():
    fine, coarse = (mesh_parameters(BALL, BOUNDS, exponent, 0) for exponent in (0, 9))
    sides = [2.0 ** (state["root_exponent"] + 2 * state["last_level"]) for state in (fine, coarse)]
    assert sides[0] == 2.0**14 and 4 <= sides[1] < BOUNDS.radius / (8.0 * coarse["margin"])


def test_the_smallest_meshes_are_lists():
    square = rectangle("wall", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))
    state = mesh_parameters(square, MeshBounds.of_mesh(square), 0, 7)
    assert square.triangle_count <= MAX_LISTED < BALL.triangle_count
    assert state["root_count"] == 0 and state["core_count"] == 2 and state["first_triangle"] == 7
    assert mesh_parameters(BALL, BOUNDS, 0, 0)["root_count"] > 0


def test_bits_sort_as_floats_do():
    values = np.sort(np.random.default_rng(2).normal(size=100).astype(np.float32))
    assert (np.diff(sortable_bits(values).astype(np.int64)) > 0).all()

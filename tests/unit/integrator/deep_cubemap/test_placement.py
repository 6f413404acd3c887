# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the deep cubemap's center goes."""

from types import SimpleNamespace

import numpy as np
import pytest

from rppm_addon.integrator.deep_cubemap.placement import FAR, cubemap_centers, radius_about

GEOMETRY = SimpleNamespace(center=np.array([1.0, 0.0, 0.0]), radius=2.0)


def centers(position, wanted=None):
    matrix = np.eye(4)
    matrix[:3, 3] = position
    scene = SimpleNamespace(camera=SimpleNamespace(matrix=matrix), cubemap_center=wanted)
    return list(cubemap_centers(scene, GEOMETRY))


def test_it_goes_to_the_camera():
    np.testing.assert_array_equal(centers((3.0, 4.0, 5.0))[0], (3.0, 4.0, 5.0))


def test_the_scenes_choice_comes_first():
    np.testing.assert_array_equal(centers((3.0, 4.0, 5.0), np.array([0.5, 0.0, 0.0]))[0], (0.5, 0.0, 0.0))


def test_a_far_camera_is_brought_nearer_on_its_line():
    center = centers((1.0, 0.0, 1e6))[0]
    assert center == pytest.approx([1.0, 0.0, FAR * 2.0])


def test_a_camera_that_is_nowhere_leaves_the_middle():
    np.testing.assert_array_equal(centers((np.nan, 0.0, 0.0))[0], GEOMETRY.center)


def test_the_points_to_fall_back_to_are_near():
    first, *others = centers((3.0, 4.0, 5.0))
    distances = [np.linalg.norm(other - first) for other in others]
    assert len(others) >= 2 and distances == sorted(distances)
    assert distances[0] > 0.0 and distances[-1] < 0.02 * GEOMETRY.radius


def test_the_radius_reaches_the_farthest_corner():
    bounds = SimpleNamespace(bounds_low=np.array([-1.0, 0.0, 0.0]), bounds_high=np.array([1.0, 2.0, 4.0]))
    assert radius_about(np.array([3.0, 1.0, 1.0]), bounds) == pytest.approx(np.sqrt(16 + 1 + 9))
    assert radius_about(np.array([0.0, 1.0, 2.0]), bounds) == pytest.approx(np.sqrt(1 + 1 + 4))

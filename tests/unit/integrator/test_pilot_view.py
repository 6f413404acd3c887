# SPDX-License-Identifier: GPL-3.0-or-later
"""A coarse look shows the whole view, with footprints of the view's own pixels."""

import numpy as np
import pytest

from rppm_addon.integrator.common.camera_view import camera_view
from rppm_addon.integrator.pilot_view import MOST_PIXELS, at_pixels, pilot_sizes, pilot_views
from rppm_addon.scene import Camera


@pytest.mark.parametrize("size", [(256, 256), (1920, 1080), (7680, 4320), (300000, 3), (3, 300000), (129, 128)])
def test_a_large_view_is_looked_at_coarsely_first(size):
    coarse, full = pilot_sizes(*size)
    assert full == size
    assert coarse[0] * coarse[1] <= MOST_PIXELS
    assert 1 <= coarse[0] <= size[0] and 1 <= coarse[1] <= size[1]
    assert coarse[0] * coarse[1] > MOST_PIXELS / 4


@pytest.mark.parametrize("size", [(1, 1), (128, 128), (16384, 1)])
def test_a_small_view_is_looked_at_once(size):
    assert pilot_sizes(*size) == [size]


def test_bands_of_a_look_tile_the_region_and_keep_its_footprints():
    camera = Camera(np.eye(4), (-2, 2, -1, 1), 400, 200, crop=(100, 50, 300, 150))
    views = list(pilot_views(camera, 50, 25, 10))
    assert [(int(view["width"][0]), int(view["height"][0])) for view in views] == [(50, 10), (50, 10), (50, 5)]
    for view, bottom, top in zip(views, (-0.5, -0.1, 0.3), (-0.1, 0.3, 0.5)):
        np.testing.assert_allclose(view["window"][0], [-1, 1, bottom, top], atol=1e-6)
        assert view["pixel_area"] == camera_view(camera, 0, 100, (0, 0))["pixel_area"]


def test_the_full_look_is_the_bands_of_a_render():
    camera = Camera(np.eye(4), (-2, 2, -1, 1), 60, 40)
    for first, view in zip((0, 16, 32), pilot_views(camera, 60, 40, 16)):
        rendered = camera_view(camera, first, min(16, 40 - first), (0.0, 0.0))
        np.testing.assert_allclose(view["window"], rendered["window"], atol=1e-6)
        assert (view["width"], view["height"]) == (rendered["width"], rendered["height"])


def test_pixels_take_the_nearest_of_a_look():
    look = np.array([[1, 2, 3], [4, 5, 6]])
    assert at_pixels(look, 6, 2).tolist() == [1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6]
    assert at_pixels(look, 3, 4).reshape(4, 3).tolist() == [[1, 2, 3]] * 2 + [[4, 5, 6]] * 2
    assert at_pixels(look, 3, 2).tolist() == look.ravel().tolist()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Subpixel offsets and the camera record."""

import numpy as np
import pytest

from rppm_addon.integrator.camera_paths.gbuffer import filter_offsets
from rppm_addon.integrator.common.camera_view import camera_view
from rppm_addon.scene import Camera, PixelFilter
from rppm_addon.scene.errors import SceneError


def test_offsets_have_the_moments_of_the_filter():
    offsets = np.array([filter_offsets(i, 1.5, 3) for i in range(1, 4001)])
    assert filter_offsets(1, 1.5, 3) != filter_offsets(1, 1.5, 4)
    assert filter_offsets(7, 0.0, 3) == (0, 0)
    assert 1.2 < np.abs(offsets).max() <= 1.5
    np.testing.assert_allclose(offsets.mean(axis=0), 0, atol=2e-3)
    x = np.linspace(-0.5, 0.5, 20001)
    w = 0.35875 + 0.48829 * np.cos(2 * np.pi * x) + 0.14128 * np.cos(4 * np.pi * x) + 0.01168 * np.cos(6 * np.pi * x)
    np.testing.assert_allclose(offsets.var(axis=0), (w * (3.0 * x) ** 2).sum() / w.sum(), rtol=0.01)


@pytest.mark.parametrize(
    ("kind", "width", "deviation", "reach"),
    [(PixelFilter.BOX, 3.0, 12**-0.5, 0.5), (PixelFilter.GAUSSIAN, 1.5, 0.25 * 1.5, 2.25)],
)
def test_other_filters_are_those_of_cycles(kind, width, deviation, reach):
    """A box is a pixel wide; a Gaussian of Cycles is exp(-2 (2 x / width)^2), as good as whole within its reach."""
    offsets = np.array([filter_offsets(i, width, 3, kind) for i in range(1, 4001)])
    assert np.abs(offsets).max() <= reach
    np.testing.assert_allclose(offsets.std(axis=0), deviation, rtol=0.01)
    assert filter_offsets(7, 0.0, 3, kind) == (0, 0)


def test_windows_of_bands_tile_the_region():
    camera = Camera(np.eye(4), (-2, 2, -1, 1), 400, 200, crop=(100, 50, 300, 150))
    low, high = camera_view(camera, 0, 60, (0, 0))["window"][0], camera_view(camera, 60, 40, (0, 0))["window"][0]
    np.testing.assert_allclose(low, [-1, 1, -0.5, 0.1], atol=1e-6)
    np.testing.assert_allclose(high, [-1, 1, 0.1, 0.5], atol=1e-6)
    shifted = camera_view(camera, 0, 60, (0.5, -0.5))["window"][0]
    np.testing.assert_allclose(shifted - low, [0.005, 0.005, -0.005, -0.005], atol=1e-6)


def test_unusable_cameras_are_refused():
    matrix = np.eye(4)
    matrix[0, 3] = np.nan
    with pytest.raises(SceneError, match="camera"):
        camera_view(Camera(matrix, (-1, 1, -1, 1), 4, 4), 0, 4, (0, 0))
    with pytest.raises(SceneError, match="camera"):
        camera_view(Camera(np.eye(4), (1, 1, -1, 1), 4, 4), 0, 4, (0, 0))

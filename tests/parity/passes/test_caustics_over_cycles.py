# SPDX-License-Identifier: GPL-3.0-or-later
"""The sample in which RPPM gives the caustics to a picture that Cycles renders without."""

from pathlib import Path

import bpy
import numpy as np
import OpenEXR
import pytest

from ..comparison import block_means, write_pair

SAMPLE = Path(__file__).parents[3] / "docs" / "samples" / "caustics_over_cycles.blend"
ALLOWED_MEAN, ALLOWED_BLOCK, ALLOWED_BLOCKS = 0.015, 0.04, 0.95
"""Shares of radiance; where the lamp is seen in the glass and in the gold, both engines find it seldom."""


@pytest.fixture
def sample(registered):
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLE))
    for scene in bpy.data.scenes:
        scene.render.resolution_x, scene.render.resolution_y = 64, 48
        image = scene.render.image_settings
        if hasattr(image, "media_type"):  # Blender 5
            image.media_type = "IMAGE"
        image.file_format, image.color_depth = "OPEN_EXR", "32"
    picture, caustics = bpy.data.scenes["Picture"], bpy.data.scenes["Caustics"]
    picture.cycles.samples, picture.cycles.use_denoising = 128, False
    caustics.rppm.samples, caustics.rppm.photons = 24, 65536
    return picture, caustics


def rendered(scene: bpy.types.Scene, path: Path) -> np.ndarray:
    """(H, W, 3) that F12 writes, row 0 at the bottom."""
    scene.render.filepath = str(path)
    bpy.context.window.scene = scene
    bpy.ops.render.render(write_still=True, scene=scene.name)
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    return np.stack([channels[name].pixels for name in "RGB"], axis=-1)[::-1].astype(np.float64)


@pytest.mark.long
def test_the_sum_is_the_picture_of_rppm(sample, tmp_path):
    picture, caustics = sample
    both, whole = rendered(picture, tmp_path / "both.exr"), rendered(caustics, tmp_path / "whole.exr")
    write_pair("caustics_over_cycles", both, whole)
    picture.render.use_compositing = False
    without = rendered(picture, tmp_path / "without.exr")
    assert without.mean() < 0.97 * whole.mean()
    assert abs(both.mean() / whole.mean() - 1.0) < ALLOWED_MEAN
    off = np.abs(block_means(both) / block_means(whole) - 1.0)
    assert (off < ALLOWED_BLOCK).mean() > ALLOWED_BLOCKS, np.round(off, 3)

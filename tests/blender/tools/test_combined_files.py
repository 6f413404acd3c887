# SPDX-License-Identifier: GPL-3.0-or-later
"""The random files that tools/combined_files makes."""

import bpy
import numpy as np
import pytest

from rppm_addon.blender.export import export_scene
from rppm_addon.scene import Scene
from tools.combined_files.__main__ import build, seeds
from tools.combined_files.draws import Draws
from tools.combined_files.scenes import KINDS, SIZE


def _exported(kind: str, seed: int) -> Scene:
    build(kind, seed)
    return export_scene(bpy.context.evaluated_depsgraph_get()).expanded()


@pytest.mark.parametrize("kind", KINDS)
def test_files_have_all_that_a_render_needs(registered, kind):
    scene = _exported(kind, 3)
    assert scene.camera.resolution == SIZE
    assert len(scene.instances) >= 12
    assert scene.lights


def test_a_seed_determines_a_file(registered):
    first, again, other = (_exported("low_poly", seed) for seed in (1, 1, 2))
    matrices = [np.array([instance.matrix for instance in scene.instances]) for scene in (first, again, other)]
    assert np.array_equal(matrices[0], matrices[1])
    assert matrices[0].shape != matrices[2].shape or not np.array_equal(matrices[0], matrices[2])


def test_draws_stay_in_their_ranges():
    draws = Draws("a test")
    colors = [draws.color(0.5, (0.2, 0.6)) for _ in range(100)]
    assert all(0.1 <= channel <= 0.6 for color in colors for channel in color[:3])
    assert all(color[3] == 1.0 for color in colors)


@pytest.mark.parametrize(("words", "expected"), [("4", [4]), ("2-5", [2, 3, 4, 5])])
def test_a_range_of_seeds_has_both_ends(words, expected):
    assert seeds(words) == expected

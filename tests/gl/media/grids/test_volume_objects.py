# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes: media whose nodes read grids of voxels."""

import numpy as np
import pytest
from support.lobes import Lobe, LobeKind, material
from volume_boxes import COLOR, SIZE, STEP, VOXELS, grid_of, picture, scene_of

from rppm_addon.scene import Material, NodeGraph, Volume, load_scene, save_scene

LENGTH = STEP * (VOXELS - 2)
"""Length through a density of 1, which falls to 0 over one voxel on each side."""


def test_an_even_volume_read_from_a_file(renderer, tmp_path):
    scene = scene_of(Volume({"density": grid_of(lambda at: np.ones(at.shape[:3]))}))
    expected = np.broadcast_to(np.exp(-COLOR * (LENGTH - STEP)), (SIZE, SIZE, 3))
    expected = expected * np.exp(-COLOR * STEP)
    save_scene(scene, tmp_path / "volume.npz")
    for each in (scene, load_scene(tmp_path / "volume.npz")):
        np.testing.assert_allclose(picture(renderer, each), expected, rtol=2e-2)


def test_a_linear_density(renderer):
    x = (1.6 * ((np.arange(SIZE) + 0.5) / SIZE - 0.5))[None, :, None]
    seen = picture(renderer, scene_of(Volume({"density": grid_of(lambda at: 1.0 + 0.5 * at[..., 0])}), iterations=64))
    expected = np.exp(-(1.0 + 0.5 * x) * COLOR * LENGTH)
    np.testing.assert_allclose(seen, np.broadcast_to(expected, seen.shape), rtol=3e-2)


@pytest.mark.parametrize("scales", [False, True])
def test_densities_by_length_in_the_object_or_the_world(renderer, scales):
    grid = grid_of(lambda at: np.ones(at.shape[:3]))
    seen = picture(renderer, scene_of(Volume({"density": grid}, scales), matrix=np.diag([3.0, 3.0, 3.0, 1.0])))
    length = LENGTH if scales else 3.0 * LENGTH
    np.testing.assert_allclose(seen, np.broadcast_to(np.exp(-COLOR * length), seen.shape), rtol=5e-2)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -5.0])
def test_voxels_that_cannot_be_rendered_count_as_none(renderer, bad):
    grid = grid_of(lambda at: np.full(at.shape[:3], bad))
    np.testing.assert_array_equal(picture(renderer, scene_of(Volume({"density": grid}), iterations=1)), 1.0)


def test_a_volume_without_the_grid_is_clear(renderer):
    np.testing.assert_array_equal(picture(renderer, scene_of(Volume({}), iterations=1)), 1.0)


def test_a_grid_that_lacks_leaves_principled_volumes_even(renderer):
    graph = NodeGraph()
    grid = graph.add("grid_attribute", "fac", attribute="density")
    graph.surface = graph.add("volume_principled", "volume", color=(0.0, 0.0, 0.0), density=0.5, density_grid=grid)
    surface = Material("smoke", material("clear", Lobe(LobeKind.TRANSPARENT)).graph, graph, reads_grids=True)
    seen = picture(renderer, scene_of(Volume({}), surface, iterations=1))
    np.testing.assert_allclose(seen, np.exp(-0.5 * STEP * (VOXELS - 1)), rtol=1e-3)
    found = picture(renderer, scene_of(Volume({"density": grid_of(lambda at: np.ones(at.shape[:3]))}), surface))
    np.testing.assert_allclose(found, np.exp(-0.5 * LENGTH), rtol=1e-2)

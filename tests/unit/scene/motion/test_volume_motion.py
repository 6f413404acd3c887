# SPDX-License-Identifier: GPL-3.0-or-later
"""Grids of volumes at places, and the motion of their values."""

import dataclasses

import numpy as np
import pytest
from support.full_scene import full_scene

from rppm_addon.scene import Scene, Volume, VolumeGrid, VolumeMotion, load_scene, save_scene
from rppm_addon.scene.errors import SceneError
from rppm_addon.scene.storage.validation import check_scene

MATRIX = np.array([[0.5, 0.0, 0.1, -1.0], [0.0, 0.25, 0.0, 2.0], [0.0, 0.0, 0.5, 0.0], [0.0, 0.0, 0.0, 1.0]])


def grid_of(function, counts=(9, 8, 7), matrix=MATRIX) -> VolumeGrid:
    """A function of the places of voxels (x, y, z, 3)."""
    indices = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1)
    values = function(indices @ matrix[:3, :3].T + matrix[:3, 3])
    return VolumeGrid(np.asarray(values, np.float32), matrix)


def places_within(grid: VolumeGrid, count: int = 200) -> np.ndarray:
    last = np.array(grid.values.shape[:3]) - 1
    return np.random.default_rng(1).random((count, 3)) * last @ grid.matrix[:3, :3].T + grid.matrix[:3, 3]


def test_values_are_interpolated_between_voxels():
    grid = grid_of(lambda at: np.stack([at[..., 0] + 2.0 * at[..., 1] - at[..., 2], np.ones(at.shape[:3])], axis=-1))
    places = places_within(grid)
    expected = places @ [1.0, 2.0, -1.0]
    np.testing.assert_allclose(grid.at(places), np.stack([expected, np.ones(len(places))], axis=1), rtol=1e-4)


def test_values_fall_to_zero_beyond_the_voxels():
    grid = VolumeGrid(np.ones((2, 2, 2, 1), np.float32), np.eye(4))
    places = np.array([[-0.25, 0.0, 0.0], [1.5, 1.0, 1.0], [3.0, 0.0, 0.0], [0.0, -1e30, 0.0]])
    np.testing.assert_allclose(grid.at(places)[:, 0], [0.75, 0.5, 0.0, 0.0])


def test_even_velocities_bring_values_from_behind():
    motion = VolumeMotion(grid_of(lambda at: np.broadcast_to([1.0, -2.0, 0.0], at.shape)), 0.25)
    at = np.array([[0.5, 2.9, 1.5]])
    for time, way in ((0.0, 0.25), (0.25, 0.0), (0.5, -0.25)):
        np.testing.assert_allclose(motion.sources(at, time), at + way * np.array([1.0, -2.0, 0.0]), atol=1e-6)
    low, high = motion.reach
    np.testing.assert_allclose((low, high), ([-0.25, -1.5, 0.0], [0.75, 0.5, 0.0]))


def test_values_that_turn_come_from_where_they_turn_from():
    """Velocities are those at the source, to the second order in the angle."""
    turn, around = 0.1, np.diag([0.5, 0.5, 0.5, 1.0])
    around[:3, 3] = -2.0
    ways = grid_of(lambda at: turn * np.stack([-at[..., 1], at[..., 0], 0.0 * at[..., 2]], -1), (9, 9, 9), around)
    places = np.random.default_rng(1).random((50, 3)) * 2.0 - 1.0
    x, y, z = places.T
    expected = np.stack([x * (1 - turn**2) + turn * y, y * (1 - turn**2) - turn * x, z], axis=1)
    np.testing.assert_allclose(VolumeMotion(ways, 0.0).sources(places, 1.0), expected, atol=1e-6)


def scene_with(motion: VolumeMotion) -> Scene:
    scene = full_scene()
    volume = Volume({"density": VolumeGrid(np.ones((2, 3, 4, 1), np.float32), np.eye(4))}, motion=motion)
    scene.meshes[0] = dataclasses.replace(scene.meshes[0], volume=volume)
    return scene


def test_motion_is_kept_in_files(tmp_path):
    motion = VolumeMotion(grid_of(lambda at: at), -0.5)
    save_scene(scene_with(motion), tmp_path / "scene.npz")
    found = load_scene(tmp_path / "scene.npz").meshes[0].volume.motion
    assert found.rest_time == -0.5
    np.testing.assert_array_equal(found.displacements.values, motion.displacements.values)


@pytest.mark.parametrize("bad", ["channels", "infinite", "empty"])
def test_displacements_that_are_none_are_refused(bad):
    values = np.ones((2, 2, 2, 3), np.float32)
    if bad == "channels":
        values = values[..., :2]
    elif bad == "infinite":
        values[0, 0, 0, 0] = np.inf
    else:
        values = values[:0]
    with pytest.raises(SceneError, match="three finite numbers"):
        check_scene(scene_with(VolumeMotion(VolumeGrid(values, np.eye(4)), 0.5)))

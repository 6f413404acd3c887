# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes at moments while the shutter is open."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.floor import floor_scene

from rppm_addon.integrator.device_scene.moments import moment
from rppm_addon.integrator.device_scene.shutter import swept_bounds
from rppm_addon.scene import CameraMovement, Deformation, Light, LightKind, Movement, MovingScene, Scene, Shutter
from rppm_addon.scene.storage.sharing import equal, same_members, share
from rppm_addon.scene.storage.storage import load_scene, save_scene

ENDS = np.array([0.0, 1.0])


def turned(axis, angle):
    """(4, 4) rotation by Rodrigues' formula."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    result = np.eye(4)
    result[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return result


def moved(*translation):
    result = np.eye(4)
    result[:3, 3] = translation
    return result


def with_shutter(**members) -> Scene:
    return dataclasses.replace(floor_scene(), shutter=Shutter(np.ones(8), **members))


def matrix_at(time, times, *matrices):
    scene = with_shutter(instances=[Movement(0, np.asarray(times, float), np.stack(matrices))])
    return MovingScene(scene).at(time).instances[0].matrix


axes = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda axis: np.linalg.norm(axis) > 0.1)


@settings(deadline=None, derandomize=True)
@given(axes, st.floats(0.01, 3.1), st.floats(0.0, 1.0), axes, st.floats(0.0, 3.1), st.booleans())
def test_what_turns_goes_round(axis, angle, time, first_axis, first_angle, mirrored):
    start = turned(first_axis, first_angle)
    stretch = np.diag([2.0, -0.5 if mirrored else 0.5, 1.5, 1.0])
    found = matrix_at(time, ENDS, start @ stretch, turned(axis, angle) @ start @ stretch)
    np.testing.assert_allclose(found, turned(axis, time * angle) @ start @ stretch, atol=1e-9)


def test_places_and_sizes_go_straight():
    found = matrix_at(0.25, ENDS, moved(1, 2, 3) @ np.diag([1, 1, 1, 1.0]), moved(5, 2, -1) @ np.diag([3, 1, 5, 1.0]))
    np.testing.assert_allclose(found, moved(2, 2, 2) @ np.diag([1.5, 1, 2, 1.0]), atol=1e-12)


def test_what_grows_from_nothing_grows():
    found = matrix_at(0.5, ENDS, np.diag([0, 0, 0, 1.0]), np.diag([2, 2, 2, 1.0]))
    np.testing.assert_allclose(found, np.diag([1, 1, 1, 1.0]), atol=1e-12)


def test_keys_are_met():
    keys = [turned((1, 2, 3), angle) @ moved(angle, 0, 0) for angle in (0.0, 2.5, 4.0, 9.0, 1.0)]
    for time, key in zip(np.linspace(0, 1, 5), keys, strict=True):
        np.testing.assert_allclose(matrix_at(time, np.linspace(0, 1, 5), *keys), key, atol=1e-12)


def test_what_stays_is_shared():
    scene = with_shutter(instances=[Movement(0, ENDS, np.stack([np.eye(4), moved(1, 0, 0)]))])
    at = MovingScene(scene).at(0.5)
    assert at.shutter is None and at.camera is scene.camera and at.world is scene.world
    assert at.meshes is scene.meshes and at.lights is scene.lights and at.materials is scene.materials
    assert same_members(at.instances[1:], scene.instances[1:]) and at.instances[0] is not scene.instances[0]
    np.testing.assert_array_equal(scene.instances[0].matrix, floor_scene().instances[0].matrix)


def test_meshes_lights_and_the_camera_move():
    scene = with_shutter()
    scene.lights = [Light("light", LightKind.POINT, np.eye(4), np.ones(3))]
    mesh = scene.meshes[0]
    shapes = np.stack([mesh.positions, mesh.positions + np.float32([0, 0, 2])])
    normals = np.zeros((2, *mesh.corner_normals.shape), np.float32)
    normals[0, :, 2], normals[1, :, 0] = 1.0, 1.0
    scene.shutter = Shutter(
        np.ones(8),
        lights=[Movement(0, ENDS, np.stack([np.eye(4), moved(4, 0, 0)]))],
        meshes=[Deformation(0, ENDS, shapes, normals)],
        camera=CameraMovement(
            ENDS, np.stack([np.eye(4), moved(0, 2, 0)]), np.array([[-1, 1, -1, 1], [-2, 2, -3, 3]], float)
        ),
    )
    at = MovingScene(scene).at(0.5)
    np.testing.assert_allclose(at.lights[0].matrix, moved(2, 0, 0))
    np.testing.assert_allclose(at.camera.matrix, moved(0, 1, 0))
    assert at.camera.window == (-1.5, 1.5, -2.0, 2.0)
    np.testing.assert_allclose(at.meshes[0].positions, mesh.positions + np.float32([0, 0, 1]))
    np.testing.assert_allclose(at.meshes[0].corner_normals[0], [0.5, 0.0, 0.5])
    assert at.meshes[0].positions.dtype == at.meshes[0].corner_normals.dtype == np.float32


def test_the_curve_says_when_light_passes():
    opening = Shutter(np.linspace(0.0, 2.0, 2049)[1::2])
    for passed in (0.0, 0.1, 0.5, 0.9, 1.0):
        assert abs(opening.time_of(passed) - passed**0.5) < 1e-3
    assert Shutter(np.zeros(4)).time_of(0.3) == 0.3


@pytest.mark.parametrize("seed", [0, 7])
@pytest.mark.parametrize("count", [1, 4, 64])
def test_few_iterations_are_spread_over_the_time(count, seed):
    """Each has a part of the time of its own, and a random place in it."""
    times = np.sort([moment(iteration, seed) for iteration in range(1, count + 1)])
    np.testing.assert_array_equal(np.floor(times * count), np.arange(count))
    assert not np.array_equal(times, np.sort([moment(i, seed + 1) for i in range(1, count + 1)]))
    assert count < 64 or np.std(times * count % 1.0) > 0.2


def test_moments_leave_the_lens_free():
    """In each part of the lens, which scrambled Sobol points visit, all of the time passes."""

    def owen(values, seed):
        bits = np.array([int(f"{value:032b}"[::-1], 2) for value in values], np.uint32)
        bits += np.uint32(seed)
        for factor in (0x6C50B47C, 0xB82F1E52, 0xC7AFE638, 0x8D22F6E6):
            bits ^= bits * np.uint32(factor)
        return np.array([int(f"{int(value):032b}"[::-1], 2) for value in bits], np.uint32)

    times = np.array([moment(iteration, 3) for iteration in range(1, 1025)])
    for seeds in ((1234567891, 987654321), (42, 4000000000)):
        shuffled = owen(range(1024), seeds[0])
        places = owen([int(f"{int(value):032b}"[::-1], 2) for value in shuffled], seeds[1]) / 2.0**32
        table = np.histogram2d(times, places, bins=8)[0]
        assert np.sum((table - 16.0) ** 2 / 16.0) < 103.4  # chi-squared, 63 degrees of freedom, 0.1 %


def test_bounds_hold_what_moves():
    matrices = np.stack([moved(0, 0, 0), moved(30, 0, 0), moved(0, 0, 40)])
    scene = with_shutter(instances=[Movement(0, np.array([0, 0.5, 1]), matrices)])
    low, high = swept_bounds(scene)
    vertices = scene.meshes[scene.instances[0].mesh].positions
    np.testing.assert_allclose(low, vertices.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(high, vertices.max(axis=0) + [30, 0, 40], atol=1e-6)
    assert not np.isfinite(swept_bounds(with_shutter())).any()


def test_shutters_are_saved_and_compared(tmp_path):
    scene = with_shutter(instances=[Movement(0, ENDS, np.stack([np.eye(4), moved(1, 0, 0)]))])
    save_scene(scene, tmp_path / "scene.npz")
    again = load_scene(tmp_path / "scene.npz")
    assert equal(again.shutter, scene.shutter)
    assert share(scene, dataclasses.replace(scene, shutter=again.shutter)) is scene
    assert share(scene, dataclasses.replace(scene, shutter=None)).shutter is None

# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass Vector, by closed forms."""

import dataclasses

import numpy as np
import scenes
from rendering import iterated
from support.render_states import assert_goes_on

from rppm_addon.scene import Camera, Light, LightKind, Panorama, PanoramaKind, Scene
from rppm_addon.scene.motion import CameraMovement, Deformation, Movement, Shutter

TIMES = np.array([0.0, 0.5, 1.0])


def moved(*offset: float) -> np.ndarray:
    return scenes.placed(*offset)


SUN = Light("sun", LightKind.SUN, np.eye(4), np.ones(3))
SETTINGS = {"photons": 64, "filter_width": 0.0, "passes": ("Vector",)}


def orthographic() -> Scene:
    """8 x 8 pixels of a quarter meter: on the left a sheet that moves, on the right one that stretches, beyond them
    nothing; the camera moves as well."""
    camera = scenes.camera((0, 0, 3), (0, 0, 0), 1.0, 8, True)
    moves = scenes.rectangle("moves", (-0.9, -0.6, 0), (0, -0.6, 0), (0, 0.6, 0), (-0.9, 0.6, 0))
    stretches = scenes.rectangle("stretches", (0, -0.6, 0), (0.9, -0.6, 0), (0.9, 0.6, 0), (0, 0.6, 0))
    parts = [(mesh, scenes.diffuse(1, 1, 1)) for mesh in (moves, stretches)]
    scene = scenes.scene_of(camera, *parts, lights=[SUN], iterations=4, **SETTINGS)
    wide = stretches.positions * np.float32([1.5, 1, 1])
    shapes = np.stack([stretches.positions, stretches.positions, wide])
    cameras = np.stack([camera.matrix @ moved(0, 0.25, 0), camera.matrix, camera.matrix])
    scene.neighbors = Shutter(
        np.ones(1),
        [Movement(0, TIMES, np.stack([moved(-0.5, 0, 0), moved(0, 0, 0), moved(0.25, 0.75, 0)]))],
        meshes=[Deformation(1, TIMES, shapes, np.stack([stretches.corner_normals] * 3))],
        camera=CameraMovement(TIMES, cameras, np.stack([camera.window] * 3)),
    )
    return scene


def test_what_moves_and_what_bends(renderer):
    vectors = renderer.render(orthographic()).frame.passes["Vector"]
    x = (np.arange(8) + 0.5) / 4 - 1.0
    seen = (np.abs(x[None]) < 0.9) & (np.abs(x[:, None]) < 0.6)
    # Before, the camera stood a pixel higher.
    moves = np.broadcast_to((-2.0, -1.0, -1.0, -3.0), (8, 8, 4))
    stretches = np.stack([*np.broadcast_arrays(0.0, -1.0, -0.5 * x / 0.25, 0.0)], axis=-1)
    expected = np.where(seen[..., None], np.where((x < 0.0)[None, :, None], moves, stretches[None]), 0.0)
    np.testing.assert_allclose(vectors, expected, atol=1e-5)


def test_panoramas_take_the_shorter_way_over_their_edge(renderer):
    """A camera in a tube turns by two pixels, then by three: all vectors are alike, at its edges too."""
    camera = Camera(np.eye(4), (0.0, 1.0, 0.0, 1.0), 16, 8, panorama=Panorama(PanoramaKind.EQUIRECTANGULAR))
    angles = 2.0 * np.pi * np.arange(32) / 32
    ring = np.stack([np.sin(angles), np.zeros(32), np.cos(angles)], axis=-1)
    sides = [(k, (k + 1) % 32, (k + 1) % 32 + 32, k + 32) for k in range(32)]
    tube = scenes.polygons("tube", np.concatenate([ring - (0, 9, 0), ring + (0, 9, 0)]), sides)
    cameras = np.stack([rotated(-2.0), np.eye(4), rotated(3.0)])
    scene = scenes.scene_of(camera, (tube, scenes.diffuse(1, 1, 1)), lights=[SUN], iterations=1, **SETTINGS)
    scene.neighbors = Shutter(np.ones(1), camera=CameraMovement(TIMES, cameras, np.stack([camera.window] * 3)))
    vectors = renderer.render(scene).frame.passes["Vector"][2:6]
    np.testing.assert_allclose(vectors, np.broadcast_to((2.0, 0.0, 3.0, 0.0), vectors.shape), atol=1e-3)


def rotated(pixels: float) -> np.ndarray:
    """A camera turned to the right by pixels of 16 all around."""
    angle = 2.0 * np.pi * pixels / 16
    matrix = np.eye(4)
    matrix[[0, 0, 2, 2], [0, 2, 0, 2]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
    return matrix


def test_the_background_does_not_count_where_a_surface_was_seen(renderer):
    scene = orthographic()
    scene.settings = dataclasses.replace(scene.settings, filter_width=1.5, iterations=16)
    vectors = renderer.render(scene).frame.passes["Vector"]
    found = vectors[..., 1] != 0.0
    assert 24 < found.sum() < 64  # edges are seen by some iterations only
    np.testing.assert_allclose(vectors[found][:, 1], -1.0, atol=1e-5)


def test_a_render_goes_on_bit_for_bit(mapper):
    scene = orthographic()
    scene.settings = dataclasses.replace(scene.settings, filter_width=1.5)
    assert assert_goes_on(mapper, scene, "passes", "pass_counts").passes["Vector"].any()
    iterated(mapper, dataclasses.replace(scene, neighbors=None))
    assert not mapper.film.read_passes()["Vector"].any()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Odd and broken scenes: a picture where one makes sense, else one clear error."""

import numpy as np
import pytest
import scenes

from rppm_addon.scene import Camera, Instance, Light, LightKind, Mesh, Scene, World
from rppm_addon.scene.errors import SceneError, SettingsError


def small_room(**settings):
    return scenes.room(16, **{"iterations": 4, "photons": 8192, **settings})


def picture(renderer, scene):
    frame = renderer.render(scene).frame
    for array in (frame.combined, *frame.passes.values()):
        assert np.isfinite(array).all()
    return frame


def scaled(scene: Scene, factor: float) -> Scene:
    """The same scene in other units; radiance of area lights does not depend on scale."""
    enlarge = np.diag([factor, factor, factor, 1.0])
    for thing in (*scene.instances, *scene.lights):
        thing.matrix = enlarge @ thing.matrix
    scene.camera.matrix[:3, 3] *= factor
    scene.camera.clip_start *= factor
    scene.camera.clip_end *= factor
    return scene


@pytest.mark.parametrize("factor", [0.001, 100.0])
def test_scale_does_not_matter(renderer, factor):
    expected = picture(renderer, small_room(iterations=8)).combined
    got = picture(renderer, scaled(small_room(iterations=8), factor)).combined
    print("mean", got[..., :3].mean() / expected[..., :3].mean())
    assert got[..., :3].mean() == pytest.approx(expected[..., :3].mean(), rel=0.02)
    assert np.median(abs(got - expected)) < 0.02 * expected[..., :3].mean()


def test_a_scene_far_from_the_origin(renderer):
    expected = picture(renderer, small_room()).combined
    scene = small_room()
    for matrix in [thing.matrix for thing in (*scene.instances, *scene.lights)] + [scene.camera.matrix]:
        matrix[:3, 3] += 500.0
    assert picture(renderer, scene).combined[..., :3].mean() == pytest.approx(expected[..., :3].mean(), rel=0.05)


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (300, 1)])
def test_thin_pictures(renderer, size):
    scene = small_room()
    scene.camera.width, scene.camera.height = size
    frame = picture(renderer, scene)
    assert frame.combined.shape == (size[1], size[0], 4)
    assert frame.combined[..., :3].max() > 0


def test_crop_is_a_part_of_the_whole(renderer):
    whole = picture(renderer, small_room(filter_width=0.0))
    scene = small_room(filter_width=0.0)
    scene.camera.crop = (3, 5, 12, 9)
    part = picture(renderer, scene)
    np.testing.assert_allclose(part.passes["Depth"], whole.passes["Depth"][5:9, 3:12], rtol=1e-4)
    np.testing.assert_allclose(part.passes["Normal"], whole.passes["Normal"][5:9, 3:12], atol=2e-3)


def test_broken_geometry_leaves_the_rest(renderer):
    expected = picture(renderer, small_room(iterations=8)).combined[..., :3].mean()
    scene = small_room(iterations=8)
    spoiled = scenes.rectangle("spoiled", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))
    spoiled.positions[:] = np.nan
    line = scenes.rectangle("line", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))
    line.positions[:, 1:] = 0.0
    empty = Mesh(
        "empty",
        np.zeros((0, 3), np.float32),
        np.zeros(0, np.int32),
        np.zeros((0, 3), np.float32),
        np.zeros((0, 3), np.int32),
        np.zeros(0, np.int32),
    )
    scene.meshes += [spoiled, line, empty]
    scene.instances += [Instance(6, np.eye(4), [0]), Instance(7, np.eye(4), [0]), Instance(8, np.eye(4), [0])]
    scene.instances += [Instance(0, np.zeros((4, 4)), [0]), Instance(0, np.full((4, 4), np.nan), [0])]
    assert picture(renderer, scene).combined[..., :3].mean() == pytest.approx(expected, rel=0.05)


def test_an_empty_scene_shows_the_world(renderer):
    camera = Camera(np.eye(4), (-1, 1, -1, 1), 8, 8)
    scene = Scene(camera, world=World(np.array([0.1, 0.2, 0.3])), settings=small_room().settings)
    frame = picture(renderer, scene)
    np.testing.assert_allclose(frame.combined, np.broadcast_to([0.1, 0.2, 0.3, 1.0], (8, 8, 4)), rtol=1e-5)
    assert (frame.passes["Depth"] == np.float32(1e10)).all()
    scene.settings.film_transparent = True
    assert (picture(renderer, scene).combined == 0).all()


def test_a_camera_that_sees_nothing(renderer):
    scene = small_room()
    scene.camera.matrix = scenes.looking((0, -3.6, 0), (0, -10, 0))
    assert (picture(renderer, scene).combined[..., :3] == 0).all()


@pytest.mark.parametrize("kind", ["none", "black", "zero area"])
def test_without_light_the_picture_is_black(renderer, kind, caplog):
    scene = small_room()
    if kind == "none":
        scene.lights = []
    elif kind == "black":
        scene.lights[0].strength = np.zeros(3)
    else:
        scene.lights[0].size = (0.0, 0.0)
    frame = renderer.render(scene).frame
    assert not frame.combined[..., :3].any() and (frame.combined[..., 3] == 1).all()
    assert "nothing in the scene emits light; add a light" in caplog.text


def test_no_share_of_photons_is_an_error(renderer):
    scene = small_room()
    scene.lights[0].photon_weight = 0.0
    with pytest.raises(SceneError, match="photon weight"):
        renderer.render(scene)


def test_settings_are_checked_before_work(renderer):
    with pytest.raises(SettingsError, match="photons is -1; set it to"):
        renderer.render(small_room(photons=-1))


def test_a_broken_camera_is_an_error(renderer):
    scene = small_room()
    scene.camera.matrix[:] = np.nan
    with pytest.raises(SceneError, match="camera"):
        renderer.render(scene)


def test_light_with_a_matrix_that_is_not_finite_is_left_out(renderer):
    scene = small_room()
    scene.lights.append(Light("bad", LightKind.AREA, np.full((4, 4), np.nan), np.ones(3)))
    picture(renderer, scene)


def test_stopping_keeps_the_picture(renderer):
    result = renderer.render(small_room(iterations=50), should_stop=lambda: True)
    assert result.stopped and result.statistics.iterations == 1
    assert result.frame.combined[..., :3].max() > 0


def test_the_same_seed_gives_the_same_picture(renderer):
    first, again = (picture(renderer, small_room()).combined for _ in range(2))
    other = picture(renderer, small_room(seed=1)).combined
    np.testing.assert_allclose(again, first, rtol=1e-3, atol=1e-4)
    assert abs(other - first).max() > 0.01

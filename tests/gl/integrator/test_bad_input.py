# SPDX-License-Identifier: GPL-3.0-or-later
"""Odd and broken scenes: a picture where one makes sense, else one clear error."""

import numpy as np
import pytest
import scenes

from rppm_addon.scene import Camera, Instance, Light, LightKind, Scene, World
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
    assert got[..., :3].mean() == pytest.approx(expected[..., :3].mean(), rel=0.02)
    assert np.median(abs(got - expected)) < 0.02 * expected[..., :3].mean()


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
    spoiled, line, empty = (scenes.square(name, 1.0) for name in ("spoiled", "line", "empty"))
    spoiled.positions[:] = np.nan
    line.positions[:, 1:] = 0.0
    empty.triangle_corners, empty.triangle_slots = empty.triangle_corners[:0], empty.triangle_slots[:0]
    scene.meshes += [spoiled, line, empty]
    scene.instances += [Instance(number, np.eye(4), [0]) for number in (6, 7, 8)]
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


@pytest.mark.parametrize(
    ("spoil", "error", "said"),
    [
        (lambda scene: setattr(scene.lights[0], "photon_weight", 0.0), SceneError, "photon weight"),
        (lambda scene: setattr(scene.settings, "photons", -1), SettingsError, "photons is -1; set it to"),
        (lambda scene: scene.camera.matrix.fill(np.nan), SceneError, "camera"),
    ],
    ids=["no share of photons", "settings", "camera"],
)
def test_what_cannot_be_rendered_is_an_error(renderer, spoil, error, said):
    scene = small_room()
    spoil(scene)
    with pytest.raises(error, match=said):
        renderer.render(scene)


def test_light_with_a_matrix_that_is_not_finite_is_left_out(renderer):
    scene = small_room()
    scene.lights.append(Light("bad", LightKind.AREA, np.full((4, 4), np.nan), np.ones(3)))
    picture(renderer, scene)


def test_stopping_keeps_the_picture(renderer):
    result = renderer.render(small_room(iterations=50), should_stop=lambda: True)
    assert result.stopped and result.statistics.iterations == 1
    assert result.frame.combined[..., :3].max() > 0

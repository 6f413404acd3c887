# SPDX-License-Identifier: GPL-3.0-or-later
"""The first look covers what the renderer's picture covers, in the colors of the materials."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.viewport.first_look import FirstLook
from rppm_addon.scene import Instancing, Scene, World
from rppm_addon.scene.meshes import RayVisibility
from rppm_addon.session.placeholders import first_looks

SIZE = 96
RED, GREEN = (0.8, 0.05, 0.05), (0.05, 0.8, 0.05)


@pytest.fixture
def draw(mapper, context, library):
    look = FirstLook(context, library, mapper.device_scene.geometry)
    yield look.draw
    look.release()


def balls(**changes: object) -> Scene:
    """A red ball to the left, in front of a green one in the middle; nothing is there to the right."""
    camera = dataclasses.replace(scenes.room(SIZE).camera, height=SIZE // 2, window=(-0.4, 0.4, -0.2, 0.2))
    settings = {"iterations": 32, "photons": 64, "camera_path_length": 2, "photon_path_length": 2}
    parts = [(scenes.sphere("ball"), scenes.diffuse(*color)) for color in (RED, GREEN)]
    scene = scenes.scene_of(camera, *parts, world=World(np.ones(3)), film_transparent=True, **settings)
    places = scenes.placed(-0.6, -1.0, 0.0, 0.4), scenes.placed(0.0, 0.5, 0.1, 0.6)
    for instance, matrix in zip(scene.instances, places, strict=True):
        instance.matrix = matrix
    return dataclasses.replace(scene, **changes)


def camera_of(name: str):
    camera = balls().camera
    if name == "orthographic":
        return dataclasses.replace(camera, orthographic=True, window=(-1.4, 1.4, -0.7, 0.7))
    if name == "crop":
        return dataclasses.replace(camera, crop=(10, 5, 70, 40))
    return camera


@pytest.mark.parametrize("name", ["perspective", "orthographic", "crop"])
def test_the_first_look_covers_what_the_picture_covers(draw, mapper, name):
    scene = balls(camera=camera_of(name))
    look = draw(scene)
    mapper.update(scene)
    for _ in range(scene.settings.iterations):
        mapper.iterate()
    alpha = mapper.film.read_radiance()[..., 3]
    assert look.shape == (*alpha.shape, 4) and look.dtype == np.float32
    inside, outside = alpha > 0.999, alpha < 0.001
    assert inside.mean() > 0.1 and outside.mean() > 0.1 and (inside | outside).mean() > 0.8
    assert (look[..., 3][inside] == 1.0).all() and not look[outside].any()


def test_colors_and_depth(draw):
    look = draw(balls())
    red, green = look[..., 0] > 2.0 * look[..., 1], look[..., 1] > 2.0 * look[..., 0]
    assert (red | green)[look[..., 3] == 1.0].mean() > 0.95
    row, column = np.argwhere(red & (look[..., 3] == 1.0)).mean(axis=0)
    assert abs(row - 0.5 * (SIZE // 2)) < 2.0 and column < 0.4 * SIZE
    middle = look[SIZE // 4, SIZE // 2]
    assert green[SIZE // 4, SIZE // 2] and 0.2 < middle[1] < 1.5


def test_the_background_is_the_worlds_unless_the_film_is_transparent(draw):
    settings = dataclasses.replace(balls().settings, film_transparent=False)
    look = draw(balls(settings=settings, world=World(np.array([0.1, 0.2, 0.4])), exposure=2.0))
    np.testing.assert_allclose(look[-1, -1], (0.2, 0.4, 0.8, 1.0), rtol=1e-6)


def test_a_large_look_is_enlarged(mapper, context, library, monkeypatch):
    looks = first_looks.FirstLooks(context, library)
    whole = looks.draw(balls(), mapper)
    monkeypatch.setattr(first_looks, "MOST_PIXELS", whole[..., 0].size // 4)
    coarse = looks.draw(balls(), mapper)
    looks.release()
    assert coarse.shape == whole.shape == (SIZE // 2, SIZE, 4)
    np.testing.assert_array_equal(coarse[::2, ::2], coarse[1::2, 1::2])  # each pixel is there four times
    assert np.mean(np.abs(coarse - whole) > 0.02) < 0.1  # at the outlines of two balls


def test_emission_goes_with_the_exposure(draw):
    glowing = [material("light", Lobe(LobeKind.EMISSION, color=(1.0, 0.5, 0.25), strength=4.0)), scenes.diffuse(*GREEN)]
    dark = draw(balls(materials=glowing))
    bright = draw(balls(materials=glowing, exposure=2.0))
    at = np.argwhere(dark[..., 0] > 3.0).mean(axis=0).astype(int)
    # What it reflects besides is far less.
    np.testing.assert_allclose(bright[*at, :3] - dark[*at, :3], (4.0, 2.0, 1.0), rtol=0.05, atol=0.05)


def test_what_is_transparent_shows_what_is_behind(draw):
    scene = balls()
    clear = [material("clear", Lobe(LobeKind.TRANSPARENT)), scenes.diffuse(*GREEN)]
    glass = [material("glass", Lobe(LobeKind.GLASS)), scenes.diffuse(*GREEN)]
    alone = draw(dataclasses.replace(scene, instances=scene.instances[1:]))
    np.testing.assert_array_equal(draw(dataclasses.replace(scene, materials=clear)), alone)
    through = draw(dataclasses.replace(scene, materials=glass))
    assert ((through[..., 3] > 0.0) & (through[..., 3] < 1.0)).any()
    assert (through[..., 3] >= alone[..., 3]).all()


def test_what_the_camera_does_not_see(draw):
    scene = balls()
    alone = draw(dataclasses.replace(scene, instances=scene.instances[1:]))
    unseen = dataclasses.replace(scene.instances[0], visibility=RayVisibility.ALL & ~RayVisibility.CAMERA)
    catcher = dataclasses.replace(scene.instances[0], shadow_catcher=True)
    for instance in (unseen, catcher):
        shown = dataclasses.replace(scene, instances=[instance, scene.instances[1]])
        np.testing.assert_array_equal(draw(shown), alone)
    held = dataclasses.replace(scene.instances[0], holdout=True)
    hole = dataclasses.replace(scene, instances=[held, *scene.instances[1:]])
    with_hole, both = draw(hole), draw(scene)
    red = both[..., 0] > 2.0 * both[..., 1]
    assert not with_hole[red].any()


def test_a_scene_without_triangles_is_its_background(draw):
    assert not draw(balls(instances=[])).any()


def test_the_pictures_after_a_first_look_are_the_same(draw, mapper, other_mapper):
    scene = scenes.room(24, photons=256)
    draw(scene)
    pictures = []
    for renderer in (mapper, other_mapper):
        renderer.update(scene)
        renderer.iterate()
        pictures.append(renderer.film.read_radiance())
    np.testing.assert_array_equal(*pictures)


def test_instances_that_are_not_expanded_are_drawn_where_expanded_ones_are(mapper, context, library):
    """Flat triangles differ from smooth ones by their shading alone."""
    built, drawn = mapper.device_scene, []
    for instancing in (Instancing.EXPANDED, Instancing.TWO_LEVELS):
        look = FirstLook(context, library, built.geometry, instanced=built.acceleration.instanced_members)
        drawn.append(look.draw(scenes.room(SIZE, instancing=instancing)))
        look.release()
        assert (built.geometry.instanced is None) == (instancing is Instancing.EXPANDED)
    expanded, in_levels = drawn
    np.testing.assert_array_equal(in_levels[..., 3], expanded[..., 3])
    differs = np.abs(in_levels - expanded).max(axis=-1) > 0.0
    assert 0.02 < differs.mean() < 0.2  # the two balls
    assert np.abs(in_levels - expanded)[differs].mean() < 0.05

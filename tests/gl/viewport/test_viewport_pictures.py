# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of few samples and pixels in viewports, and the last picture while the view moves."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.floor import floor_scene

from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.common.viewport_demands import ViewportDemands
from rppm_addon.integrator.viewport.first_look import FirstLook
from rppm_addon.integrator.viewport.noise_filter import MAX_SAMPLES, strength
from rppm_addon.integrator.viewport.pictures import ViewportPictures, demands_of, expected_bytes
from rppm_addon.integrator.viewport.reprojection import HISTORY_ENDS, differ_by_view
from rppm_addon.scene import Light, LightKind
from rppm_addon.scene.scene import Scene
from rppm_addon.session.placeholders.resolution_scaler import at_level

FILTERED = ViewportDemands(is_filtered=True)
SIZE = 48


@pytest.fixture
def pictures(context, library, mapper):
    first_look = FirstLook(context, library, mapper.device_scene.geometry)
    pictures = ViewportPictures(context, library, first_look)
    yield pictures
    pictures.release()
    first_look.release()


def room(**settings: object) -> Scene:
    values = {"photons": 1024, "iterations": 128, "passes": ()} | settings
    return scenes.room(SIZE, **values)


def sunlit(angle: float, energy: float = 3.0) -> Light:
    """A sun that shines down, tilted toward +X."""
    matrix = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    matrix[:3, :3] = [[c, 0, s], [0, 1, 0], [-s, 0, c]]
    return Light("Sun", LightKind.SUN, matrix, np.full(3, energy))


def lit_floor() -> Scene:
    """A floor below two suns, of which a roof that the camera does not see hides one."""
    scene = floor_scene()
    roof = scenes.rectangle("roof", (1, -30, 3), (40, -30, 3), (40, 30, 3), (1, 30, 3))
    unseen = dataclasses.replace(scene.instances[0], mesh=1)
    scene.meshes, scene.instances = [*scene.meshes, roof], [*scene.instances, unseen]
    scene.lights = [sunlit(1.2), sunlit(-0.6)]
    scene.settings = dataclasses.replace(
        scene.settings, use_final_gather=False, photon_path_length=1, iterations=128, passes=()
    )
    return scene


def turned(scene: Scene, columns: int = 0, rows: int = 0) -> Scene:
    """The same, seen through a window that is so many pixels on."""
    camera = scene.camera
    left, right, bottom, top = camera.window
    x, y = columns * (right - left) / camera.width, rows * (top - bottom) / camera.height
    window = (left + x, right + x, bottom + y, top + y)
    return dataclasses.replace(scene, camera=dataclasses.replace(camera, window=window))


def render(mapper, scene, iterations, demands=FILTERED):
    mapper.update(scene, demands=demands)
    for _ in range(iterations):
        mapper.iterate()
    return mapper.film.read_radiance()


def test_what_viewports_keep_changes_no_film(mapper):
    scene = room()
    np.testing.assert_array_equal(render(mapper, scene, 2, ViewportDemands()), render(mapper, scene, 2))
    assert "photons' part of the film" in mapper.memory_bytes


def test_several_shadow_rays_find_every_light(mapper):
    """One ray a pixel misses the sun that shines wherever it asks for the hidden one; four, stratified, do not."""
    dark = []
    for rays in (1, 4):
        floor = render(mapper, lit_floor(), 1, ViewportDemands(shadow_rays=rays))[:, :7, 0]
        dark.append(np.mean(floor == 0.0))
    assert dark[0] > 0.2 and dark[1] == 0.0


def test_several_shadow_rays_bring_the_same_light(mapper):
    """Each pixel's ray asks for either sun: of n rays in all, the mean of p_i x_i varies by its own spread / n."""
    means = []
    for rays, count in ((1, 256), (4, 64)):
        means.append(render(mapper, lit_floor(), count, ViewportDemands(shadow_rays=rays))[:, :7, 0].mean())
    exact = 0.5 / np.pi * 3.0 * np.cos(0.6)
    # 84 pixels of 256 rays each: a spread of 1 over 147, and less as they are stratified.
    np.testing.assert_allclose(means, exact, rtol=3.0 / np.sqrt(84 * 256))


def test_noise_is_filtered_and_light_stays(mapper, pictures):
    scene = lit_floor()
    noisy = render(mapper, scene, 1)
    shown = pictures.show(scene, mapper.film, 1)
    floor = np.s_[:, :7, :3]
    assert shown[floor].std() < 0.35 * noisy[floor].std()
    assert shown[floor].mean() == pytest.approx(noisy[floor].mean(), rel=0.1)
    np.testing.assert_array_equal(shown[:, 9:], noisy[:, 9:])  # nothing runs over the floor's edge
    again = render(mapper, scene, 1)
    np.testing.assert_array_equal(again, noisy)
    np.testing.assert_array_equal(pictures.show(scene, mapper.film, 1), shown)


def test_light_that_is_taken_away_is_filtered_like_light(mapper, pictures):
    shown = []
    for sign in (1.0, -1.0):
        scene = lit_floor()
        scene.lights = [dataclasses.replace(light, strength=sign * light.strength) for light in scene.lights]
        render(mapper, scene, 16)
        shown.append(pictures.show(scene, mapper.film, 16)[..., :3])
    np.testing.assert_allclose(-shown[1], shown[0], rtol=1e-3, atol=1e-4)


def test_photons_are_left_as_they_are(mapper, pictures):
    """So are caustics: with direct light by photons, all light but that of what shines is theirs."""
    scene = room(direct_light="PHOTONS", use_final_gather=False)
    scene.instances = scene.instances[:-2]  # what shines is seen in the balls as well
    film = render(mapper, scene, 16)
    np.testing.assert_allclose(pictures.show(scene, mapper.film, 16), film, rtol=1e-4, atol=1e-5)


def test_the_filter_ends():
    assert strength(1, 1000) == 1.0 and strength(MAX_SAMPLES, 1000) == 0.0
    assert strength(1, 1) == strength(2, 2) == strength(8, 8) == 0.0 and strength(1, 2) == 1.0
    strengths = [strength(samples, 1000) for samples in range(1, 2 * MAX_SAMPLES)]
    assert strengths == sorted(strengths, reverse=True)


def test_at_the_end_the_film_is_shown(mapper, pictures):
    scene = room(iterations=2)
    render(mapper, scene, 2)
    assert pictures.show(scene, mapper.film, 2) is None


def test_a_single_pass_is_shown_as_it_is(mapper, pictures):
    scene = room(passes=("Normal",))
    assert demands_of(scene, 0.25) == ViewportDemands()
    render(mapper, scene, 1, demands_of(scene, 0.25))
    assert pictures.show(scene, mapper.film, 1) is None


def test_views_of_more_than_a_buffer_are_shown_as_they_are(mapper, pictures, monkeypatch):
    scene = lit_floor()
    film = render(mapper, scene, 1)
    limits = {**mapper.context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE": 4 * film.size - 1}
    monkeypatch.setattr(mapper.context, "limits", limits)
    assert pictures.show(scene, mapper.film, 1) is None
    pictures.given_out(scene, film)
    assert pictures.move(turned(scene, 2)) is None
    limits["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"] += 1
    assert pictures.show(scene, mapper.film, 1) is not None


def test_coarse_pictures_get_the_edges_of_surfaces(mapper, pictures):
    scene = dataclasses.replace(lit_floor(), exposure=2.0)
    scene.settings = dataclasses.replace(scene.settings, film_transparent=True)
    scene.camera = dataclasses.replace(scene.camera, width=64, height=48, window=(-0.52, 0.48, -0.375, 0.375))
    render(mapper, at_level(scene, 0.25), 1, demands_of(scene, 0.25))
    shown = pictures.show(scene, mapper.film, 1)
    edge = round(0.52 * 64)
    assert shown.shape == (48, 64, 4)
    np.testing.assert_allclose(shown[:, : edge - 1, :3], 1.0 / np.pi * 3.0 * np.cos(0.6), rtol=0.2)
    assert (shown[:, edge + 1 :] == 0.0).all() and (shown[:, : edge - 1, 3] == 1.0).all()


@pytest.mark.parametrize("orthographic", [False, True])
def test_a_picture_moves_with_the_view(mapper, pictures, orthographic):
    scene = lit_floor()
    if orthographic:
        window = (-5.5, -1.5, -1.5, 1.5)  # nothing but floor: what lies behind all else stays in its place
        scene.camera = dataclasses.replace(scene.camera, orthographic=True, window=window, clip_start=-10.0)
    rng = np.random.default_rng(1)
    picture = rng.random((12, 16, 4), np.float32)
    mapper.update(scene, demands=FILTERED)
    pictures.given_out(scene, picture)
    for columns, rows in ((3, 0), (-2, 1), (0, -4)):
        moved = pictures.move(turned(scene, columns, rows))
        part = (max(0, -rows), 12 - max(0, rows)), (max(0, -columns), 16 - max(0, columns))
        here = np.s_[slice(*part[0]), slice(*part[1])]
        there = np.s_[part[0][0] + rows : part[0][1] + rows, part[1][0] + columns : part[1][1] + columns]
        np.testing.assert_allclose(moved[here], picture[there], atol=2e-3)
        assert moved[..., 0].min() > 0.0  # what comes into view is filled with what there is of the same surface


def test_what_was_hidden_takes_the_color_of_its_surface(mapper, pictures):
    """A ball in red leaves the place in front of green walls: these show through, not the ball."""
    start = room(filter_width=0.0)
    start.instances[-1].object_index = 1
    eye = start.camera.matrix.copy()
    eye[:3, 3] += 0.25 * eye[:3, 0]
    aside = dataclasses.replace(start, camera=dataclasses.replace(start.camera, matrix=eye))
    masks = []
    for view in (start, aside):
        settings = view.settings.with_values(passes=("Object Index",))
        render(mapper, dataclasses.replace(view, settings=settings), 1)
        masks.append(mapper.film.read_passes()["Object Index"] == 1)
    before, after = masks
    colors = np.ones((SIZE, SIZE, 4), np.float32)
    colors[..., :3] = np.where(before[..., None], (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    mapper.update(start, demands=FILTERED)
    pictures.given_out(start, colors)
    moved = pictures.move(aside)
    red = moved[..., 0] > moved[..., 1]
    assert np.mean(red == after) > 0.995 and (after != before).mean() > 0.01


def test_new_samples_take_over(mapper, pictures):
    scene = lit_floor()
    before = np.full((12, 16, 4), 5.0, np.float32)
    mapper.update(scene, demands=FILTERED)
    pictures.given_out(scene, before)
    view = turned(scene, 1)
    off = []
    mapper.update(view, demands=FILTERED)
    for samples in range(1, HISTORY_ENDS + 1):
        mapper.iterate()
        shown = pictures.show(view, mapper.film, samples)
        off.append(np.abs(shown[:, 1:6, 0] - 0.5 / np.pi * 3.0 * np.cos(0.6)).mean())
    assert off[0] > 3.0 and off[-1] < 0.1
    assert all(later <= sooner + 0.05 for sooner, later in zip(off, off[1:], strict=False))


def test_only_a_view_leaves_the_picture_of_use(mapper, pictures):
    scene = lit_floor()
    other = dataclasses.replace(turned(scene, 1), lights=scene.lights[:1])
    assert differ_by_view(scene, turned(scene, 1)) and not differ_by_view(scene, other)
    mapper.update(scene, demands=FILTERED)
    assert pictures.move(turned(scene, 1)) is None  # nothing was shown yet
    pictures.given_out(scene, np.zeros((12, 16, 4), np.float32))
    assert pictures.move(other) is None
    assert pictures.move(turned(scene, 1)) is not None
    render(mapper, other, 1)
    pictures.show(other, mapper.film, 1)
    assert pictures.move(turned(scene, 1)) is None  # it may come back, but nothing of it is kept


def test_what_pictures_take_is_known_beforehand(mapper, pictures):
    scene = room()
    for view in (scene, turned(scene, 2)):
        render(mapper, view, 1)
        pictures.given_out(view, pictures.show(view, mapper.film, 1))
    pictures.move(turned(scene, 1))
    assert pictures.memory_bytes == expected_bytes(StageSizes(SIZE, SIZE))

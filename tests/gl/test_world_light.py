# SPDX-License-Identifier: GPL-3.0-or-later
"""Direct light of the world that comes through an opening, which photons and rays share."""

import math

import numpy as np
import pytest
import scenes
from path_classes import lobe, view
from path_comparison import SEEDS, SHARPNESS, block_errors, blocks, judge
from support.lobes import image_world, material
from support.render_states import assert_same_state
from test_paths_world import picture_by_seed
from test_shutter import open_for, way

from rppm_addon.integrator import learning
from rppm_addon.scene import DensityEstimation, Image, Instance, RenderSettings, Scene, World

FLOOR, BLACK, GRAY = np.array([0.9, 0.7, 0.5]), np.zeros(3), np.full(3, 0.6)
HEIGHT, HALF, HOLE = 1.0, 1.0, 0.25
"""Of the room, half of its width, and half of that of the square hole in its ceiling, meters."""


def room(walls: np.ndarray, hole: float = HOLE, **settings: object) -> Scene:
    """A floor under a ceiling with a hole, between walls of one color, in a white world, seen from within."""
    a, b, h = HALF, hole, HEIGHT
    corners = [(-a, -a), (a, -a), (a, a), (-a, a)]
    sides = list(zip(corners, [*corners[1:], corners[0]], strict=True))
    meshes = [scenes.rectangle("floor", *((x, y, 0) for x, y in corners))]
    meshes += [scenes.rectangle(f"wall {n}", (*p, 0), (*q, 0), (*q, h), (*p, h)) for n, (p, q) in enumerate(sides)]
    if hole < a:
        ceiling = [((-a, -a), (a, -b)), ((-a, b), (a, a))]
        ceiling += [((-a, -b), (-b, b)), ((b, -b), (a, b))] if b else []
        for n, ((x0, y0), (x1, y1)) in enumerate(ceiling):
            meshes.append(scenes.rectangle(f"ceiling {n}", (x0, y0, h), (x1, y0, h), (x1, y1, h), (x0, y1, h)))
    shared = RenderSettings(
        iterations=6, photons=1 << 16, photon_path_length=4, camera_path_length=4, filter_width=0.0,
        radius_minimum=0.05, radius_maximum=0.05,
    )  # fmt: skip
    return Scene(
        view((-0.4, 0.0, 0.7), (0.0, 0.0, 0.0), 0.2),
        meshes,
        [Instance(index, np.eye(4), [min(index, 1)]) for index in range(len(meshes))],
        [material("floor", lobe("D", FLOOR)), material("walls", lobe("D", walls))],
        world=World(np.ones(3)),
        settings=shared.with_values(**settings),
    )


def hole_form_factor(scene: Scene) -> np.ndarray:
    """(H, W) of the hole, from what each pixel sees of the floor (Howell, configuration B-4, by corners)."""
    camera, half = scene.camera, scene.camera.window[1]
    side = half * ((np.arange(camera.width) + 0.5) / camera.width * 2 - 1)
    x, y = np.meshgrid(side, side)
    matrix = np.asarray(camera.matrix)
    rays = np.stack([x, y, -np.ones_like(x)], -1) @ matrix[:3, :3].T
    place = matrix[:3, 3] - rays * (matrix[2, 3] / rays[..., 2])[..., None]

    def corner(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Of a rectangle from above the place to (u, v) off it."""
        s, t = u / np.hypot(HEIGHT, u), v / np.hypot(HEIGHT, v)
        return (s * np.arctan(v / np.hypot(HEIGHT, u)) + t * np.arctan(u / np.hypot(HEIGHT, v))) / (2 * math.pi)

    right, left = HOLE - place[..., 0], -HOLE - place[..., 0]
    top, bottom = HOLE - place[..., 1], -HOLE - place[..., 1]
    return corner(right, top) - corner(left, top) - corner(right, bottom) + corner(left, bottom)


@pytest.mark.parametrize(
    "route", [DensityEstimation.GRID, pytest.param(DensityEstimation.RASTERIZED, marks=pytest.mark.long)]
)
def test_the_floor_gets_the_sky_through_the_hole(mapper, route):
    scene = room(BLACK, density_estimation=route)
    pictures = picture_by_seed(mapper, f"hole {route.name}", scene)
    assert mapper.learning.direct_world_flux(mapper.device_scene.lights) > 0.0
    judge(f"hole {route.name}", pictures, FLOOR * hole_form_factor(scene)[..., None])


def uneven_sky(sun: bool) -> Image:
    """Clouds of one brightness or another, and a sun seen through the hole."""
    pixels = np.random.default_rng(3).uniform(0.0, 1.0, (8, 16, 4)).astype(np.float32) * 3.0
    if sun:
        pixels = np.repeat(np.repeat(pixels, 16, 0), 16, 1)
        pixels[116:120, 88:92] = 500.0
    return Image("world", pixels)


CASES = {"gray walls": (GRAY, None), "clouds": (BLACK, uneven_sky(False)), "sun": (BLACK, uneven_sky(True))}


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_rays_and_photons_find_what_rays_do(mapper, monkeypatch, name):
    """On the floor and on what gathering rays lead to; and a pixel has less noise."""
    walls, sky = CASES[name]
    scene, more_rays = room(walls), room(walls, photons=1 << 12, iterations=32)
    if sky is not None:
        for each in (scene, more_rays):
            each.images, each.world = [sky], image_world(0)
    pictures = picture_by_seed(mapper, name, scene)
    monkeypatch.setattr(learning, "_MOST_LEAVING", 0.0)
    by_rays = picture_by_seed(mapper, name, more_rays)
    by_both, right = blocks(pictures), blocks(by_rays)
    level = right.mean(axis=0)
    errors = np.hypot(block_errors(by_both, level), block_errors(right, level))
    differences = by_both.mean(axis=0) - level
    print(name, np.round(differences / level, 4), np.round(errors / level, 4))
    means = [each.mean(axis=(1, 2)) for each in (by_both, right)]
    mean_error = math.hypot(*(each.std(ddof=1) for each in means)) / math.sqrt(SEEDS)
    assert 4 * mean_error < SHARPNESS * level.mean()
    assert abs(differences.mean()) < 4 * mean_error
    assert (abs(differences) < 4 * errors).all()
    # Of as many iterations.
    assert pictures.var(axis=0, ddof=1).mean() < by_rays.var(axis=0, ddof=1).mean() * 32 / 6


@pytest.mark.parametrize(("hole", "shares"), [(HOLE, True), (HALF, False), (0.0, False)])
def test_photons_bring_the_sky_where_few_rays_leave(mapper, hole, shares):
    """Not under the open sky, where gathering rays find it, nor where it is not to be seen at all."""
    mapper.build(room(BLACK, hole))
    assert (mapper.learning.direct_world_flux(mapper.device_scene.lights) > 0.0) is shares


def test_flux_of_use_follows_the_guide(mapper):
    """Where a quarter of the cells has all photons of use, three quarters of the photons leave by these, and the
    others evenly: 13 / 16 are of use in place of a quarter."""
    mapper.build(room(BLACK))
    lights = mapper.device_scene.lights
    plain = 4 * math.pi**2 * lights.scene_radius**2 / (1 << 16)
    assert lights.world_photon_flux == pytest.approx(plain, rel=1e-6)
    tallies = lights.guide.read_tallies()
    tallies[:, 0] = 1 << 30
    tallies[: len(tallies) // 4, 1] = 1 << 30
    lights.restore(tallies, tallies, 1 << 16)
    assert lights.world_photon_flux == pytest.approx(plain / 3.25, rel=1e-3)


@pytest.mark.parametrize("moving", [False, True])
def test_it_goes_on_bit_for_bit(mapper, other_mapper, moving):
    """Also where something moves by which the scene grows, and with it the world's photons."""
    scene = room(GRAY, photons=1 << 12)
    if moving:
        scene.meshes.append(scenes.rectangle("bird", (3, 3, 3), (4, 3, 3), (4, 4, 3), (3, 4, 3)))
        scene.instances.append(Instance(len(scene.meshes) - 1, np.eye(4), [1]))
        scene = open_for(scene, instances=[way(len(scene.instances) - 1, np.eye(4), 4.0, 0.0, 0.0)])
    mapper.build(scene)
    states = []
    for _ in range(5):
        mapper.iterate()
        states.append(mapper.state())
    for state in states[:3]:
        other_mapper.build(scene)
        other_mapper.resume(state)
        while other_mapper.iteration < 5:
            other_mapper.iterate()
        assert_same_state(other_mapper.state(), states[-1])

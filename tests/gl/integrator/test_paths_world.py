# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics of the world, which photons and gathering rays share, are rendered once, however large the scene is."""

import dataclasses

import numpy as np
import pytest
import scenes
from path_comparison import SEEDS, SHARPNESS, block_errors, blocks, judge, picture_by_seed
from path_constants import PHOTONS, RAYS, TRACED
from path_scenes import lobe, view
from support.families import some_each_time
from support.lobes import Lobe, LobeKind, image_world, material

from rppm_addon.scene import Image, Scene, World

FLOOR, WALL = np.array([0.9, 0.7, 0.5]), np.array([0.6, 0.8, 0.7])
DISTANCE = 0.5
"""From the wall to what the camera sees, meters."""


def corner(extent: float, wall: Lobe, mode=RAYS, **settings: object) -> Scene:
    """A diffuse floor and, at x = 0, an upright wall, both of so many meters each way, in a white world."""
    a = extent
    floor = (
        scenes.rectangle("floor", (-a, -a, 0), (0, -a, 0), (0, a, 0), (-a, a, 0)),
        material("floor", lobe("D", FLOOR)),
    )
    upright = scenes.rectangle("wall", (0, -a, 0), (0, -a, a), (0, a, a), (0, a, 0)), material("wall", wall)
    shared = {"iterations": 8, "photons": 4096, "photon_path_length": 4, "camera_path_length": 4, "filter_width": 0.0}
    shared |= {"radius_minimum": 0.05, "radius_maximum": 0.05, "direct_light": mode}
    camera = view((-DISTANCE, -0.3, 0.7), (-DISTANCE, 0.0, 0.0), 0.12)
    return scenes.scene_of(camera, floor, upright, world=World(np.ones(3)), **shared | settings)


def share_of_wall(scene: Scene, extent: float) -> np.ndarray:
    """(H, W) form factor of the wall from what each pixel sees of the floor."""
    place = scenes.floor_places(scene.camera)
    near, far = -place[..., 0], np.hypot(place[..., 0], extent)
    return sum(
        (np.arctan(width / near) - near / far * np.arctan(width / far)) / (2 * np.pi)
        for width in (extent - place[..., 1], extent + place[..., 1])
    )


LEARNED = 24
"""Iterations, of which some follow those that photons are learned in."""
MIRROR, PANE = lobe("S", WALL), Lobe(LobeKind.TRANSPARENT, color=tuple(WALL))


def radius(meters: float) -> dict[str, float]:
    return {"radius_minimum": meters, "radius_maximum": meters}


CASES = {
    "1 m": (1.0, MIRROR, RAYS, {"iterations": LEARNED}),
    "1 m by photons": (1.0, MIRROR, PHOTONS, {"photons": 8192, "iterations": LEARNED} | radius(0.14)),
    "1 m, few wide photons": (1.0, MIRROR, RAYS, {"photons": 512} | radius(0.1)),
    "1 m, many narrow photons": (1.0, MIRROR, RAYS, {"photons": 8192} | radius(0.03)),
    "1 m, rays end": (1.0, MIRROR, RAYS, {"camera_path_length": 2}),
    "1 m, pane": (1.0, PANE, RAYS, {}),
    "30 m": (30.0, MIRROR, RAYS, {}),
    "3 km": (3000.0, MIRROR, RAYS, {"iterations": LEARNED}),
    "3 km, pane": (3000.0, PANE, RAYS, {}),
}
SELDOM = ("1 m by photons", "3 km")
"""A pane at 3 km, and the others at 1 m, are tried each time."""


@pytest.mark.parametrize("name", some_each_time(CASES, lambda name: name not in SELDOM))
def test_the_floor_gets_the_world_by_the_wall(mapper, name):
    """The floor has the white world for neighbor, and, where the wall is, the wall's color."""
    extent, wall, mode, settings = CASES[name]
    scene = corner(extent, wall, mode, **settings)
    share = share_of_wall(scene, extent)[..., None]
    judge(f"world {name}", picture_by_seed(mapper, name, scene), FLOOR * (1 - share + share * WALL))


WALLS = {"mirror": MIRROR, "traced": lobe(TRACED, WALL), "glass": Lobe(LobeKind.GLASS, color=tuple(WALL))}


@pytest.mark.parametrize("name", some_each_time(WALLS, lambda name: name == "glass"))
def test_rays_and_photons_find_what_photons_do(mapper, name):
    """An uneven world in which both find about as much."""
    iterations = 32 if name == "traced" else 6  # rough walls send fireflies
    scene = corner(1.0, WALLS[name], photons=16384, iterations=iterations, radius_minimum=0.025, radius_maximum=0.025)
    pixels = np.random.default_rng(3).uniform(0.0, 1.0, (8, 16, 4)).astype(np.float32) ** 2 * 3.0
    scene.images, scene.world = [Image("world", pixels)], image_world(0)
    alone = dataclasses.replace(scene, settings=scene.settings.with_values(use_final_gather=False))
    by_both, by_photons = (blocks(picture_by_seed(mapper, name, each)) for each in (scene, alone))
    level = by_photons.mean(axis=0)
    # Direct light is the same in both, noise included.
    differences = by_both - by_photons
    error, mean_error = block_errors(differences, level), differences.mean(axis=(1, 2)).std(ddof=1) / np.sqrt(SEEDS)
    mean = differences.mean()
    assert 4 * mean_error < SHARPNESS * level.mean()
    assert abs(mean) < 4 * mean_error
    assert (abs(differences.mean(axis=0)) < 4 * error).all()

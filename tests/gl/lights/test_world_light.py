# SPDX-License-Identifier: GPL-3.0-or-later
"""Direct light of the world that comes through an opening, which photons and rays share."""

import math

import numpy as np
import pytest
import scenes
from moving_scenes import open_for, way
from openings import BLACK, FLOOR, GRAY, HALF, HOLE, hole_form_factor, room, uneven_sky
from path_comparison import SEEDS, SHARPNESS, block_errors, blocks, judge, picture_by_seed
from support.lobes import image_world
from support.render_states import assert_goes_on

from rppm_addon.integrator import learning
from rppm_addon.scene import DensityEstimation, Instance


@pytest.mark.parametrize(
    "route", [DensityEstimation.GRID, pytest.param(DensityEstimation.RASTERIZED, marks=pytest.mark.long)]
)
def test_the_floor_gets_the_sky_through_the_hole(mapper, route):
    scene = room(BLACK, density_estimation=route)
    pictures = picture_by_seed(mapper, f"hole {route.name}", scene)
    assert mapper.learning.direct_world_flux(mapper.device_scene.lights) > 0.0
    judge(f"hole {route.name}", pictures, FLOOR * hole_form_factor(scene)[..., None])


CASES = {
    "gray walls": (GRAY, None, 6, 32),
    "clouds": (BLACK, uneven_sky(False), 6, 32),
    "sun": (BLACK, uneven_sky(True), 24, 128),
}
"""Albedo of the walls, sky, and iterations with photons and with rays alone."""


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_rays_and_photons_find_what_rays_do(mapper, monkeypatch, name):
    """On the floor and on what gathering rays lead to; and a pixel has less noise."""
    walls, sky, iterations, more = CASES[name]
    scene, more_rays = room(walls, iterations=iterations), room(walls, photons=1 << 12, iterations=more)
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
    means = [each.mean(axis=(1, 2)) for each in (by_both, right)]
    mean_error = math.hypot(*(each.std(ddof=1) for each in means)) / math.sqrt(SEEDS)
    assert 4 * mean_error < SHARPNESS * level.mean()
    assert abs(differences.mean()) < 4 * mean_error
    assert (abs(differences) < 4 * errors).all()
    # Of as many iterations.
    assert pictures.var(axis=0, ddof=1).mean() < by_rays.var(axis=0, ddof=1).mean() * more / iterations


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
    assert_goes_on(mapper, scene, iterations=5, stops=(1, 2, 3), other=other_mapper)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Neighboring pixels reuse the rays of the final gather without a change of the mean."""

import dataclasses

import numpy as np
import pytest
import scenes
from packed_normals import unpack
from rendering import iterated, radiance_of
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.camera_paths import final_gather
from rppm_addon.integrator.camera_paths.coverage import Coverage
from rppm_addon.integrator.camera_paths.final_gather import FINAL_GATHER_HIT, FINAL_GATHER_ORIGIN, NO_FINAL_GATHER
from rppm_addon.integrator.density_estimation import radii
from rppm_addon.integrator.photons.photons import Photons
from rppm_addon.scene import Light, LightKind, Scene

SIZE, SEEDS = 48, 8
PROBE = Coverage.probe


def pictures_of(mapper, scene_of_seed, iterations: int) -> np.ndarray:
    """(SEEDS, H, W) mean radiance of all channels."""
    found = [radiance_of(mapper, scene_of_seed(seed), iterations) for seed in range(SEEDS)]
    return np.array([picture[..., :3].mean(axis=-1, dtype=np.float64) for picture in found])


def diffuse_room(seed: int = 0, **settings: object) -> Scene:
    scene = scenes.room(SIZE, seed=seed, **settings)
    scene.instances = scene.instances[:5]
    return scene


def indirect_pictures(mapper, monkeypatch, radius: float) -> np.ndarray:
    """(SEEDS, SIZE, SIZE) radiance of a diffuse room, shared within so many Eq. 3 radii."""
    monkeypatch.setattr(final_gather, "REUSE_RADIUS", radius)
    settings = {"photons": 2048, "radius_scale": 60.0, "filter_width": 0.0}
    return pictures_of(mapper, lambda seed: diffuse_room(seed, **settings), 4)


def test_reuse_keeps_the_mean_and_takes_noise_away(mapper, monkeypatch):
    """Blocks keep their means within 4 standard errors and 0.5 %: shared light is that of a disk around."""
    alone = indirect_pictures(mapper, monkeypatch, 0.0)
    shared = indirect_pictures(mapper, monkeypatch, 2.0)
    assert shared.var(axis=0, ddof=1).mean() < 0.5 * alone.var(axis=0, ddof=1).mean()
    by_block = (shared - alone).reshape(SEEDS, 4, SIZE // 4, 4, SIZE // 4).mean(axis=(2, 4))
    level = alone.mean()
    error = by_block.std(axis=0, ddof=1) / np.sqrt(SEEDS)
    assert error.mean() < 0.01 * level
    # The t distribution of few seeds.
    assert (abs(by_block.mean(axis=0)) < 8.5 * error + 0.005 * level).all()
    assert abs(by_block.mean()) < 4 * by_block.mean(axis=(1, 2)).std(ddof=1) / np.sqrt(SEEDS) + 0.005 * level


def test_pictures_that_are_denoised_reuse_no_rays(mapper, monkeypatch):
    settings = {"photons": 2048, "radius_scale": 60.0, "filter_width": 0.0}
    shared = radiance_of(mapper, diffuse_room(**settings), 2)
    to_denoise = radiance_of(mapper, diffuse_room(**settings, use_denoising=True), 2)
    monkeypatch.setattr(final_gather, "REUSE_RADIUS", 0.0)
    alone = radiance_of(mapper, diffuse_room(**settings), 2)
    np.testing.assert_array_equal(to_denoise, alone)
    assert (shared != alone).any()


def test_rays_of_diffuse_surfaces_are_reused_and_those_of_rough_ones_are_not(mapper):
    scene = scenes.room(SIZE, photons=64)
    scene.materials.append(material("rough", Lobe(LobeKind.GLOSSY, color=(0.8, 0.8, 0.8), roughness=0.8)))
    scene.instances[0].materials = [len(scene.materials) - 1]
    iterated(mapper, scene)
    origins = mapper.stages.final_gather.origins.read(FINAL_GATHER_ORIGIN.dtype, SIZE * SIZE)
    assert (origins["reuse_radius"] == 0).sum() > 50
    assert (origins["reuse_radius"] > 0).sum() > 500
    assert (origins["weight"][origins["reuse_radius"] >= 0] >= 0).all()


def test_rays_of_the_final_gather_lead_from_an_origin_to_the_front_of_a_hit(mapper):
    iterated(mapper, scenes.room(SIZE, photons=64))
    gather = mapper.stages.final_gather
    origins = gather.origins.read(FINAL_GATHER_ORIGIN.dtype, SIZE * SIZE)
    hits = gather.hits.read(FINAL_GATHER_HIT.dtype, SIZE * SIZE)
    gathers = origins["reuse_radius"] != NO_FINAL_GATHER
    assert gathers.sum() > 500
    rays = hits["position"][gathers].astype(np.float64) - origins["position"][gathers]
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    for normals, side in ((origins["normal"], 1.0), (hits["normal"], -1.0)):
        assert (side * np.sum(unpack(normals[gathers]) * rays, axis=-1) > -1e-3).mean() > 0.99


def corner(seed: int) -> Scene:
    """A white floor and a white wall that a sun lights alike, where they meet."""
    wall, white = scenes.rectangle("wall", (-0.5, 0.5, 0), (0.5, 0.5, 0), (0.5, 0.5, 1), (-0.5, 0.5, 1)), scenes.diffuse
    sun = Light("sun", LightKind.SUN, scenes.looking((0, 0, 0), (0, 1, -1)), np.ones(3))
    parts = [(mesh, white(0.9, 0.9, 0.9)) for mesh in (scenes.square("floor", 0.5), wall)]
    camera = scenes.camera((0, -0.5, 1), (0, 0.5, 0), 0.2, 32, True)
    settings = {"photons": 1024, "seed": seed, "radius_scale": 100.0, "filter_width": 0.0}
    return scenes.scene_of(camera, *parts, lights=[sun], **settings)


@pytest.mark.long
def test_corners_are_not_dark(mapper, monkeypatch):
    """Photons around the end of a gathering ray are too few where their disk reaches beyond a wall, unless they are
    multiplied by what of it does not, or the path gathers again; one that gathers from every surface that it comes to
    needs no photons."""
    radiance = {}
    again = radii.CORNER_RADII
    ways = {"dark": (0.0, False), "probed": (0.0, True), "again": (again, True), "always": (1e9, False)}
    for name, (corner_radii, probes) in ways.items():
        monkeypatch.setattr(radii, "CORNER_RADII", corner_radii)
        monkeypatch.setattr(Coverage, "probe", PROBE if probes else lambda *_: None)
        radiance[name] = pictures_of(mapper, corner, 16).mean(axis=(1, 2))
    lacks = {name: (radiance["always"] - values) / radiance["always"].mean() for name, values in radiance.items()}
    error = max(values.std(ddof=1) for values in lacks.values()) * np.sqrt(2 / SEEDS)
    assert lacks["dark"].mean() > 0.008
    assert abs(lacks["probed"].mean()) < 0.5 * lacks["dark"].mean()
    assert abs(lacks["again"].mean()) < 0.5 * lacks["dark"].mean()
    assert error < 0.25 * lacks["dark"].mean()


HEIGHT, WIDTH, ALBEDO = 0.1, 40.0, 0.5
ROWS = 32


def beside_a_wall(seed: int) -> Scene:
    """A floor seen from above, out to two heights of a low and long wall, which alone a level sun lights."""
    floor = scenes.rectangle("floor", (-WIDTH, -WIDTH, 0), (WIDTH, -WIDTH, 0), (WIDTH, 0, 0), (-WIDTH, 0, 0))
    wall = scenes.rectangle("wall", (-WIDTH, 0, 0), (WIDTH, 0, 0), (WIDTH, 0, HEIGHT), (-WIDTH, 0, HEIGHT))
    camera = scenes.camera((0, -HEIGHT, 1), (0, -HEIGHT, 0), HEIGHT, ROWS, True)
    sun = Light("sun", LightKind.SUN, scenes.looking((0, 0, 0), (0, 1, 0)), np.full(3, np.pi))
    settings = {"photons": 64, "photon_path_length": 1, "seed": seed, "radius_scale": 600.0, "filter_width": 0.0}
    parts = [(mesh, scenes.diffuse(ALBEDO, ALBEDO, ALBEDO)) for mesh in (floor, wall)]
    return scenes.scene_of(camera, *parts, lights=[sun], **settings)


def test_what_a_wall_sends_its_floor_is_not_blurred(mapper, monkeypatch):
    """Beside a wall of radiance ALBEDO and height h a floor sees it with the form factor (1 - y / hypot(y, h)) / 2.
    Pixels share within 0.1 m, over which that falls from a half to a seventh: means of what neighbors see of it would
    be off by a tenth."""
    monkeypatch.setattr(radii, "CORNER_RADII", 0.0)  # one bounce, no more
    shared = pictures_of(mapper, beside_a_wall, 16)
    assert mapper.learning.radius_schedule.radii(1).in_pixels * final_gather.REUSE_RADIUS > ROWS / 2
    rows = shared.mean(axis=2)  # along the wall all is alike
    y = HEIGHT * (2.0 - (np.arange(ROWS) + 0.5) * 2.0 / ROWS)  # row 0 lies farthest off
    y = y if rows[:, -1].mean() > rows[:, 0].mean() else y[::-1]
    expected = ALBEDO**2 * 0.5 * (1.0 - y / np.hypot(y, HEIGHT))
    error = rows.std(axis=0, ddof=1) / np.sqrt(SEEDS)
    assert error.mean() < 0.03 * expected.mean()
    # The t distribution of few seeds; pixels are a sixteenth of the height.
    assert (abs(rows.mean(axis=0) - expected) < 8.5 * error + 0.01 * expected).all()
    assert abs(rows.mean() - expected.mean()) < 5.5 * rows.mean(axis=1).std(ddof=1) / np.sqrt(SEEDS)


def picture(mapper) -> np.ndarray:
    return radiance_of(mapper, diffuse_room(photons=1024), 2)


def test_storage_blocks_give_the_same_picture(mapper, other_mapper, library, monkeypatch):
    """Software drivers read the same data through image units instead of storage blocks."""
    as_it_is = picture(mapper)
    monkeypatch.setattr(library, "_reads_texels", False)
    monkeypatch.delitem(library._programs, ("camera_paths/final_gather/reuse.comp", (), ()))
    np.testing.assert_array_equal(picture(other_mapper), as_it_is)


def test_first_surfaces_that_take_nothing_are_passed_over(mapper, monkeypatch):
    """Where all photons are indirect, asking them changes no picture."""
    passed_over = picture(mapper)
    listed = mapper.stages.density_estimator.photon_list
    assert listed.indirect_count == listed.count > 0
    stored = Photons.stored
    monkeypatch.setattr(Photons, "stored", lambda *arguments: dataclasses.replace(stored(*arguments), indirect_count=0))
    np.testing.assert_array_equal(picture(mapper), passed_over)

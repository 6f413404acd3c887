# SPDX-License-Identifier: GPL-3.0-or-later
"""What gathering rays find is shared among pixels without a change of its mean."""

import numpy as np
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.records import GATHERING_VERTEX
from rppm_addon.integrator.density_estimation import radii
from rppm_addon.integrator.stages import final_gather
from rppm_addon.scene import Camera, Instance, Light, LightKind, RenderSettings, Scene

SIZE, SEEDS = 48, 8


def indirect_pictures(mapper, monkeypatch, radius: float) -> np.ndarray:
    """(SEEDS, SIZE, SIZE) radiance of a diffuse room, shared within so many Eq. 3 radii."""
    monkeypatch.setattr(final_gather, "SHARED_RADIUS", radius)
    pictures = []
    for seed in range(SEEDS):
        scene = scenes.room(SIZE, iterations=4, photons=2048, seed=seed, radius_scale=60.0, filter_width=0.0)
        scene.instances = scene.instances[:5]
        mapper.build(scene)
        for _ in range(scene.settings.iterations):
            mapper.iterate()
        pictures.append(mapper.film.read_radiance()[..., :3].mean(axis=-1, dtype=np.float64))
    return np.array(pictures)


def test_sharing_keeps_the_mean_and_takes_noise_away(mapper, monkeypatch):
    """Blocks keep their means within 4 standard errors and 0.5 %: shared light is that of a disk around."""
    alone = indirect_pictures(mapper, monkeypatch, 0.0)
    shared = indirect_pictures(mapper, monkeypatch, 2.0)
    assert shared.var(axis=0, ddof=1).mean() < 0.5 * alone.var(axis=0, ddof=1).mean()
    by_block = (shared - alone).reshape(SEEDS, 4, SIZE // 4, 4, SIZE // 4).mean(axis=(2, 4))
    level = alone.mean()
    error = by_block.std(axis=0, ddof=1) / np.sqrt(SEEDS)
    print(np.round(by_block.mean(axis=0) / level, 4), np.round(error / level, 4))
    assert error.mean() < 0.01 * level
    # The t distribution of few seeds.
    assert (abs(by_block.mean(axis=0)) < 8.5 * error + 0.005 * level).all()
    assert abs(by_block.mean()) < 4 * by_block.mean(axis=(1, 2)).std(ddof=1) / np.sqrt(SEEDS) + 0.005 * level


def test_diffuse_surfaces_share_and_rough_ones_do_not(mapper):
    scene = scenes.room(SIZE, photons=64)
    scene.materials.append(material("rough", Lobe(LobeKind.GLOSSY, color=(0.8, 0.8, 0.8), roughness=0.8)))
    scene.instances[0].materials = [len(scene.materials) - 1]
    mapper.build(scene)
    mapper.iterate()
    vertices = mapper.stages.final_gather.vertices.read(GATHERING_VERTEX.dtype, SIZE * SIZE)
    assert (vertices["shared_radius"] == 0).sum() > 50
    assert (vertices["shared_radius"] > 0).sum() > 500
    assert (vertices["weight"][vertices["shared_radius"] >= 0] >= 0).all()


def corner(seed: int) -> Scene:
    """A white floor and a white wall that a sun lights alike, where they meet."""
    floor = scenes.rectangle("floor", (-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0))
    wall = scenes.rectangle("wall", (-0.5, 0.5, 0), (0.5, 0.5, 0), (0.5, 0.5, 1), (-0.5, 0.5, 1))
    sun = Light("sun", LightKind.SUN, scenes.looking((0, 0, 0), (0, 1, -1)), np.ones(3))
    half = 0.2
    return Scene(
        Camera(scenes.looking((0, -0.5, 1), (0, 0.5, 0)), (-half, half, -half, half), 32, 32, True),
        meshes=[floor, wall],
        instances=[Instance(0, np.eye(4), [0]), Instance(1, np.eye(4), [0])],
        materials=[material("white", Lobe(LobeKind.DIFFUSE, color=(0.9, 0.9, 0.9)))],
        lights=[sun],
        settings=RenderSettings(photons=1024, seed=seed, radius_scale=100.0, filter_width=0.0),
    )


def test_corners_are_not_dark(mapper, monkeypatch):
    """Photons around the end of a gathering ray are too few where their disk reaches beyond a wall; paths that
    gather from every surface that they come to need none of them."""
    radiance = {}
    for corner_radii in (0.0, radii.CORNER_RADII, 1e9):
        monkeypatch.setattr(radii, "CORNER_RADII", corner_radii)
        pictures = []
        for seed in range(SEEDS):
            mapper.build(corner(seed))
            for _ in range(16):
                mapper.iterate()
            pictures.append(mapper.film.read_radiance()[..., :3].mean(dtype=np.float64))
        radiance[corner_radii] = np.array(pictures)
    never, near, always = radiance.values()
    darker, almost = always - never, always - near
    error = np.hypot(darker.std(ddof=1), almost.std(ddof=1)) / np.sqrt(SEEDS) / always.mean()
    print(darker.mean() / always.mean(), almost.mean() / always.mean(), error)
    assert darker.mean() > 0.008 * always.mean()
    assert abs(almost.mean()) < 0.5 * darker.mean()
    assert error < 0.25 * darker.mean() / always.mean()

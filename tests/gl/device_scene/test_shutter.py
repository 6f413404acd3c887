# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that are taken while things move."""

import dataclasses

import numpy as np
import pytest
import scenes
from moving_scenes import BALL, everything_moves, open_for, way
from support.lobes import Lobe, LobeKind, material
from support.render_states import assert_goes_on

from rppm_addon.integrator.device_scene.moments import moment
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Aperture, Camera, Instance, Light, LightKind, MovingScene, RenderSettings, Scene
from rppm_addon.session.render.renderer import Renderer


def room(**settings: object) -> Scene:
    return scenes.room(24, photons=2048, camera_path_length=3, photon_path_length=4, **settings)


def pictures(mapper: ProgressivePhotonMapper, scene: Scene, iterations: int) -> list[np.ndarray]:
    mapper.update(scene)
    for _ in range(iterations):
        mapper.iterate()
    return [mapper.film.read_radiance(), *mapper.film.read_passes().values()]


def test_what_stays_where_it_is_gives_the_picture_without_a_shutter(mapper, other_mapper):
    """All is built anew in each iteration, but what was learned and the radii go on."""
    still = room()
    for a, b in zip(pictures(mapper, everything_moves(still, 0.0), 5), pictures(other_mapper, still, 5), strict=True):
        np.testing.assert_array_equal(a, b)


def test_a_blurred_picture_after_others_is_the_same(mapper, other_mapper):
    scene = everything_moves(room(), 1.0)
    fresh = pictures(other_mapper, scene, 4)
    pictures(mapper, room(), 2)
    pictures(mapper, everything_moves(room(), 0.5), 2)
    for a, b in zip(pictures(mapper, scene, 4), fresh, strict=True):
        np.testing.assert_array_equal(a, b)
    still = pictures(other_mapper, dataclasses.replace(scene, shutter=None), 4)
    assert not np.array_equal(fresh[0], still[0])
    for a, b in zip(pictures(mapper, dataclasses.replace(scene, shutter=None), 4), still, strict=True):
        np.testing.assert_array_equal(a, b)


def test_a_state_goes_on_in_the_middle(mapper, other_mapper):
    """Also where the light grows, so that lights share photons by powers that change."""
    scene = everything_moves(room(), 1.0)
    light = scene.lights[0]
    scene.lights = [light, dataclasses.replace(light, name="other", matrix=scenes.placed(0.5, 0.5, 0.9))]
    scene.shutter.lights[0].matrices[1] @= np.diag([3.0, 3.0, 1.0, 1.0])
    assert_goes_on(mapper, scene, "radiance", "tallies", iterations=7, stops=(2, 5), other=other_mapper)


def test_radii_are_those_of_the_whole_time(mapper):
    scene = open_for(room(), instances=[way(BALL, room().instances[BALL].matrix, 4.0, 0.0, 3.0)])
    mapper.update(scene)
    schedule, geometry = mapper.learning.radius_schedule, mapper.device_scene.geometry
    limits, bounds = schedule.limits, (geometry.bounds_low, geometry.bounds_high)
    for _ in range(3):
        mapper.iterate()
        assert schedule.limits == limits
        np.testing.assert_allclose((geometry.bounds_low, geometry.bounds_high), bounds, rtol=1e-6)


@pytest.mark.parametrize(("member", "parts"), [
    (None, []), ("camera", []), ("lights", ["lights"]), ("instances", ["geometry", "lights", "acceleration"]),
])  # fmt: skip
def test_only_what_moves_is_built(mapper, monkeypatch, member, parts):
    moving = everything_moves(room(), 1.0)
    kept = {member: getattr(moving.shutter, member)} if member else {}
    mapper.update(open_for(moving, **kept))
    done: list[str] = []
    for part in ("geometry", "materials", "lights", "acceleration"):
        built = getattr(mapper.device_scene, part)
        whole = built.build
        monkeypatch.setattr(built, "build", lambda *a, whole=whole, part=part, **k: (done.append(part), whole(*a, **k)))
    mapper.iterate()
    assert done == parts


def test_an_iteration_shows_the_scene_of_its_moment(mapper, other_mapper):
    """Depth along the middle of the view, where a wall comes nearer."""
    still = room(seed=5)
    still.instances = still.instances[:5]
    wall = still.instances[2].matrix
    scene = open_for(still, instances=[way(2, wall, 0.0, -1.0, 0.0)])
    mapper.update(scene)
    for iteration in range(1, 4):
        mapper.iterate()
        at = MovingScene(scene).at(scene.shutter.time_of(moment(iteration, 5)))
        np.testing.assert_array_equal(mapper.scene.instances[2].matrix, at.instances[2].matrix)
    times = [moment(iteration, 5) for iteration in range(1, 4)]
    depth = mapper.film.read_passes()["Depth"][10:14, 10:14]
    expected = 3.6 + 1.0 - (np.array(times) - 0.5)
    assert expected.min() - 1e-4 <= depth.min() and depth.max() <= expected.max() + 1e-4


@pytest.mark.long
def test_a_caustic_is_the_mean_of_those_at_moments(renderer):
    """A glass ball over a floor, against brute force: one static picture for each part of the time."""
    still = Scene(
        Camera(scenes.looking((0, -3.5, 3.5), (0, 0, 0.2)), (-0.4, 0.4, -0.4, 0.4), 32, 32),
        [scenes.rectangle("floor", (-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)), scenes.sphere("ball")],
        [Instance(0, np.eye(4), [0]), Instance(1, scenes.placed(0, 0, 1.0, 0.4), [1])],
        [scenes.diffuse(0.6, 0.6, 0.6), material("glass", Lobe(LobeKind.GLASS, ior=1.5))],
        [Light("light", LightKind.SPOT, scenes.placed(0, 0, 4), np.full(3, 20.0), radius=0.4, spot_angle=1.0)],
        settings=RenderSettings(photons=4096, photon_path_length=5, camera_path_length=3, use_final_gather=False),
    )
    scene = open_for(still, instances=[way(1, still.instances[1].matrix, 1.0, 0.3, 0.2)])
    moving, parts = MovingScene(scene), 16
    caustic = (slice(12, 20), slice(8, 20))
    blurred = np.array([seeded(renderer, scene, seed, iterations=48)[caustic] for seed in range(3)])
    at_moments = np.mean(
        [
            [seeded(renderer, moving.at((k + 0.5) / parts), 9 + k + j, iterations=6)[caustic] for k in range(parts)]
            for j in (0, parts)
        ],
        axis=1,
    )
    unmoved = seeded(renderer, still, 0, iterations=48)[caustic]
    error = np.hypot(*(np.std(p.mean(axis=(1, 2, 3)), ddof=1) / len(p) ** 0.5 for p in (blurred, at_moments)))
    energy, expected = blurred.mean(), at_moments.mean()
    assert error < 0.02 * expected and abs(energy - expected) < 0.02 * expected + 3.0 * error
    # As bright in all, but spread.
    assert blurred.mean(axis=0).max() < 0.7 * unmoved.max()


def seeded(renderer: Renderer, scene: Scene, seed: int, **settings: object) -> np.ndarray:
    scene.settings = scene.settings.with_values(seed=seed, **settings)
    return renderer.render(scene).frame.combined[..., :3].astype(np.float64)


def test_a_lens_leaves_no_ghosts(renderer):
    """A bright spot out of focus fills its disk after four iterations, rather than showing four of itself."""
    glow = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)))
    spot = scenes.rectangle("spot", (-0.02, 0, -0.02), (0.02, 0, -0.02), (0.02, 0, 0.02), (-0.02, 0, 0.02))
    camera = Camera(scenes.looking((0, -4, 0), (0, 0, 0)), (-0.2, 0.2, -0.2, 0.2), 64, 64, aperture=Aperture(0.2, 2.0))
    scene = Scene(
        camera, [spot], [Instance(0, np.eye(4), [0])], [glow],
        settings=RenderSettings(iterations=4, photons=64, camera_path_length=1, filter_width=0.0),
    )  # fmt: skip
    combined = seeded(renderer, scene, 0)[..., 0]
    # Four copies of the spot, 1.6 pixels wide, would be four clusters of some nine pixels.
    lit = combined > 0.0
    rows, columns = np.nonzero(lit)
    radius = 0.2 * (4.0 - 2.0) / 2.0 / 4.0 / (0.4 / 64)  # of the disk of confusion, pixels
    assert (np.hypot(rows - 31.5, columns - 31.5) < radius + 2).all()
    quadrants = [lit[:32, :32], lit[:32, 32:], lit[32:, :32], lit[32:, 32:]]
    assert min(quadrant.sum() for quadrant in quadrants) > 0
    neighbors = sum(np.roll(lit, shift, axis) for axis in (0, 1) for shift in (-1, 1))
    assert neighbors[lit].mean() < 1.0, "lit pixels lie apart, not in clusters"

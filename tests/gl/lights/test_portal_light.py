# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's light through portals: pdfs, and pictures that they leave as they are."""

import dataclasses
import math

import numpy as np
import pytest
import scenes
from openings import BLACK, FLOOR, HEIGHT, HOLE, hole_form_factor, room, uneven_sky, with_pane
from path_comparison import judge, picture_by_seed
from rendering import iterated
from support.lobes import Lobe, LobeKind, image_world, material
from support.render_states import assert_goes_on
from test_guided_photons import emitted_moments
from test_light_sampling import FOLDER, Iteration

from rppm_addon.integrator.lights import guide, portals
from rppm_addon.integrator.lights.light_records import LightFlag
from rppm_addon.integrator.lights.portals import light_through
from rppm_addon.scene import Light, LightKind, Scene

SAMPLES = 1 << 14


def portal(half: float = HOLE, shape: str = "SQUARE", x: float = 0.0, z: float = HEIGHT, turn: float = 0.0) -> Light:
    """A square or disk in the room's ceiling that faces down, or turned about Y."""
    matrix = scenes.placed(x, 0.0, z)
    cosine, sine = math.cos(turn), math.sin(turn)
    matrix[:3, :3] = matrix[:3, :3] @ [[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]]
    return Light("portal", LightKind.AREA, matrix, np.zeros(3), shape=shape, size=(2 * half, 2 * half), is_portal=True)


PORTALS = {
    "in the hole": [portal()],
    "a part of it": [portal(0.12, "DISK")],
    "wherever": [
        portal(0.3, x=0.2, z=1.05),
        portal(0.4, "DISK", x=-0.5, z=0.6, turn=0.7),
        portal(0.2, z=0.2, turn=3.0),
    ],
}


def with_portals(name: str, sky: bool = False, **settings: object) -> Scene:
    scene = room(BLACK, **settings)
    scene.lights = PORTALS[name]
    if sky:
        scene.images, scene.world = [uneven_sky()], image_world(0)
    return scene


def portal_samples(mapper, library, point) -> tuple[np.ndarray, np.ndarray]:
    """Samples of the world from a point, (n, 8): direction, distance, weight, pdf; and of even directions (n, 4):
    direction, pdf."""
    results = mapper.context.moderngl.buffer(reserve=48 * SAMPLES)
    context = mapper.device_scene.context
    context.begin(Iteration(1, seed=3))
    values = {"count": SAMPLES, "point": point, "emitted": 0.0}
    blocks = {**context.blocks, "Results": results}
    library.compute(str(FOLDER / "portal_samples.comp"), {"PORTALS": 1}).run(SAMPLES, blocks, values)
    table = np.frombuffer(results.read(), np.float32).reshape(SAMPLES, 12).astype(np.float64)
    results.release()
    assert np.isfinite(table).all()
    return table[:, :8], table[:, 8:]


@pytest.mark.parametrize("sky", [False, True])
def test_the_pdf_of_shadow_rays_is_that_of_their_samples(mapper, library, sky):
    """It integrates to one where all samples count, over any half of the directions to the samples that go there."""
    mapper.build(with_portals("wherever", sky, photons=64))
    for point in ((0.1, 0.05, 0.1), (-0.6, 0.3, 0.5), (0.3, -0.2, 3.0)):
        samples, even = portal_samples(mapper, library, point)
        direction, pdf = samples[:, :3], samples[:, 7]
        taken = pdf > 0.0  # of the corners around an ellipse nothing is
        whole = 4 * math.pi * even[:, 3]
        for axis, threshold in (((1, 0, 0), 0.1), ((0, 0.6, 0.8), 0.2), ((-0.6, 0, 0.8), 0.9)):
            expected = whole * (even[:, :3] @ axis > threshold)
            found = (taken & (direction @ axis > threshold)).astype(float)
            error = math.sqrt((expected.var() + found.var()) / SAMPLES)
            difference = found.mean() - expected.mean()
            assert abs(difference) < 4 * error + 1e-4
        inverse = np.where(taken, 1.0 / np.maximum(pdf, 1e-30), 0.0)  # all directions have one
        assert inverse.mean() == pytest.approx(4 * math.pi, abs=5 * inverse.std() / math.sqrt(SAMPLES))


@pytest.mark.parametrize(
    ("name", "sky"),
    [("in the hole", False), ("wherever", True), pytest.param("wherever", False, marks=pytest.mark.long)],
)
def test_photons_through_portals_emit_the_same_light(mapper, name, sky):
    """The light field's moments within the scene are those without portals; also when both guides choose at random."""
    plain_scene = with_portals(name, sky)
    plain_scene.lights = []
    mapper.build(plain_scene)
    plain = emitted_moments(mapper, 8)
    mapper.build(with_portals(name, sky))
    lights = mapper.device_scene.lights
    assert lights.table["flags"][-1] & LightFlag.THROUGH_PORTALS and lights.table["photon_count"].min() > 1000
    generator = np.random.default_rng(3)
    for guided in (False, True):
        if guided:
            chosen = [
                guide.probabilities(10.0 ** generator.uniform(-4, 0, int(np.prod(cells))))
                for cells in lights.guide._cells
            ]
            lights.guide._choose_by(chosen)
        through = emitted_moments(mapper, 8)
        error = np.sqrt((plain.var(axis=0, ddof=1) + through.var(axis=0, ddof=1)) / 8)
        worst = (abs(through.mean(axis=0) - plain.mean(axis=0)) / (5 * error + 1e-4 * plain[:, 0].mean())).max()
        assert worst < 1.0 and (error[0] < 0.02 * plain[:, 0].mean()).all()


def test_the_floor_gets_the_sky_through_a_portal(mapper):
    """By shadow rays, to the closed form."""
    scene = with_portals("in the hole")
    pictures = picture_by_seed(mapper, "portal", scene, 8)
    expected = FLOOR * hole_form_factor(scene)[..., None]
    assert pictures.mean() == pytest.approx(expected.mean(), rel=5e-3)
    # Without portals the same pictures have five times as much noise.
    assert pictures.var(axis=0, ddof=1).mean() < 0.015 * expected.mean() ** 2


@pytest.mark.long
@pytest.mark.parametrize("name", ["a part of it", "wherever"])
def test_portals_in_wrong_places_change_no_mean(mapper, name):
    scene = with_portals(name, iterations=32, photons=1 << 10)
    pictures = picture_by_seed(mapper, f"portals {name}", scene)
    judge(f"portals {name}", pictures, FLOOR * hole_form_factor(scene)[..., None])


@pytest.mark.parametrize(
    "behind", ["gathering rays", "glossy rays", pytest.param("half a hole", marks=pytest.mark.long)]
)
def test_panes_without_shadow_behind_portals_change_nothing(mapper, behind):
    """Light that goes straight through a pane is weighted by how shadow rays find it from where it was scattered."""
    scene, low, seeds = with_portals("in the hole", iterations=2), -0.4, 2
    if behind == "glossy rays":
        scene.materials[0] = material("floor", Lobe(LobeKind.GLOSSY, roughness=0.2, color=FLOOR))
        scene.settings = scene.settings.with_values(use_final_gather=False, specular_roughness=0.3)
    elif behind == "half a hole":  # gathering rays find the light of the other half
        half = dataclasses.replace(portal(x=0.5 * HOLE, shape="RECTANGLE"), size=(HOLE, 2 * HOLE))
        scene, low, seeds = dataclasses.replace(with_portals("in the hole"), lights=[half]), 0.0, 4
    plain = picture_by_seed(mapper, f"pane {behind}", scene, seeds).mean(axis=(1, 2, 3))
    seen_through = picture_by_seed(mapper, f"pane {behind}", with_pane(scene, low, HEIGHT + 1e-3), seeds)
    change = seen_through.mean(axis=(1, 2, 3)) / plain - 1.0
    assert abs(change.mean()) < 5 * change.std(ddof=1) / math.sqrt(seeds) + 1e-3


def test_updates_show_what_builds_do(mapper, other_mapper, monkeypatch):
    """Portals that come, go and move in one world or another; what passes them is found anew where they or it did."""
    sky, even = with_portals("in the hole", True, photons=64), with_portals("wherever", photons=64)
    none, moved = dataclasses.replace(sky, lights=[]), dataclasses.replace(sky, lights=[portal(0.2, x=0.1)])
    walls = dataclasses.replace(moved, instances=moved.instances[:-1])
    found, calls = [], []
    monkeypatch.setattr(portals, "light_through", lambda *given: calls.append(0) or light_through(*given))
    for scene, known in ((sky, 0), (none, 0), (moved, 0), (walls, 1), (even, 0), (none, 0), (even, 0)):
        calls.clear()
        mapper.update(scene)
        assert len(calls) == (0 if known or not scene.lights else 1)
        other_mapper.build(scene)
        for each in (mapper, other_mapper):
            each.iterate()
        found.append(mapper.film.read_radiance())
        np.testing.assert_array_equal(found[-1], other_mapper.film.read_radiance())
    assert not np.array_equal(found[0], found[2]) and np.array_equal(found[4], found[6])


def test_portals_of_a_black_world_are_none(mapper):
    scene = with_portals("in the hole", photons=64)
    scene.world.radiance = np.zeros(3)
    iterated(mapper, scene)
    assert len(mapper.device_scene.lights.portals.records) == 0
    assert not mapper.film.read_radiance()[..., :3].any()


def test_portals_of_a_world_that_takes_light_away_are_as_good(mapper):
    seen = []
    for sign in (1.0, -1.0):
        scene = with_portals("in the hole", photons=1024)
        scene.world.radiance = sign * np.ones(3)
        iterated(mapper, scene, 2)
        assert len(mapper.device_scene.lights.portals.records) == 1
        seen.append(mapper.film.read_radiance()[..., :3])
    np.testing.assert_allclose(-seen[1], seen[0], rtol=1e-3, atol=1e-5)


@pytest.mark.long
def test_it_goes_on_bit_for_bit(mapper, other_mapper):
    """With what was learned of how many photons portals get."""
    scene = with_portals("a part of it", photons=1 << 12)
    assert_goes_on(mapper, scene, iterations=5, stops=(1, 3), other=other_mapper)

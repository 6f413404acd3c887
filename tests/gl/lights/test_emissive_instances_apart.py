# SPDX-License-Identifier: GPL-3.0-or-later
"""Emissive instances that rays place in the world, and that emit different light or light different objects, or light
media and shadow catchers: the same light as where they are expanded."""

import dataclasses

import fog
import numpy as np
import pytest
import scenes
from rendering import iterated, radiance_of
from test_emissive_instances import SEEDS, assert_alike, emitters_of, glowing, pictures

from rppm_addon.integrator.lights.emitters import by_instance
from rppm_addon.scene import DirectLight, Instancing, RayVisibility, Scene, World
from rppm_addon.scene.light_linking import LightLinking
from rppm_addon.scene.materials import Material
from rppm_addon.scene.node_graphs import NodeGraph

COUNT = 60


def by_node(kind: str, output: str) -> Material:
    """Emission whose strength a node gives, without its sign."""
    graph = NodeGraph()
    strength = graph.add("math", "value", options={"operation": "ABSOLUTE"}, value=graph.add(kind, output))
    graph.surface = graph.add("emission", "emission", color=(1.0, 0.7, 0.4), strength=strength)
    return Material(f"by {output}", graph)


def with_instances(scene: Scene, **members: object) -> Scene:
    """The scene with members of the glowing instances, by functions of their numbers."""
    instances = [*scene.instances]
    for number in range(1, 1 + COUNT):
        values = {name: value(number - 1) for name, value in members.items()}
        instances[number] = dataclasses.replace(instances[number], **values)
    scene.instances = instances
    return scene


def assert_same_light(mapper, make, iterations: int = 4) -> None:
    """Scenes that a function makes of an Instancing and whether to have another glowing object."""
    expected = pictures(mapper, make(Instancing.EXPANDED), iterations)
    assert not emitters_of(mapper).instances.are_there
    found = pictures(mapper, make(Instancing.TWO_LEVELS), iterations)
    assert emitters_of(mapper).instances.are_there
    assert_alike(found, expected)


RANDOMS = {
    "some": lambda number: float(np.random.default_rng(number).random()),
    "one of them": lambda number: 40.0 * (number == 7),
    "none but two": lambda number: 20.0 * (number in (0, 59)),
}


@pytest.mark.parametrize("asked", [1 << 17, 64])
@pytest.mark.parametrize("randoms", RANDOMS)
def test_emission_by_object(mapper, monkeypatch, randoms, asked):
    """asked: triangles that are asked at once, of which a ball has 48."""
    monkeypatch.setattr(by_instance, "MOST_ASKED", asked)

    def make(instancing: Instancing) -> Scene:
        scene = glowing(COUNT, instancing, by_node("object_info", "random"), photons=4096, others=False)
        return with_instances(scene, random=RANDOMS[randoms])

    assert_same_light(mapper, make, 16)


@pytest.mark.parametrize("mode", DirectLight)
def test_emission_by_place(mapper, mode):
    glow = by_node("new_geometry", "position")
    assert_same_light(
        mapper, lambda instancing: glowing(COUNT, instancing, glow, photons=4096, others=False, direct_light=mode), 24
    )


def test_choices_follow_what_each_instance_emits(mapper):
    """In proportion to its random number, and never less than a twentieth of the mean."""
    scene = glowing(COUNT, glow=by_node("object_info", "random"), others=False)
    mapper.build(
        with_instances(scene, random=lambda number: float(number % 4), matrix=lambda _: scenes.placed(0, 0, 1))
    )
    weights = emitters_of(mapper).instances.weights
    expected = np.maximum(np.arange(COUNT) % 4, 0.05 * 1.5)
    np.testing.assert_allclose(weights / weights.mean(), expected / expected.mean(), rtol=1e-5)


def test_an_instance_that_has_changed_is_asked_again_and_no_other(mapper, monkeypatch):
    scene = with_instances(glowing(COUNT, glow=by_node("object_info", "random"), others=False), random=lambda _: 1.0)
    mapper.build(scene)
    before = emitters_of(mapper).instances.weights
    asked = []
    ask = by_instance.InstanceEmission._ask_strengths
    monkeypatch.setattr(
        by_instance.InstanceEmission,
        "_ask_strengths",
        lambda self, instances, *others: asked.append(len(instances)) or ask(self, instances, *others),
    )
    changed = [*scene.instances]
    changed[5] = dataclasses.replace(changed[5], random=3.0)
    mapper.update(dataclasses.replace(scene, instances=changed))
    after = emitters_of(mapper).instances.weights
    assert asked == [1]
    np.testing.assert_allclose(after / before, np.where(np.arange(COUNT) == 4, 3.0, 1.0), rtol=1e-5)


def test_instances_that_all_emit_nothing(mapper):
    mapper.build(with_instances(glowing(COUNT, glow=by_node("object_info", "random"), others=False)))
    assert not emitters_of(mapper).instances.are_there


LINKS = [None, LightLinking(light_set_membership=0b10), LightLinking(light_set_membership=0b01),
         LightLinking(shadow_set_membership=0b01)]  # fmt: skip
"""Links of instances that light all, the floor alone, all but the floor, and through what is above the floor."""


def linked(instancing: Instancing, mode: DirectLight) -> Scene:
    scene = glowing(COUNT, instancing, photons=4096, direct_light=mode)
    scenes.add(scene, scenes.square("sheet", 0.3, 0.4), scenes.diffuse(0.6, 0.3, 0.3))
    scene.instances[0] = dataclasses.replace(scene.instances[0], linking=LightLinking(receiver_light_set=1))
    scene.instances[-1] = dataclasses.replace(scene.instances[-1], linking=LightLinking(blocker_shadow_set=1))
    return with_instances(scene, linking=lambda number: LINKS[number % 4])


@pytest.mark.parametrize("mode", DirectLight)
def test_light_linking(mapper, mode):
    assert_same_light(mapper, lambda instancing: linked(instancing, mode), 8)
    assert len(emitters_of(mapper).instances.leaves) == COUNT
    assert set(emitters_of(mapper).instances.links.tolist()) == {0, 1, 2, 3}


def in_fog(instancing: Instancing, mode: DirectLight) -> Scene:
    scene = glowing(COUNT, instancing, photons=8192, direct_light=mode)
    scene.world = World(np.zeros(3), volume=fog.volume(0.2, 0.05, 0.3))
    hidden = RayVisibility.ALL & ~RayVisibility.VOLUME_SCATTER
    return with_instances(scene, visibility=lambda number: hidden if number % 3 == 0 else RayVisibility.ALL)


@pytest.mark.parametrize("mode", DirectLight)
def test_light_in_media(mapper, mode):
    assert_same_light(mapper, lambda instancing: in_fog(instancing, mode), 24)


def test_light_on_shadow_catchers(mapper):
    """A sheet above a catching floor stops the same fraction of the light of instances, expanded or in two levels."""

    def alpha(instancing: Instancing) -> np.ndarray:
        made = []
        for seed in range(SEEDS):
            scene = glowing(COUNT, instancing, photons=64, seed=seed, film_transparent=True)
            scenes.add(scene, scenes.square("sheet", 0.3, 0.2), scenes.diffuse(0.6, 0.3, 0.3))
            scene.instances[0] = dataclasses.replace(scene.instances[0], shadow_catcher=True)
            made.append(radiance_of(mapper, scene, 16)[..., 3:].astype(np.float64))
        alphas = np.array(made)
        return alphas.reshape(SEEDS, 4, alphas.shape[1] // 4, 4, -1, 1).mean(axis=(2, 4))

    expected, found = alpha(Instancing.EXPANDED), alpha(Instancing.TWO_LEVELS)
    assert emitters_of(mapper).instances.are_there
    assert 0.1 < expected.mean() < 0.95
    assert_alike(found, expected)


def test_a_closed_form(mapper):
    """Balls in one place high above a floor, whose radiances are together 1: their area as seen from the floor over the
    square of the height, times the albedo over pi. None is in the way of another's nearest triangles."""
    scene = glowing(COUNT, glow=by_node("object_info", "random"), others=False, photons=64)
    scene.world = World(np.zeros(3))
    scene = with_instances(
        scene, random=lambda number: number / (0.5 * COUNT * (COUNT - 1)), matrix=lambda _: scenes.placed(0, 0, 8, 0.2)
    )
    frame = iterated(mapper, scene, 32).film.read_radiance()[..., :3].mean(axis=(0, 1))
    ball = scene.meshes[1]
    corners = 0.2 * ball.positions[ball.corner_vertices[ball.triangle_corners]].astype(np.float64)
    across = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    projected = 0.5 * np.abs(across[:, 2]).sum()
    places = (np.arange(32) + 0.5) / 32 * 1.2 - 0.6
    fall_off = ((1.0 + (places**2 + places[:, None] ** 2) / 64.0) ** -2.0).mean()
    # Half of the samples lie on the far side: 32,768 have a standard error of half a percent.
    expected = fall_off * 0.5 * projected / 64.0 * np.array([1.0, 0.7, 0.4]) / np.pi
    assert frame == pytest.approx(expected, rel=0.02)

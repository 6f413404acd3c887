# SPDX-License-Identifier: GPL-3.0-or-later
"""Media within instances that rays place in the world are those of expanded instances, bit for bit."""

import fog
import numpy as np
import pytest
import scenes
from rendering import radiance_of
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import AccelerationStructure, Instance, Instancing, Material, NodeGraph, Scene

CROWD = 24
GLOW = (0.5, 1.0, 0.2)


def drink() -> Material:
    return material("drink", Lobe(LobeKind.GLASS, ior=1.3), absorption=np.array([0.5, 4.0, 9.0]))


def milk() -> Material:
    return Material(
        "milk", material("glass", Lobe(LobeKind.GLASS, ior=1.4)).graph, fog.volume((4.0, 3.0, 2.0), 0.1, 0.4)
    )


def uneven(glows: bool) -> Material:
    """A medium whose density, or whose emission, grows upward in the space of the object."""
    graph = NodeGraph()
    height = graph.add("separate_xyz", "z", vector=graph.add("tex_coord", "object"))
    options = {"operation": "MULTIPLY_ADD"}
    strength = graph.add("math", "value", options=options, value=height, value_001=1.0, value_002=1.2)
    if glows:
        graph.surface = graph.add("emission", "emission", color=GLOW, strength=strength)
    else:
        graph.surface = graph.add("volume_scatter", "volume", color=(0.8, 0.6, 0.4), density=strength)
    return Material("uneven", fog.fog(0.0).graph, graph)


MEDIA = {
    "drink": drink,
    "milk": milk,
    "fog": lambda: fog.fog((1.0, 2.0, 3.0), 0.2, 0.5),
    "uneven fog": lambda: uneven(False),
    "glow": lambda: fog.fog(0.2, 0.1, emission=GLOW),
    "uneven glow": lambda: uneven(True),
}


def crowd(filled: Material, instancing: Instancing, structure: AccelerationStructure) -> Scene:
    """Balls, turned, skewed and mirrored, some within others; the camera and a lamp are in one each."""
    camera = fog.camera((0.0, -3.0, 0.6), (0.0, 0.0, 0.2), 0.6, 24)
    floor = scenes.square("floor", 2.0), scenes.diffuse(0.8, 0.5, 0.3), np.eye(4)
    ball = scenes.sphere("ball", 16, 8), filled, scenes.placed(0.0, -3.0, 0.7, 0.6)
    lamps = [fog.lamp(0.3, 0.1, 0.3), fog.lamp(0.0, -1.0, 2.0)]
    scene = fog.scene_of(
        camera, floor, ball, lights=lamps, photons=2048, max_bounces=6, volume_bounces=3, instancing=instancing,
        acceleration_structure=structure,
    )  # fmt: skip
    scene.instances.append(Instance(1, scenes.placed(0.3, 0.1, 0.3, 0.2), [1]))
    random = np.random.default_rng(7)
    for number in range(CROWD):
        matrix = scenes.placed(*random.uniform((-1.2, -1.0, 0.0), (1.2, 1.4, 0.5)))
        matrix[:3, :3] = random.normal(size=(3, 3)) * 0.1 + np.eye(3) * (0.25 if number % 3 else -0.25)
        scene.instances.append(Instance(1, matrix, [1]))
    return scene


def in_two_slots(scene: Scene) -> Scene:
    """The scene, in which the balls have halves of different media, by their own slots."""
    scene.meshes[1].triangle_slots[::2] = 1
    scene.materials.append(fog.fog((3.0, 0.5, 0.1)))
    for number, instance in enumerate(scene.instances[1:]):
        instance.materials[:] = ([1, 2], [2, 1], [2])[number % 3]
    return scene


def assert_levels_equal(mapper, expanded: Scene, in_levels: Scene) -> None:
    picture = radiance_of(mapper, expanded, 3)
    assert mapper.device_scene.geometry.instanced is None
    same = radiance_of(mapper, in_levels, 3)
    instanced = mapper.device_scene.geometry.instanced
    assert instanced is not None and len(instanced.placements) == CROWD + 2
    assert picture[..., :3].std() > 0.01
    np.testing.assert_array_equal(same, picture)


@pytest.mark.parametrize("structure", AccelerationStructure)
@pytest.mark.parametrize("name", MEDIA)
def test_media_are_those_of_expanded_instances(mapper, name, structure):
    ways = Instancing.EXPANDED, Instancing.TWO_LEVELS
    assert_levels_equal(mapper, *(crowd(MEDIA[name](), way, structure) for way in ways))


def test_media_of_slots(mapper, other_mapper):
    """Also in a scene that was edited: the slots on the device were others before."""
    structure, levels = AccelerationStructure.BVH, Instancing.TWO_LEVELS
    edited = in_two_slots(crowd(drink(), levels, structure))
    assert_levels_equal(mapper, in_two_slots(crowd(drink(), Instancing.EXPANDED, structure)), edited)
    mapper.build(crowd(drink(), levels, structure))
    mapper.iterate()
    mapper.update(edited)
    mapper.iterate()
    np.testing.assert_array_equal(mapper.film.read_radiance(), radiance_of(other_mapper, edited))

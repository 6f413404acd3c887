# SPDX-License-Identifier: GPL-3.0-or-later
"""Emissive instances that rays place in the world: chosen as often as their probabilities say, and the same light as
where they are expanded."""

import dataclasses

import numpy as np
import pytest
import scenes
from moving_scenes import open_for, way
from rendering import radiance_of
from support.lobes import Lobe, LobeKind, material
from test_light_choice import CHOICES, SHADER, run
from test_light_sources import floor_scene

from rppm_addon.integrator.lights.emitters import candidates, meshes
from rppm_addon.integrator.lights.emitters.instances import INSTANCED_EMITTERS
from rppm_addon.scene import AccelerationStructure, DirectLight, Instance, Instancing, Scene, World
from rppm_addon.scene.errors import DeviceError
from rppm_addon.scene.materials import Material
from rppm_addon.scene.node_graphs import Link, NodeGraph, ShaderNode

GLOW = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 0.7, 0.4)))


def striped() -> Material:
    """Emission that grows along U."""
    nodes = [
        ShaderNode("tex_coord"),
        ShaderNode("tex_gradient", inputs={"vector": Link(0, "uv")}),
        ShaderNode("emission", inputs={"color": Link(1, "color"), "strength": 2.0}),
    ]
    return Material("striped", NodeGraph(nodes, surface=Link(2, "emission")))


def matrices(count: int) -> list[np.ndarray]:
    """Placements over the floor, all but each third uneven and turned at random, some mirrored."""
    generator = np.random.default_rng(3)
    found = []
    for number in range(count):
        matrix = np.eye(4)
        matrix[:3, :3] = 0.06 * generator.normal(size=(3, 3)) if number % 3 else 0.05 * np.eye(3)
        if number % 5 == 0:
            matrix[:3, 0] *= -1.0
        matrix[:3, 3] = generator.uniform(-1.0, 1.0, 3) + (0.0, 0.0, 1.3)
        found.append(matrix)
    return found


def glowing(
    count: int = 60,
    instancing: Instancing = Instancing.TWO_LEVELS,
    glow: Material = GLOW,
    floor: Material | None = None,
    others: bool = True,
    **settings: object,
) -> Scene:
    """A floor under instances of a ball that glows; others: beside a ball that occurs once."""
    scene = floor_scene(None, DirectLight.RAYS, World(np.full(3, 0.02)))
    kept = {"instancing": instancing, "acceleration_structure": AccelerationStructure.BVH, **settings}
    scene.settings = dataclasses.replace(scene.settings, **kept)
    if floor is not None:
        scene.materials[0] = floor
    mesh = scenes.sphere("ball", 8, 4)
    around = np.arctan2(mesh.positions[:, 1], mesh.positions[:, 0]) / (2.0 * np.pi) + 0.5
    across = np.stack([around, mesh.positions[:, 2]], axis=1)[mesh.corner_vertices].astype(np.float32)
    scene.meshes.append(dataclasses.replace(mesh, corner_uv=across))
    scene.materials.append(glow)
    ball, glows = len(scene.meshes) - 1, len(scene.materials) - 1
    scene.instances += [Instance(ball, matrix, [glows], "ball") for matrix in matrices(count)]
    if others:
        scenes.add(scene, scenes.sphere("other", 8, 4), glow, scenes.placed(0.4, 0.3, 0.4, 0.2))
    return scene


def emitters_of(mapper):
    return mapper.device_scene.lights.emitters


@pytest.mark.parametrize("count", [2, 60])
@pytest.mark.parametrize("others", [False, True])
def test_choices_come_as_often_as_they_say(mapper, library, monkeypatch, count, others):
    """A triangle of an instance has the product of both levels. All together come to one, but for the places in the
    tree below which nothing can shine on the point."""
    mapper.build(glowing(count, others=others))
    assert len(emitters_of(mapper).instances.leaves) == count
    assert (emitters_of(mapper).count > 0) == others
    compute = library.compute
    monkeypatch.setattr(
        library, "compute", lambda path, defines=None: compute(path, INSTANCED_EMITTERS if path == SHADER else defines)
    )
    generator, sums = np.random.default_rng(count), []
    for _ in range(6):
        normal = generator.normal(size=3)
        point = {"point": generator.uniform(-1.5, 1.5, 3), "normal": normal / np.linalg.norm(normal)}
        table = run(mapper, library, **point)
        lit = table[:, 2] > 0
        chosen, probability = table[lit, :2].view(np.uint32), table[lit, 2].astype(np.float64)
        _, first, counts = np.unique(chosen, axis=0, return_index=True, return_counts=True)
        expected = probability[first] * CHOICES
        # Where one number suffices, ends of intervals; behind twelve levels a random number takes over.
        assert (np.abs(counts - expected) < 3.0 + 5.0 * np.sqrt(expected) * (count > 2)).all()
        # Rays that meet the triangle know it.
        np.testing.assert_allclose(table[lit, 3], probability, rtol=1e-5)
        sums.append(probability[first].sum() / lit.mean())
    np.testing.assert_allclose(sums, 1.0, atol=0.02)


FLOORS = {
    "diffuse": None,
    "rough": material("rough", Lobe(LobeKind.GLOSSY, color=(0.8, 0.8, 0.8), roughness=0.4)),
    "smooth": material("smooth", Lobe(LobeKind.PRINCIPLED, color=(0.5, 0.5, 0.5), roughness=0.02)),
}
SEEDS = 8


def pictures(mapper, scene: Scene, iterations: int = 4) -> np.ndarray:
    """(SEEDS, 4, 4, 3) float64 means of blocks."""
    made = []
    for seed in range(SEEDS):
        seeded = dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, seed=seed))
        picture = radiance_of(mapper, seeded, iterations)[..., :3].astype(np.float64)
        made.append(picture.reshape(4, picture.shape[0] // 4, 4, -1, 3).mean(axis=(1, 3)))
    return np.array(made)


def assert_alike(found: np.ndarray, expected: np.ndarray) -> None:
    """Means of seeds (SEEDS, ...) within five standard errors, blocks and all together, which tells 1 %."""
    for axes in ((), (1, 2)):
        a, b = found.mean(axis=axes) if axes else found, expected.mean(axis=axes) if axes else expected
        error = np.sqrt((a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1)) / SEEDS)
        difference = np.abs(a.mean(axis=0) - b.mean(axis=0))
        assert (difference < 5.0 * error + 1e-9).all(), (difference / error).max()
    assert (error < 0.01 * b.mean(axis=0)).all()


@pytest.mark.parametrize("mode", DirectLight)
@pytest.mark.parametrize("floor", FLOORS)
def test_the_light_is_that_of_expanded_instances(mapper, floor, mode):
    members = {"floor": FLOORS[floor], "direct_light": mode, "photons": 4096}
    expected = pictures(mapper, glowing(instancing=Instancing.EXPANDED, **members))
    assert not emitters_of(mapper).instances.are_there
    found = pictures(mapper, glowing(**members))
    assert len(emitters_of(mapper).instances.leaves) == 60
    assert_alike(found, expected)


@pytest.mark.parametrize("mode", DirectLight)
def test_emission_that_varies_over_a_mesh(mapper, mode):
    members = {"glow": striped(), "direct_light": mode, "photons": 4096, "others": False}
    expected = pictures(mapper, glowing(instancing=Instancing.EXPANDED, **members), 24)
    found = pictures(mapper, glowing(**members), 24)
    assert len(emitters_of(mapper).instances.leaves) == 60
    assert_alike(found, expected)


def test_instances_that_move_while_the_shutter_is_open(mapper):
    def moving(instancing: Instancing) -> Scene:
        scene = glowing(12, instancing, photons=4096, others=False)
        return open_for(scene, instances=[way(k, scene.instances[k].matrix, 0.3, 0.1, 0.2) for k in (2, 5)])

    expected = pictures(mapper, moving(Instancing.EXPANDED), 24)
    found = pictures(mapper, moving(Instancing.TWO_LEVELS), 24)
    assert len(emitters_of(mapper).instances.leaves) == 12
    assert_alike(found, expected)


def test_two_levels_of_deep_cubemaps(mapper):
    cubemap = {"acceleration_structure": AccelerationStructure.DEEP_CUBEMAP}
    np.testing.assert_allclose(
        radiance_of(mapper, glowing(20, **cubemap), 2), radiance_of(mapper, glowing(20), 2), rtol=1e-4, atol=1e-5
    )


def test_light_groups_are_those_of_the_instances(mapper):
    def of_groups(instancing: Instancing) -> dict[str, np.ndarray]:
        scene = glowing(20, instancing)
        passes = tuple(f"Combined_{name}" for name in ("one", "two"))
        scene.settings = dataclasses.replace(scene.settings, light_groups=("one", "two"), passes=())
        scene.instances = [
            dataclasses.replace(instance, light_group=("one", "two")[number % 2]) if number else instance
            for number, instance in enumerate(scene.instances)
        ]
        radiance_of(mapper, scene, 32)
        found = mapper.film.read_passes()
        return {name: found[name].mean(axis=(0, 1)) for name in passes}

    expected, found = of_groups(Instancing.EXPANDED), of_groups(Instancing.TWO_LEVELS)
    for name, mean in expected.items():
        assert mean.max() > 0
        np.testing.assert_allclose(found[name], mean, rtol=0.05)


def test_moving_an_instance_asks_no_material_again(mapper, monkeypatch):
    scene = glowing(20)
    mapper.build(scene)
    monkeypatch.setattr(meshes, "mesh_emitters", lambda *_: pytest.fail("asked"))
    instances = [*scene.instances]
    matrix = np.array(instances[5].matrix)
    matrix[:3, 3] += 0.1
    instances[5] = dataclasses.replace(instances[5], matrix=matrix)
    mapper.update(dataclasses.replace(scene, instances=instances))
    box = emitters_of(mapper).instances.leaves  # kept until the next build
    assert len(box) == 20


def test_slots_without_a_material_keep_their_places(mapper):
    """Instances of a mesh that glow on other triangles each still do so after one has moved."""
    scene = glowing(4, others=False)
    slots = np.arange(scene.meshes[1].triangle_count, dtype=np.int32) % 2
    scene.meshes[1] = dataclasses.replace(scene.meshes[1], triangle_slots=slots)
    glows = scene.instances[1].materials[0]
    of_slots = [[glows, -1], [-1, glows]] * 2
    scene.instances[1:] = map(
        lambda instance, materials: dataclasses.replace(instance, materials=materials), scene.instances[1:], of_slots
    )

    def lit() -> list[np.ndarray]:
        return [mesh.records["radiance"].any(axis=1) for mesh in emitters_of(mapper).instances.meshes]

    mapper.build(scene)
    np.testing.assert_array_equal(lit(), [slots == 0, slots == 1])
    moved = dataclasses.replace(scene.instances[4], matrix=scenes.placed(0.0, 0.0, 1.0, 0.1))
    mapper.update(dataclasses.replace(scene, instances=[*scene.instances[:4], moved]))
    np.testing.assert_array_equal(lit(), [slots == 0, slots == 1])


def test_instances_that_lie_nowhere_emit_nothing(mapper):
    scene = glowing(20, others=False)
    for number, matrix in enumerate([np.full((4, 4), np.nan), scenes.placed(0.0, 0.0, 1.0, 1e20), np.zeros((4, 4))]):
        scene.instances[1 + number] = dataclasses.replace(scene.instances[1 + number], matrix=matrix)
    picture = radiance_of(mapper, scene, 2)
    assert len(emitters_of(mapper).instances.leaves) == 17
    assert np.isfinite(picture).all() and picture.max() > 0.0


def test_instances_that_emit_nothing_are_no_emitters(mapper, monkeypatch):
    """They take no places among those that can be chosen from."""
    scene = glowing(20, others=False)
    dense = scenes.sphere("dense", 32, 16)
    scene.meshes.append(dense)
    scene.instances += [Instance(len(scene.meshes) - 1, matrix, [0], "dense") for matrix in matrices(4)]
    ball = scene.meshes[1].triangle_count
    assert 20 + ball < dense.triangle_count
    monkeypatch.setattr(candidates, "STEPS", 20 + ball)
    mapper.build(scene)
    assert len(emitters_of(mapper).instances.leaves) == 20
    monkeypatch.setattr(candidates, "STEPS", 20 + ball - 1)
    with pytest.raises(DeviceError, match="can emit light"):
        mapper.build(scene)


def test_memory_does_not_grow_with_the_triangles_of_emissive_instances(mapper):
    sizes = []
    for count in (100, 1100):
        mapper.build(glowing(count, others=False))
        sizes.append(sum(mapper.memory_bytes.values()))
    assert (sizes[1] - sizes[0]) / 1000 < 1500  # bytes of an instance

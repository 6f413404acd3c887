# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that is updated in part gives the picture of one that is built anew, bit for bit."""

import dataclasses
import math

import numpy as np
import pytest
import scenes
from rendering import radiance_of
from support.graphs import surface_graph
from support.lobes import Lobe, LobeKind, image_world, material

from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import AccelerationStructure, Image, NodeGraph, Scene, World


def with_(scene: Scene, **members: object) -> Scene:
    """A scene that shares all other members."""
    return dataclasses.replace(scene, warnings=[], **members)


def replaced(members: list, index: int, **values: object) -> list:
    return [dataclasses.replace(m, **values) if i == index else m for i, m in enumerate(members)]


def first_scene() -> Scene:
    scene = scenes.room(24, photons=1024, camera_path_length=3, photon_path_length=3)
    pixels = np.random.default_rng(1).integers(0, 255, (4, 8, 4), np.uint8)
    scene.images = [Image("sky", pixels, "LINEAR")]
    scene.world = image_world(0)
    graph = NodeGraph()
    shown = graph.add("tex_image", "color", image=0, vector=graph.add("tex_coord", "normal"))
    graph.surface = graph.add("emission", "emission", color=shown)
    scene.lights[0].graph = graph
    return scene


def other_mesh(scene: Scene) -> Scene:
    index = scene.instances[-1].mesh
    mesh = scene.meshes[index]
    return with_(scene, meshes=replaced(scene.meshes, index, positions=(mesh.positions * 0.7).astype(np.float32)))


VIEW, PLACE = scenes.looking((0.4, -3.2, 0.3), (0, 0, 0)), scenes.placed(0, 0, 0.2, 0.3)
RED = material("red", Lobe(LobeKind.DIFFUSE, color=(0.9, 0.1, 0.05)), Lobe(LobeKind.GLOSSY, 0.2, roughness=0.3))
FOG = surface_graph("volume_absorption", color=(0.5, 0.2, 0.1), density=0.3)
CHANGES = {
    "moved camera": lambda s: with_(s, camera=dataclasses.replace(s.camera, matrix=VIEW)),
    "moved object": lambda s: with_(s, instances=replaced(s.instances, len(s.instances) - 1, matrix=PLACE)),
    "other mesh": other_mesh,
    "other material": lambda s: with_(s, materials=[RED, *s.materials[1:]]),
    "brighter light": lambda s: with_(s, lights=replaced(s.lights, 0, strength=3.0 * s.lights[0].strength)),
    "other image": lambda s: with_(s, images=[Image("sky", s.images[0].pixels[:, ::-1].copy(), "LINEAR")]),
    "other world": lambda s: with_(s, world=dataclasses.replace(s.world, radiance=np.array([0.1, 0.4, 0.2]))),
    "other volume of the world": lambda s: with_(s, world=dataclasses.replace(s.world, volume=FOG)),
    "other resolution": lambda s: with_(s, camera=dataclasses.replace(s.camera, width=17, height=13)),
    "fewer photons": lambda s: with_(s, settings=s.settings.with_values(photons=300, photon_path_length=2)),
    "fewer objects": lambda s: with_(s, instances=s.instances[:-1]),
}
moved_camera = CHANGES["moved camera"]


def assert_same_pictures(updated: list[np.ndarray], built: list[np.ndarray]) -> None:
    for a, b in zip(updated, built, strict=True):
        np.testing.assert_array_equal(a, b)


def pictures(mapper: ProgressivePhotonMapper) -> list[np.ndarray]:
    for _ in range(3):
        mapper.iterate()
    return [mapper.film.read_radiance(), *mapper.film.read_passes().values()]


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_an_update_equals_a_build(mapper, other_mapper, change):
    scene = first_scene()
    mapper.build(scene)
    before = pictures(mapper)
    changed = change(scene)
    mapper.update(changed)
    other_mapper.build(changed)
    updated = pictures(mapper)
    assert_same_pictures(updated, pictures(other_mapper))
    # else the comparison shows nothing
    assert before[0].shape != updated[0].shape or not np.array_equal(before[0], updated[0])


def test_changes_one_after_the_other(mapper, other_mapper):
    scene = first_scene()
    mapper.build(scene)
    for change in CHANGES.values():
        scene = change(scene)
        mapper.update(scene)
        mapper.iterate()
    np.testing.assert_array_equal(mapper.film.read_radiance(), radiance_of(other_mapper, scene))


def through(structure: AccelerationStructure, scene: Scene) -> Scene:
    settings = dataclasses.replace(scene.settings, acceleration_structure=structure)
    return dataclasses.replace(scene, settings=settings)


def test_the_center_of_the_deep_cubemap_changes_no_picture(mapper, other_mapper):
    scene = through(AccelerationStructure.DEEP_CUBEMAP, first_scene())
    mapper.build(scene)
    center = mapper.device_scene.acceleration.center.copy()
    moved = moved_camera(scene)
    mapper.update(moved, center_tolerance=math.inf)
    np.testing.assert_array_equal(mapper.device_scene.acceleration.center, center)
    other_mapper.build(moved)
    assert not np.array_equal(other_mapper.device_scene.acceleration.center, center)
    # Splats and rays start from other cells: the same photons and hits all the same.
    assert_same_pictures(pictures(mapper), pictures(other_mapper))


@pytest.mark.parametrize("structure", [AccelerationStructure.DEEP_CUBEMAP, AccelerationStructure.BVH])
def test_only_what_changed_is_built(mapper, monkeypatch, structure):
    """An edit redoes no more than it needs: no geometry and no structure of it for a view or a material."""
    scene = through(structure, first_scene())
    mapper.build(scene)
    done: list[str] = []
    for part in ("geometry", "materials", "lights", "acceleration"):
        stage = getattr(mapper.device_scene, part)
        whole = stage.build
        monkeypatch.setattr(stage, "build", lambda *a, whole=whole, part=part, **k: (done.append(part), whole(*a, **k)))

    for change, parts in (
        ("moved camera", []), ("other material", ["materials", "lights"]), ("brighter light", ["lights"]),
        ("moved object", ["geometry", "lights", "acceleration"]), (None, []),
    ):  # fmt: skip
        scene = CHANGES[change](scene) if change else with_(scene)
        done.clear()
        mapper.update(scene, center_tolerance=math.inf)
        assert done == parts


def test_warnings_stay_with_the_scene(mapper):
    scene = first_scene()
    scene.materials[0].graph.surface = dataclasses.replace(scene.materials[0].graph.surface, node=99)
    mapper.build(scene)
    assert scene.warnings
    moved = moved_camera(scene)
    mapper.update(moved)
    assert moved.warnings == scene.warnings
    for change in ("moved object", "moved camera", "brighter light", "other resolution"):
        moved = CHANGES[change](moved)
        mapper.update(moved)
        assert moved.warnings == scene.warnings


def test_a_world_that_looks_at_the_camera_follows_it(mapper, other_mapper):
    scene = first_scene()
    graph = NodeGraph()
    color = graph.add("tex_coord", "camera")
    graph.surface = graph.add("background", "background", color=color, strength=1.0)
    scene = with_(scene, world=World(np.ones(3), graph))
    mapper.build(scene)
    before = pictures(mapper)[0]
    moved = moved_camera(scene)
    mapper.update(moved)
    other_mapper.build(moved)
    updated = pictures(mapper)[0]
    np.testing.assert_array_equal(updated, pictures(other_mapper)[0])
    assert not np.array_equal(before, updated)


def test_an_iteration_that_is_dropped_leaves_nothing_behind(mapper, other_mapper):
    scene = first_scene()
    mapper.build(scene)
    steps = mapper.steps()
    for _ in range(4):
        next(steps)
    steps.close()
    moved = moved_camera(scene)
    mapper.update(moved)
    other_mapper.build(moved)
    np.testing.assert_array_equal(pictures(mapper)[0], pictures(other_mapper)[0])

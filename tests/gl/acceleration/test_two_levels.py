# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances that rays place in the world give the pictures of those that are expanded, bit for bit."""

import dataclasses

import numpy as np
import pytest
import scenes
from busy_scenes import SCENES, busy
from moving_scenes import everything_moves, open_for, way
from rendering import radiance_of
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.bvh import bottom_levels, bvh
from rppm_addon.integrator.device_scene import instancing as rule
from rppm_addon.scene import AccelerationStructure, Instance, Instancing, Scene
from rppm_addon.scene.light_linking import LightLinking
from rppm_addon.scene.passes import VECTOR

BALL = 5
"""Mesh of the room's two balls."""


def in_two_levels(scene: Scene, instancing: Instancing = Instancing.TWO_LEVELS) -> Scene:
    settings = dataclasses.replace(
        scene.settings, instancing=instancing, acceleration_structure=AccelerationStructure.BVH
    )
    return dataclasses.replace(scene, settings=settings)


def with_balls(*matrices: np.ndarray, **members: object) -> Scene:
    """The busy room with more mirror balls; members: of their instances."""
    scene = busy()
    scene.instances += [Instance(BALL, matrix, [2], **members) for matrix in matrices]
    return scene


def skewed() -> np.ndarray:
    matrix = scenes.placed(0.0, 0.4, 0.4, 0.3)
    matrix[0, 2], matrix[1, 0] = 0.2, -0.1
    return matrix


def subsurface() -> Scene:
    scene = busy()
    wax = Lobe(LobeKind.PRINCIPLED, color=(0.8, 0.5, 0.3), subsurface_weight=1.0, subsurface_scale=0.1)
    scene.materials[1] = scene.materials[2] = material("wax", wax)
    return scene


def filled() -> Scene:
    """A ball of amber beside others: it is expanded."""
    scene = with_balls(skewed(), scenes.placed(0.1, 0.5, 0.1, 0.25))
    scene.materials.append(material("amber", Lobe(LobeKind.GLASS), absorption=np.array([0.2, 1.0, 3.0])))
    scene.instances[-1].materials[:] = [len(scene.materials) - 1]
    return scene


def linked() -> Scene:
    scene = with_balls(skewed(), scenes.placed(0.1, 0.5, 0.1, 0.25), linking=LightLinking(receiver_light_set=1))
    scene.lights[0].linking = LightLinking(light_set_membership=2, shadow_set_membership=3)
    return scene


def shapeless() -> Scene:
    return with_balls(np.zeros((4, 4)), np.full((4, 4), np.nan), scenes.placed(0.1, 0.5, 0.1, 1e20))


OTHERS = {
    "mirrored": lambda: with_balls(scenes.placed(0.0, 0.4, 0.4, 0.3) @ np.diag([-1.0, 1.0, 1.0, 1.0])),
    "skewed": lambda: with_balls(skewed()),
    "flat": lambda: with_balls(scenes.placed(0.0, 0.4, 0.4, 0.3) @ np.diag([1.0, 1.0, 0.0, 1.0])),
    "shapeless": shapeless,
    "camera inside": lambda: with_balls(scenes.placed(0.0, -3.6, 0.0, 1.0)),
    "subsurface": subsurface,
    "filled": filled,
    "light linking": linked,
    "rigid motion": lambda: open_for(busy(), instances=[way(BALL, busy().instances[BALL].matrix, 0.5, 0.0, 0.2)]),
    "transparent": lambda: with_balls(skewed(), scenes.placed(-0.4, -0.1, -0.6, 0.5)),
    "crowded": lambda: scenes.dull_crowded_room(16, photons=2000),
}


@pytest.mark.parametrize("name", [*SCENES, *OTHERS])
def test_pictures_equal_those_of_expanded_instances(mapper, name):
    make = {**SCENES, **OTHERS}[name]
    expanded = radiance_of(mapper, in_two_levels(make(), Instancing.EXPANDED), 2)
    assert mapper.device_scene.geometry.instanced is None
    in_levels = radiance_of(mapper, in_two_levels(make()), 2)
    assert mapper.device_scene.geometry.instanced is not None
    np.testing.assert_array_equal(in_levels, expanded)


def moved(scene: Scene, member: int) -> Scene:
    matrix = np.array(scene.instances[member].matrix)
    matrix[:3, 3] += 0.05
    instances = [*scene.instances]
    instances[member] = dataclasses.replace(instances[member], matrix=matrix)
    return dataclasses.replace(scene, instances=instances)


def test_moving_an_instance_builds_no_bottom_level(mapper, other_mapper, monkeypatch):
    scene = in_two_levels(busy())
    mapper.build(scene)
    monkeypatch.setattr(bottom_levels, "triangle_nodes", lambda *_: pytest.fail("built again"))
    changed = moved(scene, BALL)
    mapper.update(changed)
    mapper.iterate()
    monkeypatch.undo()
    np.testing.assert_array_equal(mapper.film.read_radiance(), radiance_of(other_mapper, changed))


def bent(scene: Scene, member: int) -> Scene:
    """The scene with another shape of the mesh of an instance."""
    meshes = [*scene.meshes]
    number = scene.instances[member].mesh
    meshes[number] = dataclasses.replace(meshes[number], positions=meshes[number].positions * np.float32([1.0, 0.9, 1]))
    return dataclasses.replace(scene, meshes=meshes)


def test_what_bends_from_scene_to_scene_rebuilds_its_own(mapper, other_mapper, monkeypatch):
    """Automatic takes it out of the world triangles when it bends, and builds these no more."""
    monkeypatch.setattr(rule, "MANY_TRIANGLES", 1)
    scene = in_two_levels(busy(), Instancing.AUTOMATIC)
    mapper.build(scene)
    assert mapper.device_scene.geometry.instanced is None
    scene = bent(scene, BALL)
    mapper.update(scene)
    built = []
    nodes = bvh.triangle_nodes
    monkeypatch.setattr(bvh, "triangle_nodes", lambda *arguments: built.append(arguments) or nodes(*arguments))
    scene = bent(scene, BALL)
    mapper.update(scene)
    assert not built
    mapper.iterate()
    instanced = mapper.device_scene.geometry.instanced
    assert instanced is not None and [mesh.name for mesh in instanced.meshes] == [scene.meshes[BALL].name]
    expected = radiance_of(other_mapper, scene)
    assert other_mapper.device_scene.geometry.instanced is None
    np.testing.assert_array_equal(mapper.film.read_radiance(), expected)


def test_memory_does_not_grow_with_the_triangles_of_instances(mapper):
    def bytes_of(count: int, instancing: Instancing) -> int:
        places = np.random.default_rng(3).uniform(-0.5, 0.5, (count, 3))
        mapper.build(in_two_levels(with_balls(*(scenes.placed(*place, 0.05) for place in places)), instancing))
        return sum(mapper.memory_bytes.values())

    few, many = (bytes_of(count, Instancing.TWO_LEVELS) for count in (10, 210))
    expanded = bytes_of(210, Instancing.EXPANDED)
    assert (many - few) / 200 < 1000  # bytes of an instance, whose mesh has 960 triangles
    assert expanded > 200 * 960 * 150


def test_passes_equal_those_of_expanded_instances(mapper):
    """Object index, normals, depth, positions and light passes are those of the instances."""
    found = []
    for instancing in (Instancing.EXPANDED, Instancing.TWO_LEVELS):
        radiance_of(mapper, in_two_levels(busy(), instancing))
        found.append(mapper.film.read_passes())
    assert {"Depth", "Normal", "Position"} <= set(found[0])
    for name, values in found[0].items():
        np.testing.assert_array_equal(found[1][name], values, err_msg=name)


def between_frames() -> Scene:
    """A ball moves and bends from frame to frame, another bends, one that is mirrored rests, and the camera moves."""
    scene = with_balls(scenes.placed(0.0, 0.4, 0.4, 0.3) @ np.diag([-1.0, 1.0, 1.0, 1.0]), skewed())
    neighbors = everything_moves(scene, 0.4).shutter
    settings = dataclasses.replace(scene.settings, passes=(VECTOR,))
    return dataclasses.replace(scene, neighbors=neighbors, settings=settings)


@pytest.mark.parametrize("offset", [0.0, 50000.0])
def test_motion_vectors_equal_those_of_expanded_instances(mapper, offset):
    """At the world's origin and far from it, where vertices are counted from a pivot."""
    scene, far = between_frames(), scenes.placed(offset, 0.0, 0.0)
    instances = [dataclasses.replace(item, matrix=far @ item.matrix) for item in scene.instances]
    camera = dataclasses.replace(scene.camera, matrix=far @ scene.camera.matrix)
    neighbors = dataclasses.replace(
        scene.neighbors,
        instances=[dataclasses.replace(way, matrices=far @ way.matrices) for way in scene.neighbors.instances],
        camera=dataclasses.replace(scene.neighbors.camera, matrices=far @ scene.neighbors.camera.matrices),
    )
    scene = dataclasses.replace(scene, instances=instances, camera=camera, neighbors=neighbors)
    found = []
    for instancing in (Instancing.EXPANDED, Instancing.TWO_LEVELS):
        radiance_of(mapper, in_two_levels(scene, instancing), 2)
        found.append(mapper.film.read_passes()[VECTOR])
    assert mapper.device_scene.geometry.instanced is not None
    assert (found[0] != 0.0).any(axis=2).mean() > 0.9
    np.testing.assert_array_equal(found[1], found[0])

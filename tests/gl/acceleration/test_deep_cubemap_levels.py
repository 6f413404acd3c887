# SPDX-License-Identifier: GPL-3.0-or-later
"""Two levels of deep cubemaps: hits and pictures are those of expanded instances, bit for bit."""

import dataclasses

import numpy as np
import pytest
import scenes
from rendering import radiance_of

from rppm_addon.integrator.acceleration.instances import HitPaths
from rppm_addon.integrator.common.active_paths import ActivePaths
from rppm_addon.integrator.common.records.rays import HIT, NO_TRIANGLE
from rppm_addon.integrator.deep_cubemap.builder import CubemapBuilder
from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap
from rppm_addon.integrator.device_scene import acceleration
from rppm_addon.scene import AccelerationStructure, Instance, Instancing, Mesh, NodeGraph, Scene
from rppm_addon.self_test.meshes import sphere
from rppm_addon.self_test.ray_queries import ray_records

RAYS = 4000
EYE = np.array([0.0, -3.6, 0.0])
"""Place of the camera, and of the center of the deep cubemap."""
CUBEMAP = AccelerationStructure.DEEP_CUBEMAP


def leaves(count: int, *shape: float) -> Mesh:
    """Triangles strewn about the origin, in a cloud of a shape."""
    random = np.random.default_rng(7)
    corners = random.normal(size=(count, 1, 3)) + 0.05 * random.normal(size=(count, 3, 3))
    corners = (corners * shape).reshape(-1, 3).astype(np.float32)
    numbers = np.arange(3 * count, dtype=np.int32)
    normals = np.zeros_like(corners)
    return Mesh("leaves", corners, numbers, normals, numbers.reshape(-1, 3), np.zeros(count, np.int32))


def turned(random: np.random.Generator, size: float, skew: float = 0.0, reach: float = 0.9) -> np.ndarray:
    """A place in the room, turned and skewed at random."""
    matrix = np.eye(4)
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    matrix[:3, :3] = size * (axes + skew * random.normal(size=(3, 3)))
    matrix[:3, 3] = random.uniform(-reach, reach, 3)
    return matrix


def with_instances(mesh: Mesh, matrices: list[np.ndarray], structure: AccelerationStructure, way: Instancing) -> Scene:
    scene = scenes.room(8, photons=RAYS, acceleration_structure=structure, instancing=way)
    scene.meshes.append(mesh)
    scene.instances += [Instance(len(scene.meshes) - 1, matrix, [0]) for matrix in matrices]
    return scene


def hits_of(mapper, library, scene: Scene, rays: np.ndarray) -> tuple[np.ndarray, ...]:
    """Barycentric coordinates, distances and vertices of the hits of rays, and which of them hit anything."""
    mapper.build(scene)
    context, device_scene = mapper.context, mapper.device_scene
    assert (device_scene.geometry.instanced is None) == (scene.settings.instancing is Instancing.EXPANDED)
    active = ActivePaths(context, library, "rays of a test", "take fewer")
    active.fill(len(rays))
    queried, found = context.moderngl.buffer(rays.tobytes()), context.moderngl.buffer(reserve=HIT.size * len(rays))
    device_scene.acceleration.structure.trace(queried, found, active, HitPaths.PHOTON)
    hits = np.frombuffer(found.read(), HIT.dtype).copy()
    triangles = device_scene.geometry.triangles
    vertices = triangles.read(np.float32, 12 * triangles.capacity).reshape(-1, 3, 4)
    is_hit = hits["triangle"] != NO_TRIANGLE
    for resource in (active, queried, found):
        resource.release()
    hits = hits[is_hit]
    return is_hit, hits["distance"], hits["b1"], hits["b2"], vertices[hits["triangle"], :, :3]


def rays_in_room(center: np.ndarray) -> np.ndarray:
    """Rays from anywhere, from the center of the cubemap, and along the axes."""
    random = np.random.default_rng(3)
    origins = random.uniform(-0.9, 0.9, (RAYS, 3))
    origins[: RAYS // 2] = center
    directions = random.normal(size=(RAYS, 3))
    directions[: RAYS // 4] = random.uniform(-0.9, 0.9, (RAYS // 4, 3)) - center
    directions[-RAYS // 8 :] = np.eye(3)[random.integers(3, size=RAYS // 8)]
    return ray_records(origins, directions / np.linalg.norm(directions, axis=1, keepdims=True))


CLOUDS = {
    "closed": (sphere("ball"), lambda random: [turned(random, 0.1, 0.3) for _ in range(40)]),
    "long": (leaves(2000, 1.0, 0.005, 0.005), lambda random: [turned(random, 0.5) for _ in range(20)]),
    "flat": (leaves(2000, 1.0, 1.0, 0.0), lambda random: [turned(random, 0.3) for _ in range(20)]),
    "a list": (leaves(8, 1.0, 1.0, 1.0), lambda random: [turned(random, 0.1) for _ in range(200)]),
    "of unlike sizes": (
        leaves(2000, 1.0, 1.0, 1.0),
        lambda random: [turned(random, size) for size in 10.0 ** np.linspace(-4.0, 0.3, 20)],
    ),
    "far away": (
        leaves(2000, 1.0, 1.0, 1.0),
        lambda random: [turned(random, size, 0.2, 200.0) for size in 10.0 ** np.linspace(-1.0, 1.5, 30)],
    ),
    "around the camera": (
        leaves(2000, 1.0, 1.0, 1.0),
        lambda random: [scenes.placed(0.1 * k, -3.6, 0.0, 0.8) for k in range(4)],
    ),
    "mirrored": (sphere("ball"), lambda random: [turned(random, 0.2) @ np.diag([-1.0, 1, 1, 1]) for _ in range(10)]),
}


@pytest.mark.parametrize("name", CLOUDS)
def test_hits_equal_those_of_expanded_instances(mapper, other_mapper, library, name):
    mesh, places = CLOUDS[name]
    matrices = places(np.random.default_rng(5))
    rays = rays_in_room(EYE)
    expanded = with_instances(mesh, matrices, AccelerationStructure.BVH, Instancing.EXPANDED)
    expected = hits_of(other_mapper, library, expanded, rays)
    in_levels = with_instances(mesh, matrices, CUBEMAP, Instancing.TWO_LEVELS)
    assert expected[0].sum() > RAYS // 10
    for found, wanted in zip(hits_of(mapper, library, in_levels, rays), expected, strict=True):
        np.testing.assert_array_equal(found, wanted)


@pytest.mark.parametrize("arguments", [{"texel_buffers": False}, {"max_cluster_size": 4}, {"rasterize": True}])
def test_variants_of_cubemaps_find_the_same_hits(mapper, other_mapper, library, monkeypatch, arguments):
    mesh, places = CLOUDS["long"]
    matrices = places(np.random.default_rng(5))
    rays = rays_in_room(EYE)
    scene = with_instances(mesh, matrices, CUBEMAP, Instancing.TWO_LEVELS)
    expected = hits_of(mapper, library, scene, rays)

    class Variant(DeepCubemap):
        def __init__(self, context, library, **_):
            super().__init__(context, library, **{"rasterize": False, **arguments})

    monkeypatch.setattr(acceleration, "DeepCubemap", Variant)
    for found, wanted in zip(hits_of(other_mapper, library, scene, rays), expected, strict=True):
        np.testing.assert_array_equal(found, wanted)


def glowing_fog(scattering: float, emission: float) -> NodeGraph:
    graph = NodeGraph()
    graph.surface = graph.add(
        "volume_coefficients",
        "volume",
        scatter_coefficients=(scattering,) * 3,
        absorption_coefficients=(0.1,) * 3,
        emission_coefficients=(emission,) * 3,
    )
    return graph


def crowd_in_fog(size: int, **settings: object) -> Scene:
    """The crowded room full of fog, with a ball of fog that shines, which photons begin in, and more of its other
    balls."""
    scene = scenes.dull_crowded_room(size, **settings)
    scene.world.volume = glowing_fog(0.2, 0.0)
    scene.materials[-1].interior = glowing_fog(1.0, 2.0)
    scene.instances += [Instance(5, scenes.placed(0.2 * k, 0.3, 0.6, 0.08), [1]) for k in range(4)]
    return scene


@pytest.mark.parametrize("make", [scenes.room, pytest.param(crowd_in_fog, marks=pytest.mark.long)])
def test_pictures_equal_those_of_expanded_instances(mapper, make):
    films = []
    for way in (Instancing.EXPANDED, Instancing.TWO_LEVELS):
        scene = make(16, photons=2000, acceleration_structure=CUBEMAP, instancing=way)
        films.append(radiance_of(mapper, scene, 2))
    assert mapper.device_scene.geometry.instanced is not None
    np.testing.assert_array_equal(*films)


def test_cubemaps_of_meshes_stay_or_go_with_the_meshes(mapper, other_mapper, library, monkeypatch):
    """Whatever is added, moved or removed, hits are those of a scene that is new."""
    room = scenes.room(8, photons=RAYS, acceleration_structure=CUBEMAP, instancing=Instancing.TWO_LEVELS)
    random = np.random.default_rng(9)
    clouds = [leaves(200 + 50 * k, 0.3, 0.3, 0.3) for k in range(3)]
    meshes = [*room.meshes, *clouds]
    places = [[Instance(len(room.meshes) + k, turned(random, 0.5), [0]) for _ in range(3)] for k in range(3)]
    rays = rays_in_room(EYE)
    for chosen in ([0, 1], [0, 1, 2], [2, 0], [1]):
        instances = [*room.instances, *(instance for k in chosen for instance in places[k])]
        scene = dataclasses.replace(room, meshes=meshes, instances=instances)
        found, expected = hits_of(mapper, library, scene, rays), hits_of(other_mapper, library, scene, rays)
        other_mapper.release()
        for values, wanted in zip(found, expected, strict=True):
            np.testing.assert_array_equal(values, wanted)


def test_moving_an_instance_builds_the_cubemap_of_instances_alone(mapper, library, monkeypatch):
    mesh, places = CLOUDS["long"]
    scene = with_instances(mesh, places(np.random.default_rng(5)), CUBEMAP, Instancing.TWO_LEVELS)
    hits_of(mapper, library, scene, rays_in_room(EYE))
    built = []
    build = CubemapBuilder.build

    def counted(self, parameters, clusters):
        built.append(clusters.are_boxes)
        return build(self, parameters, clusters)

    monkeypatch.setattr(CubemapBuilder, "build", counted)
    matrix = np.array(scene.instances[-1].matrix)
    matrix[0, 3] += 0.05
    instances = [*scene.instances[:-1], dataclasses.replace(scene.instances[-1], matrix=matrix)]
    mapper.update(dataclasses.replace(scene, instances=instances))
    assert built == [True]

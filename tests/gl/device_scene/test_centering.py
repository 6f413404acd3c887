# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes far from the world's origin."""

import dataclasses

import numpy as np
import pytest
import scenes
from moving_scenes import everything_moves
from rendering import radiance_of

from rppm_addon.integrator.device_scene.centering import CELL, Centering
from rppm_addon.integrator.viewport.first_look import FirstLook
from rppm_addon.integrator.viewport.reprojection import Reprojection
from rppm_addon.scene import AovOutput, Light, LightKind, NodeGraph, Scene, World
from rppm_addon.scene.camera import Camera, Texels

FAR = {"20 km": (78 * CELL, -80 * CELL, CELL), "1,000 km": (3906 * CELL, 3907 * CELL, -2 * CELL)}
"""Meters; whole cells, so that what is left after centering is the scene at the origin, bit for bit."""
far_away = pytest.mark.parametrize("way", FAR.values(), ids=FAR)


def on_grid(matrices: np.ndarray) -> np.ndarray:
    """Matrices whose places doubles have exactly at 1,000 km as well."""
    result = np.array(matrices)
    result[..., :3, 3] = np.round(result[..., :3, 3] * 2.0**20) / 2.0**20
    return result


def moved(scene: Scene, way: tuple[float, ...]) -> Scene:
    """The scene as a whole in another place, its places on a grid."""

    def along(member, name="matrix"):
        matrices = on_grid(getattr(member, name))
        matrices[..., :3, 3] += way
        return dataclasses.replace(member, **{name: matrices})

    shutter = scene.shutter
    if shutter:
        instances, lights = ([along(each, "matrices") for each in part] for part in (shutter.instances, shutter.lights))
        camera = along(shutter.camera, "matrices")
        shutter = dataclasses.replace(shutter, instances=instances, lights=lights, camera=camera)
    instances, lights = ([along(each) for each in part] for part in (scene.instances, scene.lights))
    return dataclasses.replace(
        scene, camera=along(scene.camera), instances=instances, lights=lights, shutter=shutter, warnings=[]
    )


def telling_floor() -> Scene:
    """A floor below a camera, which writes places in three spaces."""
    floor = scenes.diffuse(0.5, 0.5, 0.5)
    add = floor.graph.add

    def transformed(source: str, target: str, vector: object) -> object:
        spaces = {"vector_type": "POINT", "convert_from": source, "convert_to": target}
        return add("vector_transform", "vector", options=spaces, vector=vector)

    position = add("new_geometry", "position")
    told = {
        "Geometry": position,
        "Object": add("object_info", "location"),
        "From Camera": transformed("CAMERA", "WORLD", (0.25, 0.5, 2.0)),
        "From Object": transformed("OBJECT", "WORLD", (0.25, 0.5, 2.0)),
        "To Object": transformed("WORLD", "OBJECT", position),
        "To Camera": transformed("WORLD", "CAMERA", position),
        "Raycast": add("raycast", "hit_position", direction=(0.0, 0.0, 1.0), length=9.0),
    }
    floor.graph.aovs = [AovOutput(name, value) for name, value in told.items()]
    aovs = tuple(f"{name}.RGBA" for name in told)
    settings = {"passes": ("Position",), "aovs": aovs, "photons": 64, "filter_width": 0.0, "iterations": 1}
    parts = (scenes.square("floor", 4.0), floor), (scenes.square("roof", 4.0, 4.0), scenes.diffuse(1, 1, 1))
    scene = scenes.scene_of(scenes.camera((0.5, 0, 3), (0.5, 0, 0), 0.5, 8), *parts, **settings)
    scene.instances[0].matrix = scenes.placed(0.5, 0.25, 0.0)
    return scene


def room(**settings: object) -> Scene:
    return scenes.room(24, photons=2048, camera_path_length=3, photon_path_length=4, **settings)


def with_nodes(scene: Scene) -> Scene:
    """The room with a lamp, a sun and a world whose light depends on places and directions."""
    shaders = {"object": "emission", "normal": "emission", "generated": "background"}
    graphs = [NodeGraph() for _ in shaders]
    for graph, (output, shader) in zip(graphs, shaders.items(), strict=True):
        graph.surface = graph.add(shader, shader, color=graph.add("tex_coord", output))
    lamp = Light("lamp", LightKind.POINT, scenes.placed(0.5, -0.5, 0.5), np.full(3, 2.0), radius=0.1, graph=graphs[0])
    sun = Light("sun", LightKind.SUN, scenes.looking((0, -3, 2), (0, 0, 0)), np.ones(3), sun_angle=0.2, graph=graphs[1])
    scene.lights += [lamp, sun]
    scene.world = World(np.ones(3), graphs[2])
    return scene


CHANGES = {"still": lambda scene: scene, "moving": lambda scene: everything_moves(scene, 1.0), "nodes": with_nodes}


@far_away
@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_scene_gives_the_same_picture_anywhere(mapper, way, change):
    scene = change(room())
    near = radiance_of(mapper, moved(scene, (0, 0, 0)), 3)
    assert near[..., :3].mean() > 0.1
    np.testing.assert_array_equal(radiance_of(mapper, moved(scene, way), 3), near)


def test_a_scene_gives_the_same_light_between_the_cells(mapper):
    """150 m off, where other places round otherwise: paths differ, so means do by noise."""
    scene = room()
    near, far = (radiance_of(mapper, moved(scene, way), 24)[..., :3] for way in ((0, 0, 0), (150.0, 150.0, 0)))
    # Means of 24 iterations; halves of the same render differ by less than 2 %.
    assert far.mean() == pytest.approx(near.mean(), rel=0.02)


@far_away
def test_places_are_those_of_the_world(renderer, way):
    near, far = (renderer.render(moved(telling_floor(), place)).frame.passes for place in ((0, 0, 0), way))
    assert np.ptp(near["Geometry"][..., 0]) > 2.0 and (near["Raycast"][..., 2] == 4.0).all()
    np.testing.assert_array_equal(near["Object"][0, 0, :3], (0.5, 0.25, 0.0))
    steps = np.spacing(np.abs(way).astype(np.float32))
    for name in ("Position", "Geometry", "Object", "From Camera", "From Object", "Raycast"):
        shift = far[name][..., :3].astype(np.float64) - near[name][..., :3]
        assert (np.abs(shift - way) <= steps).all(), name
    for name in ("To Camera", "To Object"):  # by way of the world, whose steps are these
        assert (np.abs(far[name] - near[name])[..., :3] <= 2.0 * steps.max()).all(), name


def test_places_in_vertices_are_as_precise_as_those_in_matrices(mapper):
    """As in maps and scans, at 20 km, where vertices of a float32 have steps of 2 mm. Turned by the matrix, too."""
    turned = np.eye(4)
    turned[:3, :3] = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3.0
    way = np.array([20480.0, -20480.0, 512.0])
    scene = room()
    meshes = [
        dataclasses.replace(mesh, positions=(np.round(mesh.positions * 256.0) / 256.0 + way).astype(np.float32))
        for mesh in scene.meshes
    ]
    camera = dataclasses.replace(scene.camera, matrix=scene.camera.matrix.copy())
    camera.matrix[:3, 3] += turned[:3, :3] @ way
    instances = [dataclasses.replace(instance, matrix=turned) for instance in scene.instances]
    mapper.build(dataclasses.replace(scene, meshes=meshes, instances=instances, camera=camera))
    geometry, origin = mapper.device_scene.geometry, mapper.scene.world_offset
    assert np.abs(origin - turned[:3, :3] @ way).max() <= CELL
    vertices = np.frombuffer(geometry.triangles.buffer.read(), np.float32).reshape(-1, 3, 4)
    found = vertices[: geometry.triangle_count, :, :3]
    used = [meshes[instance.mesh] for instance in instances]
    wanted = np.concatenate([mesh.positions[mesh.corner_vertices[mesh.triangle_corners]] for mesh in used])
    wanted = wanted.astype(np.float64) @ turned[:3, :3].T - origin
    np.testing.assert_allclose(found, wanted, atol=4 * np.spacing(np.float32(CELL)))


def test_what_does_not_change_stays_the_same_object():
    centering, scene = Centering(), moved(everything_moves(room(), 1.0), FAR["20 km"])
    first = centering.centered(scene)
    assert not np.array_equal(first.instances[0].matrix, scene.instances[0].matrix)
    nearer = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, matrix=scene.camera.matrix.copy()))
    nearer.camera.matrix[0, 3] += 1.0
    nearer.instances = [*scene.instances[:-1], dataclasses.replace(scene.instances[-1], random=0.5)]
    second = centering.centered(nearer)
    np.testing.assert_array_equal(second.world_origin, first.world_origin)
    assert second.shutter is first.shutter and second.camera is not first.camera
    same = [a is b for a, b in zip(first.instances, second.instances, strict=True)]
    assert same == [True] * (len(same) - 1) + [False]
    assert all(a is b for a, b in zip(first.lights, second.lights, strict=True))


def test_scenes_around_the_origin_are_left_alone():
    """However far off the camera is: what it sees is what needs fine coordinates."""
    scene, centering = room(), Centering()
    assert centering.centered(scene) is scene
    scene.camera.matrix[1, 3] = -50_000.0
    assert centering.centered(scene) is scene
    stray = dataclasses.replace(scene.instances[0], matrix=scenes.placed(0, -50_000.0, 0))
    centered = centering.centered(dataclasses.replace(scene, instances=[*scene.instances, stray]))
    np.testing.assert_array_equal(centered.world_origin, (0.0, -195 * CELL, 0.0))
    scene.camera.matrix[:3, 3] = np.nan
    assert centering.centered(scene) is scene


@pytest.mark.parametrize("viewer, moves", [((1.0, 2.0, 3.0, 1.0), True), ((0.0, 0.6, 0.8, 0.0), False)])
def test_textures_are_baked_around_their_object(viewer, moves):
    """Seen from a place or a direction; cameras of baking have no place of their own."""
    way, scene = np.array(FAR["20 km"]), moved(room(), FAR["20 km"])
    none = np.zeros((2, 2, 4), np.float32)
    far = (*(way + viewer[:3]), 1.0) if moves else viewer
    texels = Texels(0, np.full((2, 2), -1, np.int32), none[..., :2], none, far)
    camera = Camera(np.eye(4), (0, 2, 0, 2), 2, 2, orthographic=True, texels=texels)
    scene = dataclasses.replace(scene, camera=camera)
    centered = Centering().centered(scene)
    np.testing.assert_array_equal(centered.world_origin, way)
    assert centered.camera.texels.viewer == viewer
    # The world is seen from the world's origin.
    camera = dataclasses.replace(camera, texels=dataclasses.replace(texels, see_environment=True))
    scene = dataclasses.replace(scene, camera=camera)
    assert Centering().centered(scene) is scene


def test_suns_have_no_place():
    scene = moved(room(), FAR["20 km"])
    scene.lights.append(Light("sun", LightKind.SUN, scenes.placed(3.0, 0.0, 5.0), np.ones(3)))
    assert Centering().centered(scene).lights[1] is scene.lights[1]


@far_away
def test_viewports_move_their_pictures_from_cell_to_cell(context, library, mapper, way):
    """The view goes past the border between two: what is shown is what a view shows that goes as far within one."""
    shown = []
    for place in (np.array(way), np.array(way) + (0.5 * CELL, 0, 0)):
        geometry, centering = mapper.device_scene.geometry, mapper.device_scene.centering
        look = FirstLook(context, library, geometry, centered=centering.centered)
        reprojection = Reprojection(context, library, look)
        scene = moved(room(passes=()), tuple(place))
        picture = np.random.default_rng(1).random((24, 24, 4), np.float32)
        origins = []
        try:
            views = []
            for step in (-0.0625, 0.0625):
                camera = dataclasses.replace(scene.camera, matrix=scene.camera.matrix.copy())
                camera.matrix[0, 3] += step
                views.append(dataclasses.replace(scene, camera=camera))
                origins.append(centering.centered(views[-1]).world_offset)
            reprojection.keep(views[0], picture, 4.0)
            shown.append(reprojection.move(views[1]))
        finally:
            reprojection.release()
            look.release()
        assert np.array_equal(*origins) == (len(shown) == 1)
    assert shown[0][..., :3].std() > 0.1
    np.testing.assert_allclose(shown[1], shown[0], atol=1e-2)

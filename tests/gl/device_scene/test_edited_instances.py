# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of thousands of instances of which a few are edited give the pictures of those that are built anew."""

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest
import scenes
from rendering import radiance_of
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.bvh import leaves
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.integrator.surfaces.geometry import Geometry
from rppm_addon.integrator.surfaces.surface_attributes import SHADING_INSTANCE, SurfaceAttributes
from rppm_addon.scene import AccelerationStructure, FirstCameraHits, Instance, Instancing, RayVisibility, Scene
from rppm_addon.scene.materials import Material
from rppm_addon.scene.node_graphs import Link, NodeGraph, ShaderNode
from rppm_addon.self_test.meshes import rectangle

COUNT = 4200
"""Leaves: from 4096 on, a top level leaves those where they are that rest."""


def leafy(count: int = COUNT) -> Scene:
    """A room with a heap of leaves of two kinds, each an instance."""
    two_levels = {"instancing": Instancing.TWO_LEVELS, "acceleration_structure": AccelerationStructure.BVH}
    scene = scenes.room(16, photons=500, **two_levels)
    first = len(scene.meshes)
    scene.meshes += [
        rectangle("leaf", (-1, -1, 0), (1, -1, 0), (1, 1, 0.3), (-1, 1, 0)),
        rectangle("tile", (-2, -1, 0), (2, -1, 0), (2, 1, 0), (-2, 1, 0.5)),
    ]
    rng = np.random.default_rng(7)
    for place in rng.uniform(-0.6, 0.6, (count, 3)):
        matrix = scenes.placed(*place, 0.02)
        matrix[:3, :3] = matrix[:3, :3] @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
        scene.instances.append(Instance(first + int(rng.integers(2)), matrix, [0], "leaf", random=float(rng.uniform())))
    return scene


def edited(scene: Scene, member: int, **members: object) -> Scene:
    """The scene with another instance in place of one, counted from the end."""
    instances = list(scene.instances)
    instances[-member] = dataclasses.replace(instances[-member], **members)
    return dataclasses.replace(scene, instances=instances)


def shifted(scene: Scene, member: int, *step: float) -> Scene:
    matrix = np.array(scene.instances[-member].matrix)
    matrix[:3, 3] += step
    return edited(scene, member, matrix=matrix)


def shifted_here_and_there(scene: Scene) -> Scene:
    for member in (2, 3, 5, 40, 41, *range(300, COUNT, 300)):
        scene = shifted(scene, member, 0.0, 0.0, 0.1)
    return scene


def mirrored(scene: Scene) -> Scene:
    return edited(scene, 30, matrix=scene.instances[-30].matrix @ np.diag([-1.0, 1.0, 1.0, 1.0]))


def grown(scene: Scene) -> Scene:
    return edited(scene, 5, matrix=scene.instances[-5].matrix @ np.diag([20.0, 20.0, 20.0, 1.0]))


def without_some(scene: Scene) -> Scene:
    return dataclasses.replace(scene, instances=scene.instances[:-40])


def with_another_leaf(scene: Scene) -> Scene:
    meshes = list(scene.meshes)
    meshes[-2] = rectangle("leaf", (-1, -2, 0), (1, -2, 0), (1, 2, 0.3), (-1, 2, 0))
    return dataclasses.replace(scene, meshes=meshes)


EDITS: dict[str, Callable[[Scene], Scene]] = {
    "one moves": lambda scene: shifted(scene, 3, 0.1, 0.1, 0.2),
    "it moves on, out of the heap": lambda scene: shifted(scene, 3, 0.0, -2.0, 0.4),
    "some move here and there": shifted_here_and_there,
    "one grows": grown,
    "one has no place": lambda scene: edited(scene, 9, matrix=np.full((4, 4), np.nan)),
    "it has one again": lambda scene: edited(scene, 9, matrix=scenes.placed(0.0, -1.0, 0.2, 0.1)),
    "one is flat": lambda scene: edited(scene, 11, matrix=scene.instances[-11].matrix @ np.diag([1.0, 1.0, 0.0, 1.0])),
    "one is mirrored": mirrored,
    "one has another mesh": lambda scene: edited(scene, 12, mesh=scene.instances[-12].mesh ^ 1),
    "one has another material": lambda scene: edited(scene, 5, materials=[1]),
    "one is not seen": lambda scene: edited(scene, 5, visibility=RayVisibility.ALL & ~RayVisibility.CAMERA),
    "one has a softer terminator": lambda scene: edited(scene, 5, terminator_geometry_offset=0.3),
    "it has none again": lambda scene: edited(scene, 5, terminator_geometry_offset=0.0),
    "a mesh is replaced": with_another_leaf,
    "some are deleted": without_some,
}


def assert_like_a_fresh_one(
    mapper: ProgressivePhotonMapper, other_mapper: ProgressivePhotonMapper, scene: Scene, name: str
) -> None:
    mapper.update(scene)
    mapper.iterate()
    np.testing.assert_array_equal(mapper.film.read_radiance(), radiance_of(other_mapper, scene), err_msg=name)


@pytest.mark.parametrize(
    "structure",
    [
        AccelerationStructure.BVH,
        pytest.param(AccelerationStructure.DEEP_CUBEMAP, marks=pytest.mark.long),
    ],
)
def test_pictures_of_edited_scenes_equal_those_of_new_ones(mapper, other_mapper, structure):
    scene = leafy()
    scene.settings.acceleration_structure = structure
    assert_like_a_fresh_one(mapper, other_mapper, scene, "as it was")
    for name, edit in EDITS.items():
        scene = edit(scene)
        assert_like_a_fresh_one(mapper, other_mapper, scene, name)


def glowing_leaves(scene: Scene) -> Scene:
    materials = list(scene.materials)
    materials[0] = material("glowing", Lobe(LobeKind.EMISSION, color=(2.0, 1.0, 0.5)))
    return dataclasses.replace(scene, materials=materials)


def with_settings(**settings: object) -> Callable[[Scene], Scene]:
    return lambda scene: dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, **settings))


def test_edits_of_materials_and_settings_decide_anew_what_is_expanded(mapper, other_mapper):
    scene = leafy(200)
    mapper.build(scene)
    for edit, count, has_emitters in (
        (glowing_leaves, 200, True),
        (with_settings(instancing=Instancing.EXPANDED), 0, False),
        (with_settings(instancing=Instancing.TWO_LEVELS), 200, True),
        (with_settings(first_camera_hits=FirstCameraHits.RASTERIZED), 0, False),
    ):
        scene = edit(scene)
        assert_like_a_fresh_one(mapper, other_mapper, scene, str(edit))
        instanced = mapper.device_scene.geometry.instanced
        assert (0 if instanced is None else len(instanced.which)) >= count
        assert (instanced is None) == (count == 0)
        assert (instanced is not None and instanced.has_emitters) == has_emitters


def with_material(number: int, *lobes: Lobe) -> Callable[[Scene], Scene]:
    changed = material("changed", *lobes)
    return lambda scene: dataclasses.replace(
        scene, materials=[*scene.materials[:number], changed, *scene.materials[number + 1 :]]
    )


def resized(scene: Scene) -> Scene:
    return dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, width=40, height=40))


def test_all_paths_have_places_for_what_they_hit(mapper, other_mapper):
    """Paths of more pixels, of more photons, and those that new materials let go on, though no instance has changed."""
    scene = leafy(200)
    assert_like_a_fresh_one(mapper, other_mapper, scene, "as it was")
    pane = Lobe(LobeKind.TRANSPARENT, 0.5), Lobe(LobeKind.DIFFUSE, 0.5, (0.0, 0.8, 0.8))
    edits = {
        "more pixels": resized,
        "more photons": with_settings(photons=4000),
        "shadow rays pass leaves": with_material(0, *pane),
        "light goes below leaves": with_material(
            0, Lobe(LobeKind.PRINCIPLED, subsurface_weight=1.0, subsurface_scale=0.1)
        ),
    }
    for name, edit in edits.items():
        scene = edit(scene)
        assert_like_a_fresh_one(mapper, other_mapper, scene, name)


def test_far_scenes_are_edited_as_near_ones(mapper, other_mapper):
    """Where places are counted from elsewhere than the world's origin."""

    def far(scene: Scene) -> Scene:
        offset = np.array([20_000.0, -512.0, 0.0])
        for member in (*scene.instances, *scene.lights, scene.camera):
            member.matrix = np.array(member.matrix)
            member.matrix[:3, 3] += offset
        return scene

    scene = far(leafy())
    assert_like_a_fresh_one(mapper, other_mapper, scene, "as it was")
    for name in ("one moves", "one grows", "one has another mesh", "some are deleted"):
        scene = EDITS[name](scene)
        assert_like_a_fresh_one(mapper, other_mapper, scene, name)


def volume() -> Material:
    graph = NodeGraph([ShaderNode("volume_absorption")], surface=Link(0, "volume"))
    return Material("volume", NodeGraph([ShaderNode("volume_boundary")], surface=Link(0, "bsdf")), graph)


def test_nodes_see_volumes_where_they_lie_in_a_new_scene(context, library):
    """Volumes are drawn together, which their instances do not say: these are the same as before."""

    def seen(scene: Scene, geometry: Geometry, attributes: SurfaceAttributes) -> np.ndarray:
        geometry.build(scene, 0)
        attributes.build(scene, geometry, [])
        found = attributes.blocks["ShadingInstances"].read(len(scene.instances) * SHADING_INSTANCE.size)
        return np.frombuffer(found, SHADING_INSTANCE.dtype)["to_object0"].copy()

    def parts() -> tuple[Geometry, SurfaceAttributes]:
        return Geometry(context, library), SurfaceAttributes(context, library)

    solid = scenes.room(16)
    scenes.add(solid, scenes.box("body", 0.3), solid.materials[0], scenes.placed(0.1, 0.1, 0.4, 1.0))
    filled = dataclasses.replace(solid, materials=[*solid.materials[:-1], volume()])
    kept, found = parts(), []
    for scene in (solid, filled, shifted(filled, 1, 0.1, 0.0, 0.0), shifted(filled, 2, 0.1, 0.0, 0.0), solid):
        found.append(seen(scene, *kept))
        np.testing.assert_array_equal(found[-1], seen(scene, *parts()))
    assert (found[0][-1] != found[1][-1]).any()


def test_what_rests_is_not_sorted_again(mapper, monkeypatch):
    scene = leafy()
    mapper.build(scene)
    sorted_boxes = []
    build_nodes = leaves.build_nodes

    def counted(low: np.ndarray, *rest: np.ndarray) -> np.ndarray:
        sorted_boxes.append(low.shape[1])
        return build_nodes(low, *rest)

    monkeypatch.setattr(leaves, "build_nodes", counted)
    for member in range(1, 5):
        scene = shifted(scene, member, 0.05, 0.0, 0.0)
        mapper.update(scene)
    assert sorted_boxes == [2, 3, 4, 5]  # of what moved, and that around all that rests
    for member in range(1, COUNT // 8):
        scene = shifted(scene, member, 0.05, 0.0, 0.0)
    mapper.update(scene)
    assert sorted_boxes[-1] > COUNT

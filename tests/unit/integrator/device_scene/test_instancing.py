# SPDX-License-Identifier: GPL-3.0-or-later
"""The rule by which instances are expanded to world triangles."""

import dataclasses

import numpy as np
import pytest
from support.graphs import diffuse_by_node
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.instance_columns import InstanceColumns
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.device_scene import instancing
from rppm_addon.integrator.device_scene.instancing import MovedInstances, fits_expanded, instanced_members
from rppm_addon.scene import (
    AccelerationStructure,
    Camera,
    Deformation,
    FirstCameraHits,
    Instance,
    Instancing,
    Movement,
    RenderSettings,
    Scene,
    Shutter,
    Texels,
)  # fmt: skip
from rppm_addon.scene.light_linking import LightLinking
from rppm_addon.scene.materials import Material
from rppm_addon.scene.node_graphs import Link, NodeGraph, ShaderNode
from rppm_addon.scene.volumes import Volume
from rppm_addon.self_test.meshes import placed, rectangle, sphere

PLAIN, GLOWING, FILLED = range(3)
KEYS = np.array([0.0, 1.0])


def scene_of(*members: tuple[int, int], **settings: object) -> Scene:
    """Instances as (mesh, material); mesh 0 is a ball, 1 a rectangle."""
    meshes = [sphere("ball"), rectangle("wall", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))]
    materials = [
        material("plain", Lobe(LobeKind.DIFFUSE)),
        material("glowing", Lobe(LobeKind.EMISSION)),
    ]
    if FILLED in {kind for _, kind in members}:
        materials.append(material("filled", Lobe(LobeKind.GLASS), absorption=np.ones(3)))
    instances = [Instance(mesh, placed(k, 0, 0), [kind]) for k, (mesh, kind) in enumerate(members)]
    camera = Camera(np.eye(4), (-1, 1, -1, 1), 8, 8)
    return Scene(camera, meshes, instances, materials, settings=RenderSettings(**settings))


def members_of(scene: Scene, moved: tuple[int, ...] = (), is_software: bool = True) -> list[int]:
    has_moved = np.zeros(len(scene.instances), bool)
    has_moved[list(moved)] = True
    columns = InstanceColumns()
    columns.follow(scene.instances)
    found = instanced_members(scene, columns, has_moved, is_software)
    return [] if found is None else np.flatnonzero(found).tolist()


TWO_LEVELS = {"instancing": Instancing.TWO_LEVELS}
BALLS = [(0, PLAIN)] * 3
"""Three balls that share a mesh."""


def test_meshes_that_occur_more_than_once():
    assert members_of(scene_of(*BALLS, (1, PLAIN), **TWO_LEVELS)) == [0, 1, 2]


def test_what_is_filled_shares_its_triangles():
    assert members_of(scene_of((0, PLAIN), (0, FILLED), (0, FILLED), (1, PLAIN), **TWO_LEVELS)) == [0, 1, 2]


def test_boxes_of_grids_are_expanded():
    scene = scene_of(*[(0, FILLED)] * 2, *[(1, PLAIN)] * 2, **TWO_LEVELS)
    scene.meshes[0] = dataclasses.replace(scene.meshes[0], volume=Volume())
    assert members_of(scene) == [2, 3]


GLOWING_BALLS = [(0, GLOWING)] * 3


def test_what_glows_alike_shares_its_triangles():
    assert members_of(scene_of(*GLOWING_BALLS, (1, GLOWING), **TWO_LEVELS)) == [0, 1, 2]
    assert members_of(scene_of((0, PLAIN), (0, GLOWING), (1, PLAIN), **TWO_LEVELS)) == [0, 1]


def glowing_by(kind: str, output: str) -> Scene:
    """Balls whose emission has the strength that a node gives."""
    scene = scene_of(*GLOWING_BALLS, **TWO_LEVELS)
    nodes = [ShaderNode(kind), ShaderNode("emission", inputs={"strength": Link(0, output)})]
    scene.materials[GLOWING] = Material("glowing", NodeGraph(nodes, surface=Link(1, "emission")))
    return scene


def test_what_glows_by_object_or_place_shares_its_triangles():
    asked = ("object_info", "random"), ("particle_info", "age"), ("attribute", "fac"), ("new_geometry", "position")
    for kind, output in (*asked, ("tex_coord", "uv"), ("strand_value", "value"), ("new_geometry", "backfacing")):
        assert members_of(glowing_by(kind, output)) == [0, 1, 2], kind


def with_node(kind: str, output: str, **members: object) -> Scene:
    """Balls whose color is what a node gives."""
    scene = scene_of(*BALLS, **TWO_LEVELS)
    scene.materials[PLAIN] = diffuse_by_node(kind, output, **members)
    return scene


def test_nodes_that_trace_rays_share_triangles():
    for kind, output in (("ambient_occlusion", "color"), ("bevel", "normal"), ("raycast", "hit_normal")):
        assert members_of(with_node(kind, output)) == [0, 1, 2], kind


def test_what_glows_and_is_linked_shares_its_triangles():
    scene = with_instance(scene_of(*GLOWING_BALLS, **TWO_LEVELS), 1, linking=LightLinking(light_set_membership=2))
    assert members_of(scene) == [0, 1, 2]


def test_what_glows_beside_media_and_catchers_shares_its_triangles():
    assert members_of(scene_of(*GLOWING_BALLS, (0, PLAIN), (0, PLAIN), (1, FILLED), **TWO_LEVELS)) == [0, 1, 2, 3, 4]
    caught = with_instance(scene_of(*GLOWING_BALLS, (1, PLAIN), **TWO_LEVELS), 3, shadow_catcher=True)
    assert members_of(caught) == [0, 1, 2]


def bending(scene: Scene, number: int = 0) -> Scene:
    """The scene with a mesh that bends while the shutter is open."""
    mesh = scene.meshes[number]
    deformation = Deformation(number, KEYS, np.stack([mesh.positions] * 2), np.stack([mesh.corner_normals] * 2))
    return dataclasses.replace(scene, shutter=Shutter(np.ones(4), meshes=[deformation]))


def test_what_bends_shares_its_triangles_unless_it_glows():
    assert members_of(bending(scene_of(*BALLS, (1, PLAIN), **TWO_LEVELS))) == [0, 1, 2]
    assert members_of(bending(scene_of(*GLOWING_BALLS, (0, PLAIN), (0, PLAIN), **TWO_LEVELS))) == [3, 4]
    assert members_of(bending(scene_of(*GLOWING_BALLS, (1, PLAIN), **TWO_LEVELS), 1)) == [0, 1, 2]


def test_what_is_baked_is_expanded():
    scene = scene_of(*BALLS, **TWO_LEVELS)
    nothing = np.zeros((8, 8, 4), np.float32)
    texels = Texels(1, np.full((8, 8), -1, np.int32), nothing[..., :2], nothing)
    assert members_of(dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, texels=texels))) == [0, 2]


def test_few_triangles_are_expanded_unless_asked_for(monkeypatch):
    assert members_of(scene_of(*BALLS * 10)) == []
    monkeypatch.setattr(instancing, "MANY_TRIANGLES", 1)
    assert members_of(scene_of(*BALLS * 10)) == list(range(30))
    assert members_of(scene_of(*BALLS * 10, instancing=Instancing.EXPANDED)) == []


def test_instances_that_save_little_are_expanded_until_they_move(monkeypatch):
    monkeypatch.setattr(instancing, "MANY_TRIANGLES", 1)
    few = scene_of(*BALLS)
    assert members_of(few) == []
    assert members_of(few, moved=(1,)) == [1]


def test_an_object_that_occurs_once_and_moves():
    assert members_of(scene_of((0, PLAIN), (1, PLAIN), **TWO_LEVELS), moved=(0,)) == [0]
    assert members_of(scene_of((0, GLOWING), (1, PLAIN), **TWO_LEVELS), moved=(0,)) == []


def test_rasterized_first_hits_need_world_triangles():
    assert members_of(scene_of(*BALLS, **TWO_LEVELS)) != []
    assert members_of(scene_of(*BALLS, **TWO_LEVELS, first_camera_hits=FirstCameraHits.RASTERIZED)) == []


@pytest.mark.parametrize("structure", AccelerationStructure)
def test_a_gpu_has_two_levels_where_they_are_asked_for(monkeypatch, structure):
    monkeypatch.setattr(instancing, "MANY_TRIANGLES", 1)
    many = scene_of(*BALLS * 10, acceleration_structure=structure)
    assert members_of(many, is_software=False) == members_of(many, moved=(0, 1), is_software=False) == []
    asked = scene_of(*BALLS, acceleration_structure=structure, **TWO_LEVELS)
    assert members_of(asked, is_software=False) == [0, 1, 2]
    assert StageSizes.of(asked).first_camera_hits is FirstCameraHits.TRACED


def moved_in(*scenes: Scene) -> list[int]:
    movers = MovedInstances()
    for scene in scenes:
        found = movers.follow(scene)
    return np.flatnonzero(found).tolist()


def with_instance(scene: Scene, member: int, **members: object) -> Scene:
    instances = [*scene.instances]
    instances[member] = dataclasses.replace(instances[member], **members)
    return dataclasses.replace(scene, instances=instances)


def test_instances_that_move_from_scene_to_scene():
    first = scene_of(*BALLS)
    second = with_instance(first, 1, matrix=placed(0, 0, 5))
    assert moved_in(first) == moved_in(first, first) == []
    assert moved_in(first, second) == moved_in(first, second, second) == [1]
    assert moved_in(first, second, with_instance(second, 2, matrix=placed(0, 0, 6))) == [1, 2]
    assert moved_in(first, with_instance(first, 1, random=0.5)) == []
    assert moved_in(first, second, scene_of(*BALLS, (1, PLAIN))) == []


def test_instances_of_meshes_that_bend_from_scene_to_scene():
    first = scene_of(*BALLS, (1, PLAIN))
    wall = first.meshes[1]
    second = dataclasses.replace(
        first, meshes=[first.meshes[0], dataclasses.replace(wall, positions=2 * wall.positions)]
    )
    assert moved_in(first, second) == moved_in(first, second, second) == [3]
    copied = dataclasses.replace(first, meshes=[first.meshes[0], dataclasses.replace(wall, positions=+wall.positions)])
    assert moved_in(first, copied) == []
    assert moved_in(first, dataclasses.replace(second, meshes=[*second.meshes, wall])) == []


def test_instances_that_move_while_the_shutter_is_open():
    scene = scene_of(*BALLS)
    movement = Movement(2, KEYS, np.stack([placed(0, 0, 0), placed(0, 0, 1)]))
    assert moved_in(dataclasses.replace(scene, shutter=Shutter(np.ones(4), instances=[movement]))) == [2]
    assert moved_in(bending(scene_of(*BALLS, (1, PLAIN)), 1)) == [3]


@pytest.mark.parametrize("structure", AccelerationStructure)
def test_what_has_no_volume_shares_its_triangles_beside_volumes(structure):
    members = (0, PLAIN), (0, PLAIN), (1, FILLED)
    assert members_of(scene_of(*members, **TWO_LEVELS, acceleration_structure=structure)) == [0, 1]


def test_scenes_that_fit_expanded(monkeypatch):
    """By all triangles, of which a ball has 960, and by those that emit light."""
    scene = scene_of(*BALLS, (0, GLOWING), (1, PLAIN))
    assert fits_expanded(scene, 4 * 960 + 2) and not fits_expanded(scene, 4 * 960 + 1)
    assert fits_expanded(scene_of(), 0)
    monkeypatch.setattr(instancing, "STEPS", 960)
    assert fits_expanded(scene, 4 * 960 + 2)
    monkeypatch.setattr(instancing, "STEPS", 959)
    assert not fits_expanded(scene, 4 * 960 + 2)
    assert fits_expanded(scene_of(*BALLS, (1, GLOWING)), 4 * 960)

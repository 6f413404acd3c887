# SPDX-License-Identifier: GPL-3.0-or-later
"""Light and shadow linking as sets of objects, numbered as Blender does."""

import bpy
import pytest
from blender_scenes import add_light, add_mesh, depsgraph, export, show_collection

from rppm_addon.blender.export.updates.sync import SceneSync
from rppm_addon.scene import ALL_SETS, UNLIMITED_BOUNCES, LightLinking, RayVisibility


def collection(*objects, state="INCLUDE", child=None):
    made = bpy.data.collections.new("linked")
    for linked in objects:
        made.objects.link(linked)
        made.collection_objects[-1].light_linking.link_state = state
    if child is not None:
        made.children.link(child)
    return made


@pytest.fixture
def lit(scene):
    """Three meshes and two lights."""
    return [add_mesh(scene) for _ in range(3)], [add_light(scene, "POINT") for _ in range(2)]


def shining_on(exported, light):
    """Indices of the instances that a light shines on."""
    linking = exported.lights[light].linking or LightLinking()
    sets = [(instance.linking or LightLinking()).receiver_light_set for instance in exported.instances]
    return [index for index, number in enumerate(sets) if linking.light_set_membership >> number & 1]


def stopping(exported, light):
    """Indices of the instances that cast shadows in its light."""
    linking = exported.lights[light].linking or LightLinking()
    sets = [(instance.linking or LightLinking()).blocker_shadow_set for instance in exported.instances]
    return [index for index, number in enumerate(sets) if linking.shadow_set_membership >> number & 1]


def test_nothing_is_linked_by_default(scene, lit):
    exported = export(scene)
    assert all(member.linking is None for member in (*exported.instances, *exported.lights))


def test_objects_that_are_included(scene, lit):
    meshes, (light, _) = lit
    light.light_linking.receiver_collection = collection(meshes[1])
    exported = export(scene)
    assert shining_on(exported, 0) == [1] and shining_on(exported, 1) == [0, 1, 2]
    assert stopping(exported, 0) == [0, 1, 2]


def test_objects_that_are_excluded(scene, lit):
    meshes, (light, other) = lit
    light.light_linking.blocker_collection = collection(meshes[1], meshes[2], state="EXCLUDE")
    other.light_linking.receiver_collection = collection()
    exported = export(scene)
    assert stopping(exported, 0) == [0] and shining_on(exported, 0) == [0, 1, 2]
    assert shining_on(exported, 1) == [0, 1, 2], "an empty collection includes all"


def test_the_last_word_counts(scene, lit):
    """Single objects after those of collections within."""
    meshes, (light, _) = lit
    within = collection(meshes[0], meshes[1])
    light.light_linking.receiver_collection = collection(meshes[1], state="EXCLUDE", child=within)
    assert shining_on(export(scene), 0) == [0]


def test_two_lights_with_collections_that_overlap(scene, lit):
    meshes, (light, other) = lit
    light.light_linking.receiver_collection = collection(meshes[0], meshes[1])
    other.light_linking.receiver_collection = collection(meshes[1], state="EXCLUDE")
    exported = export(scene)
    assert shining_on(exported, 0) == [0, 1] and shining_on(exported, 1) == [0, 2]


def test_emissive_meshes_and_what_is_multiplied(scene, lit):
    """Instances are linked as what multiplies them."""
    meshes, _ = lit
    meshes[0].light_linking.receiver_collection = collection(meshes[2])
    multiplied = bpy.data.collections.new("multiplied")
    multiplied.objects.link(meshes[1])
    meshes[2].light_linking.blocker_collection = collection(show_collection(scene, multiplied))
    exported = export(scene)
    assert exported.instances[0].linking.light_set_membership != ALL_SETS
    sets = [(instance.linking or LightLinking()).blocker_shadow_set for instance in exported.instances]
    assert sorted(sets) == [0, 0, 0, 1]


def test_more_sets_than_there_are(scene, lit):
    meshes, _ = lit
    for _ in range(65):
        add_light(scene, "POINT").light_linking.receiver_collection = collection(meshes[0])
    exported = export(scene)
    (text,) = exported.warnings
    assert text.startswith("Light Linking: more than 63")
    assert shining_on(exported, 5) == [0] and shining_on(exported, 66) == [0, 1, 2]


def test_a_viewport_follows_the_collections(scene, lit):
    meshes, (light, _) = lit
    sync, camera = SceneSync(), export(scene).camera

    def shown():
        scene.view_layers[0].update()
        return shining_on(sync.update(depsgraph(), camera), 0)

    assert shown() == [0, 1, 2]
    light.light_linking.receiver_collection = linked = collection(meshes[1])
    assert shown() == [1]
    linked.objects.link(meshes[2])
    assert shown() == [1, 2]
    linked.collection_objects[0].light_linking.link_state = "EXCLUDE"
    assert shown() == [2]


def test_cast_shadow(scene, lit):
    _, (light, _) = lit
    light.data.use_shadow = False
    assert [member.casts_shadow for member in export(scene).lights] == [False, True]


def test_max_bounces(scene, lit):
    _, (light, _) = lit
    light.data.cycles.max_bounces = 3
    scene.world = bpy.data.worlds.new("World")
    scene.world.cycles.max_bounces = 2
    exported = export(scene)
    assert [member.max_bounces for member in exported.lights] == [3, UNLIMITED_BOUNCES]
    assert exported.world.max_bounces == 2


def test_shadow_terminator(scene, lit):
    """Instances have the offsets of their objects; by default these are 0.1 for geometry and 0 for shading."""
    meshes, _ = lit
    meshes[1].shadow_terminator_geometry_offset, meshes[1].shadow_terminator_shading_offset = 0.25, 0.5
    offsets = [(one.terminator_geometry_offset, one.terminator_shading_offset) for one in export(scene).instances]
    assert offsets == [(pytest.approx(0.1), 0.0), (0.25, 0.5), (pytest.approx(0.1), 0.0)]


def test_rays_that_see_the_world(scene):
    scene.world = bpy.data.worlds.new("World")
    assert export(scene).world.visibility == RayVisibility.ALL
    scene.world.cycles_visibility.glossy = scene.world.cycles_visibility.camera = False
    assert export(scene).world.visibility == RayVisibility.ALL & ~RayVisibility.GLOSSY & ~RayVisibility.CAMERA

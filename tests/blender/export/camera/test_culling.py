# SPDX-License-Identifier: GPL-3.0-or-later
"""Culling of Simplify."""

import pytest
from blender_scenes import add_mesh, depsgraph, export
from node_trees import multiply_cubes

from rppm_addon.blender.export.updates.sync import SceneSync

PLACES = {"seen": (0.0, 0.0, -5.0), "far": (0.0, 0.0, -60.0), "beside": (30.0, 0.0, -5.0), "behind": (0.0, 0.0, 8.0)}


def set_of_cycles(block, **values):
    """As the window does: Python's own changes of what add-ons add are not told to depsgraphs."""
    for name, value in values.items():
        setattr(block.cycles, name, value)
    block.update_tag()


@pytest.fixture
def things(scene):
    """Meshes about a camera that looks down, which ask to be culled."""
    scene.camera.matrix_world.identity()
    for name, place in PLACES.items():
        made = add_mesh(scene, name, location=place)
        set_of_cycles(made, use_camera_cull=True, use_distance_cull=True)
    scene.render.use_simplify = True
    scene.view_layers[0].update()
    return scene


def shown(scene):
    return {instance.object_name for instance in export(scene).instances}


@pytest.mark.parametrize(
    ("by_camera", "by_distance", "left"),
    [
        (False, False, {"seen", "far", "beside", "behind"}),
        (True, False, {"seen", "far"}),
        (False, True, {"seen", "beside", "behind"}),
        (True, True, {"seen", "far", "beside", "behind"}),
    ],
)
def test_what_is_outside_or_far_is_left_out(things, by_camera, by_distance, left):
    """With both ways, only what both would leave out is left out, as in Cycles."""
    set_of_cycles(things, use_camera_cull=by_camera, use_distance_cull=by_distance)
    assert shown(things) == left


def test_objects_that_do_not_ask_stay(things):
    set_of_cycles(things, use_camera_cull=True)
    set_of_cycles(things.objects["behind"], use_camera_cull=False)
    assert shown(things) == {"seen", "far", "behind"}
    things.render.use_simplify = False
    assert len(shown(things)) == 4


def test_what_nodes_of_geometry_multiply_has_boxes_of_its_own(things):
    """Only one of the cubes beside the view is large enough to reach into it."""
    source = things.objects["seen"]
    multiply_cubes(source, [((x, 0.0, 0.0), size) for x, size in ((30.0, 1.0), (40.0, 1.0), (50.0, 99.0), (60.0, 1.0))])
    set_of_cycles(things, use_camera_cull=True)
    exported = export(things)
    places = [made.matrix[0, 3] for made in exported.instances if made.object_name == "seen"]
    assert sorted(places) == [0.0, 50.0]


def test_kept_scenes_follow_the_camera(things):
    set_of_cycles(things, use_camera_cull=True)
    things.view_layers[0].update()
    syncs = SceneSync(viewport=False), SceneSync()

    def names():
        camera = export(things).camera
        return [{made.object_name for made in sync.update(depsgraph(), camera).instances} for sync in syncs]

    assert names() == [{"seen", "far"}, set(PLACES)]
    things.camera.location.z = 40.0
    things.view_layers[0].update()
    assert names() == [{"seen", "far", "behind"}, set(PLACES)]
    things.objects["beside"].location.x = 0.0
    things.view_layers[0].update()
    assert names() == [set(PLACES), set(PLACES)]

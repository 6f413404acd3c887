# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are edited."""

import bpy
import pytest
from blender_scenes import CAMERA, add_light, add_object, depsgraph, following
from edits import add_box, in_object_mode
from node_trees import with_nodes

from rppm_addon.blender.export.updates.sync import SceneSync


@pytest.fixture
def edited(scene):
    """Two cubes of one mesh, another one, materials, a light and a world, which edits name."""
    cube = add_box("Cube")
    add_object(scene, "Twin", cube.data, location=(3.0, 0.0, 0.0))
    add_box("Other", 0.5).location = (0.0, 3.0, 0.0)
    for name in ("Red", "Blue"):
        with_nodes(bpy.data.materials.new(name))
    cube.data.materials.append(bpy.data.materials["Red"])
    add_light(scene, "POINT").location.z = 0.0
    scene.world = bpy.data.worlds.new("World")
    with_nodes(scene.world)
    bpy.context.view_layer.update()
    yield
    if bpy.context.mode != "OBJECT":
        in_object_mode()


@pytest.fixture
def synced(edited):
    """A SceneSync that is told of all updates."""
    sync = SceneSync()
    sync.update(depsgraph(), CAMERA)
    with following(lambda graph: sync.update(graph, CAMERA)):
        yield sync

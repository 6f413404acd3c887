# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of Blender far from the world's origin."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, export, set_world
from node_trees import geometry_nodes, surface


def glass_on_a_floor(scene) -> None:
    """A cube of glass on a floor below an area lamp, beside an instance of a cube.

    Matrices of Blender are of floats: places are multiples of 1/16 m, as these have them at 1,000 km.
    """
    glass, _ = surface("ShaderNodeBsdfGlass", Roughness=0.0)
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0.0, 0.0, 0.5625), rotation=(0.0, 0.0, 0.5))
    bpy.context.object.data.materials.append(glass)
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(1.0, 0.5, 0.25))
    geometry_nodes(bpy.context.object, "GeometryNodeGeometryToInstance")
    add_mesh(scene, "Floor", scale=(4.0, 4.0, 1.0))
    add_light(scene, "AREA", energy=200.0, size=1.0)
    set_world(scene, (0.1, 0.1, 0.1))
    scene.camera.location, scene.camera.rotation_euler = (0.0, -4.0, 3.0), (1.0, 0.0, 0.0)
    scene.rppm.samples, scene.rppm.photons, scene.rppm.cubemap_resolution = 4, 2048, 16


@pytest.mark.parametrize("way", [20_480.0, 999_936.0])
def test_a_scene_gives_the_same_picture_anywhere(scene, renderer, way):
    """Whole cells away (integrator/device_scene/centering.py) bit for bit."""
    glass_on_a_floor(scene)
    near = renderer.render(export(scene)).frame.combined
    for thing in scene.objects:
        thing.location.x += way
    far = renderer.render(export(scene)).frame.combined
    assert near[..., :3].mean() > 0.1
    np.testing.assert_array_equal(far, near)

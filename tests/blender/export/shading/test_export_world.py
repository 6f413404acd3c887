# SPDX-License-Identifier: GPL-3.0-or-later
"""The surroundings: a color or an image, seen in the direction that Cycles sees it in."""

import bpy
import numpy as np
import pytest
from blender_scenes import export, new_image, set_world
from cycles_light import cycles_radiance
from emission import HEIGHT, look_up, world_map
from mathutils import Euler, Vector
from node_trees import add_node, link


def test_no_world_and_no_output_are_black(scene):
    scene.world = None
    assert not world_map(export(scene)).any()
    set_world(scene).node_tree.nodes.clear()
    assert not world_map(export(scene)).any()


def test_background(scene):
    set_world(scene, (0.5, 1.0, 0.25), 3.0)
    np.testing.assert_allclose(world_map(export(scene))[0, 0], (1.5, 3.0, 0.75))


@pytest.mark.skipif(bpy.app.version >= (5, 0), reason="from 5.0 on a world always has nodes")
def test_world_without_nodes(scene):
    world = set_world(scene)
    world.use_nodes = False
    world.color = (0.25, 0.5, 0.75)
    np.testing.assert_allclose(export(scene).world.radiance, (0.25, 0.5, 0.75))


def environment(scene, pixels, strength=1.0):
    world = set_world(scene, strength=strength)
    tree = world.node_tree
    texture = add_node(tree, "ShaderNodeTexEnvironment", "Sky", image=new_image("Environment", pixels, is_float=True))
    link(tree, texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    return tree, texture


@pytest.mark.parametrize("vector_type", [None, "POINT", "TEXTURE", "VECTOR"])
def test_environment_looks_as_in_cycles(scene, tmp_path, vector_type):
    pixels = np.random.default_rng(7).random((4, 8, 4))
    pixels[..., 3] = 1.0
    tree, texture = environment(scene, pixels, 2.0)
    if vector_type is not None:
        place = add_node(tree, "ShaderNodeTexCoord").outputs["Generated"]
        mapping = add_node(tree, "ShaderNodeMapping", vector_type=vector_type, Rotation=(0.3, -0.5, 1.1), Vector=place)
        link(tree, mapping.outputs[0], texture.inputs["Vector"])
    texture.interpolation = "Closest"
    exported = export(scene)
    assert exported.warnings == []
    radiance = world_map(exported)
    scene.world.cycles.sampling_method = "NONE"  # a map of the world, which takes seconds, is of no use to what is seen
    for angles in ((0.4, 0.2, 0.1), (1.9, -0.3, 2.0), (2.6, 0.1, -1.2)):
        scene.camera.rotation_euler = angles
        direction = Euler(angles).to_matrix() @ Vector((0.0, 0.0, -1.0))
        expected = cycles_radiance(scene, tmp_path)
        np.testing.assert_allclose(look_up(radiance, direction), expected, rtol=1e-3, atol=1e-4)


def test_nodes_between_the_image_and_the_background(scene):
    tree, texture = environment(scene, np.full((2, 4, 4), 0.5), 2.0)
    gamma = add_node(tree, "ShaderNodeGamma", Gamma=2.0, Color=texture.outputs["Color"])
    link(tree, gamma.outputs[0], tree.nodes["Background"].inputs["Color"])
    exported = export(scene)
    assert exported.warnings == []
    np.testing.assert_allclose(world_map(exported)[0, 0], [0.5] * 3, rtol=1e-3)


def test_missing_environment(scene):
    tree, texture = environment(scene, np.full((2, 4, 4), 0.5))
    texture.image = None
    exported = export(scene)
    assert any('World "World": node "Sky"' in text for text in exported.warnings)
    np.testing.assert_allclose(world_map(exported)[0, 0], (1.0, 0.0, 1.0))


def test_sky_texture(scene):
    world = set_world(scene)
    sky = add_node(world.node_tree, "ShaderNodeTexSky", "Sky")
    link(world.node_tree, sky.outputs[0], world.node_tree.nodes["Background"].inputs["Color"])
    radiance = world_map(export(scene))
    assert np.isfinite(radiance).all() and (radiance[HEIGHT // 2 + 8 :] > 0.0).all()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture Limit of Simplify."""

import bpy
import numpy as np
from blender_scenes import add_mesh, depsgraph, export
from node_trees import add_node, surface

from rppm_addon.blender.export.images.texture_limit import limited
from rppm_addon.blender.export.updates.sync import SceneSync
from rppm_addon.scene import Image


def test_pixels_are_means_of_squares():
    pixels = np.arange(6 * 4 * 4, dtype=np.uint8).reshape(6, 4, 4)
    made = limited(Image("image", pixels, "SRGB"), 3)
    assert made.encoding == "SRGB" and made.pixels.dtype == np.uint8
    expected = np.floor(pixels.reshape(3, 2, 2, 2, 4).mean(axis=(1, 3)) + 0.5)
    np.testing.assert_array_equal(made.pixels, expected)


def test_what_fills_no_square_is_cut_off():
    pixels = np.random.default_rng(1).random((3, 130, 4), np.float32)
    made = limited(Image("image", pixels), 32)
    assert made.pixels.shape == (1, 16, 4)
    np.testing.assert_allclose(made.pixels[0], pixels[:, :128].reshape(3, 16, 8, 4).mean(axis=(0, 2)), rtol=1e-5)


def test_small_images_stay_as_they_are():
    image = Image("image", np.zeros((8, 8, 4), np.uint8), "SRGB")
    assert limited(image, 8) is image


def test_renders_and_viewports_have_limits_of_their_own(scene, material, tree):
    texture = add_node(tree, "ShaderNodeTexImage", image=bpy.data.images.new("image", 300, 300))
    surface("ShaderNodeEmission", material=material, Color=texture.outputs["Color"])
    add_mesh(scene, material=material)
    sync, camera = SceneSync(), export(scene).camera

    def sides():
        scene.view_layers[0].update()
        return [made.images[0].pixels.shape[0] for made in (export(scene), sync.update(depsgraph(), camera))]

    assert sides() == [300, 300]
    scene.cycles.texture_limit_render, scene.cycles.texture_limit = "256", "128"
    assert sides() == [300, 300]
    scene.render.use_simplify = True
    assert sides() == [150, 75]
    scene.render.use_simplify = False
    assert sides() == [300, 300]

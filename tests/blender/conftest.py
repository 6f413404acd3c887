# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module, with RPPM registered."""

import pytest

bpy = pytest.importorskip("bpy", reason="the tests of the Blender floor need the bpy wheel")


@pytest.fixture(scope="session", autouse=True)
def in_blender(registered):
    """All tests here need the registered extension."""


@pytest.fixture
def scene(registered):
    """An empty scene with a camera at (0, 0, 5) that looks down, RPPM as its engine, 32x32 pixels."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "RPPM"
    scene.render.resolution_x = scene.render.resolution_y = 32
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (0.0, 0.0, 5.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    return scene


@pytest.fixture(scope="module")
def renderer():
    from rppm_addon.session.renderer import Renderer

    with Renderer() as renderer:
        yield renderer

# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module, with RPPM registered once and taken out again before the process ends.

A RenderEngine that is still registered when Python exits crashes or hangs some Blender versions.
"""

import pytest

bpy = pytest.importorskip("bpy", reason="the tests of the Blender floor need the bpy wheel")

import rppm_addon  # noqa: E402


@pytest.fixture(scope="session", autouse=True)
def registered():
    rppm_addon.register()
    yield
    rppm_addon.unregister()


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

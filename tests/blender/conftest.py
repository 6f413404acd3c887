# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module, with RPPM registered."""

import time

import numpy as np
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


@pytest.fixture
def material(scene):
    """A material whose tree has an output node and nothing else; its name is Material."""
    from node_trees import new_material

    return new_material()


@pytest.fixture
def tree(material):
    """The node tree of the fixture ``material``."""
    return material.node_tree


@pytest.fixture
def timers(monkeypatch):
    """Functions that wait for their time; ``run_out`` calls each until it is done, as Blender's window does."""

    class Timers(list):
        def run_out(self):
            for function in self:
                while (wait := function()) is not None:
                    time.sleep(min(wait, 0.02))
            self.clear()

    waiting = Timers()
    monkeypatch.setattr(bpy.app.timers, "register", lambda function, **_: waiting.append(function))
    return waiting


@pytest.fixture
def process(scene, monkeypatch, tmp_path):
    """The renderer process, in the state that a test sets: it counts how often it is started anew, and is not."""
    from rppm_addon.blender.render_client import renderer_process
    from rppm_addon.session.client.client import ProcessState

    process = renderer_process.renderer_process()
    process.close()

    def restart(lists_devices=False):
        process.restarted, process.state, process.error = process.restarted + 1, ProcessState.STARTING, ""

    monkeypatch.setattr(process.launcher, "log_path", tmp_path / "renderer.log")
    values = {"state": ProcessState.STOPPED, "error": "", "device": None, "is_listing": False, "restarted": 0}
    for name, value in (values | {"restart": restart}).items():
        monkeypatch.setattr(process, name, value, raising=False)
    return process


@pytest.fixture
def lit(scene):
    """A white quad that fills the middle of the picture, under a sun: its radiance is 1 there."""
    from blender_scenes import add_light, add_mesh, set_world
    from node_trees import new_material, surface

    white, _ = surface("ShaderNodeBsdfDiffuse", material=new_material("White"), Color=(1.0, 1.0, 1.0, 1.0))
    add_mesh(scene, "Quad", material=white)
    add_light(scene, "SUN", energy=np.pi, angle=0.0)
    set_world(scene)
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 4.0  # the quad takes the middle half
    scene.rppm.samples, scene.rppm.photons, scene.rppm.cubemap_resolution = 2, 256, 16
    scene.rppm.filter_width = 0.0
    return scene


@pytest.fixture(scope="module")
def renderer():
    from rppm_addon.session.render.renderer import Renderer

    with Renderer() as renderer:
        yield renderer

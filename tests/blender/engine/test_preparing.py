# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs that are compiled while the solid view of a file is looked at."""

import itertools
import time
from types import SimpleNamespace

import bpy
import pytest
from blender_scenes import add_mesh, add_object, export
from node_trees import add_node, new_material, surface

from rppm_addon.blender.export.images import images
from rppm_addon.blender.render_client import renderer_process
from rppm_addon.session.client.client import ProcessState
from rppm_addon.session.placeholders.known_programs import programs_of

pytestmark = pytest.mark.usefixtures("timers")  # before a file is opened


@pytest.fixture
def prepared(monkeypatch):
    """Scenes that a process was to prepare for, as where Blender has a window."""
    scenes = []
    process = SimpleNamespace(state=ProcessState.STOPPED, prepare=scenes.append)
    monkeypatch.setattr(renderer_process, "is_used", lambda: True)
    monkeypatch.setattr(renderer_process, "renderer_process", lambda: process)
    return SimpleNamespace(scenes=scenes, process=process)


def add_picture():
    """A material with an image on the quad."""
    material = new_material("Picture")
    image = bpy.data.images.new("Picture", 4, 4)
    texture = add_node(material.node_tree, "ShaderNodeTexImage", image=image)
    surface("ShaderNodeBsdfPrincipled", material=material, Base_Color=texture.outputs["Color"])
    bpy.data.objects["Quad"].data.materials.append(material)


def test_the_programs_are_those_of_an_export_and_images_are_not_read(lit, prepared, timers, monkeypatch):
    add_picture()
    exported = export(lit)
    expected = {program for material in exported.materials for program in programs_of(material)}

    def read(*_):
        raise AssertionError("an image was read")

    monkeypatch.setattr(images, "read_pixels", read)
    timers.run_out()
    (scene,) = prepared.scenes
    assert {program for material in scene.materials for program in programs_of(material)} == expected
    assert (scene.settings.direct_light, scene.warnings) == (exported.settings.direct_light, [])


@pytest.mark.skipif(not hasattr(bpy.data, "colorspace"), reason="before Blender 5.0 all files have one working space")
def test_programs_are_of_the_working_space(lit, prepared, timers):
    bpy.ops.wm.set_working_color_space(working_space="ACEScg")
    timers.run_out()
    (scene,) = prepared.scenes
    assert scene.working_space == export(lit).working_space == "ACEScg"


def add_curves(scene):
    data = bpy.data.hair_curves.new("Curves")
    data.add_curves([2])
    data.attributes["position"].data.foreach_set("vector", [0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    return add_object(scene, "Curves", data)


def add_particle_hair(scene):
    source = add_mesh(scene, "Skin")
    source.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = source.particle_systems[0].settings
    settings.type, settings.count = "HAIR", 2
    return source


@pytest.mark.parametrize("add_strands", [add_curves, add_particle_hair])
def test_programs_of_strands_are_those_of_strands(lit, prepared, timers, add_strands):
    material, _ = surface("ShaderNodeBsdfHair", material=new_material("Hair"))
    add_strands(lit).data.materials.append(material)
    (expected,) = (made for made in export(lit).materials if made.name == material.name)
    timers.run_out()
    (found,) = (made for made in prepared.scenes[0].materials if made.name == material.name)
    assert found.on_round_shapes and programs_of(found) == programs_of(expected)


@pytest.mark.parametrize(("state", "engine"), [("RUNNING", "RPPM"), ("STOPPED", "BLENDER_WORKBENCH")])
def test_nothing_is_prepared_for_other_engines_or_beside_a_render(lit, prepared, timers, state, engine):
    prepared.process.state, lit.render.engine = ProcessState[state], engine
    timers.run_out()
    assert prepared.scenes == []


def test_another_file_begins_anew(lit, prepared, timers, monkeypatch):
    """Though the one before is half done."""
    add_picture()
    with monkeypatch.context() as patched:
        patched.setattr(time, "monotonic", itertools.count().__next__)  # there is time for a material
        assert timers[-1]() is not None
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.engine = "RPPM"
    timers.run_out()
    assert all(scene.materials == [] for scene in prepared.scenes) and prepared.scenes

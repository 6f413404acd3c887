# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs that are compiled while the solid view of a file is looked at."""

from types import SimpleNamespace

import bpy
import pytest
from blender_scenes import add_mesh, add_node, add_object, export, link, new_material, to_surface

from rppm_addon.blender.engine import preparing
from rppm_addon.blender.export.images import images
from rppm_addon.blender.render_client import renderer_process
from rppm_addon.session.client.client import ProcessState
from rppm_addon.session.placeholders.known_programs import programs_of


@pytest.fixture
def prepared(monkeypatch):
    """Scenes that a process was to prepare for, as where Blender has a window."""
    scenes = []
    process = SimpleNamespace(state=ProcessState.STOPPED, prepare=scenes.append)
    monkeypatch.setattr(renderer_process, "is_used", lambda: True)
    monkeypatch.setattr(renderer_process, "renderer_process", lambda: process)
    return SimpleNamespace(scenes=scenes, process=process)


def go_on():
    """Until there is no more to be done."""
    while preparing._go_on() is not None:
        pass


def add_picture():
    """A material with an image on the quad."""
    material = new_material("Picture")
    texture = add_node(material.node_tree, "ShaderNodeTexImage")
    texture.image = bpy.data.images.new("Picture", 4, 4)
    surface = add_node(material.node_tree, "ShaderNodeBsdfPrincipled")
    link(material.node_tree, texture.outputs["Color"], surface.inputs["Base Color"])
    to_surface(material, surface)
    bpy.data.objects["Quad"].data.materials.append(material)
    return material


def test_the_programs_are_those_of_an_export_and_images_are_not_read(lit, prepared, monkeypatch):
    add_picture()
    exported = export(lit)
    expected = {program for material in exported.materials for program in programs_of(material)}

    def read(*_):
        raise AssertionError("an image was read")

    monkeypatch.setattr(images, "read_pixels", read)
    monkeypatch.setattr(preparing, "_SLICE_SECONDS", 1e-9)  # a material at a time
    go_on()
    (scene,) = prepared.scenes
    assert {program for material in scene.materials for program in programs_of(material)} == expected
    assert (scene.settings.direct_light, scene.warnings) == (exported.settings.direct_light, [])


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
def test_programs_of_strands_are_those_of_strands(lit, prepared, add_strands):
    add_strands(lit).data.materials.append(material := new_material("Hair"))
    to_surface(material, add_node(material.node_tree, "ShaderNodeBsdfHair"))
    (expected,) = (made for made in export(lit).materials if made.name == material.name)
    go_on()
    (found,) = (made for made in prepared.scenes[0].materials if made.name == material.name)
    assert found.on_round_shapes and programs_of(found) == programs_of(expected)


def test_nothing_is_prepared_for_other_engines_or_beside_a_render(lit, prepared):
    prepared.process.state = ProcessState.RUNNING
    go_on()
    prepared.process.state = ProcessState.STOPPED
    lit.render.engine = "BLENDER_WORKBENCH"
    go_on()
    assert prepared.scenes == []


def test_another_file_begins_anew(lit, prepared):
    preparing._preparing = preparing._Preparing()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert preparing._preparing is None and bpy.app.timers.is_registered(preparing._go_on)
    preparing._stop()
    assert not bpy.app.timers.is_registered(preparing._go_on)

# SPDX-License-Identifier: GPL-3.0-or-later
"""View layers of a scene: overrides, samples, and collections that are masks."""

import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, collect, depsgraph, export, set_world, show_collection
from emission import world_map
from node_trees import new_material

from rppm_addon.blender.export import SceneSync, export_settings
from rppm_addon.blender.export.camera.camera import export_camera
from rppm_addon.scene import RayVisibility


@pytest.fixture
def masked(scene):
    """A quad in a collection of its own, one beside it, and a third that an empty of the collection multiplies."""
    inside, multiplied = (add_mesh(scene, name, material=new_material(name)) for name in ("Inside", "Multiplied"))
    add_mesh(scene, "Outside")
    source = collect(scene, multiplied)
    show_collection(scene, source, "Free")
    masks = collect(scene, inside, show_collection(scene, source, "Masked"), name="Masks")
    scene.collection.children.link(masks)
    return scene


@pytest.fixture
def followed(scene):
    """The scene that lives on from frame to frame, brought up to date."""
    sync = SceneSync(viewport=False)
    return lambda: sync.update(depsgraph(), export_camera(scene, depsgraph()))


def mask_of(scene):
    return scene.view_layers[0].layer_collection.children["Masks"]


def masks(exported):
    """By name, whether instances are seen by the camera, and whether they are holes."""
    return sorted((i.object_name, bool(i.visibility & RayVisibility.CAMERA), i.holdout) for i in exported.instances)


FREE = [("Inside", True, False), ("Multiplied", True, False), ("Multiplied", True, False), ("Outside", True, False)]


def test_collections_are_holes_or_unseen(masked):
    assert masks(export(masked)) == FREE
    mask_of(masked).holdout = True
    holes = [("Inside", True, True), ("Multiplied", True, False), ("Multiplied", True, True), ("Outside", True, False)]
    assert masks(export(masked)) == holes
    mask_of(masked).indirect_only = True  # a holdout first of all, as in Cycles
    assert masks(export(masked)) == holes
    mask_of(masked).holdout = False
    unseen = [("Inside", False, False), ("Multiplied", False, False), ("Multiplied", True, False),
              ("Outside", True, False)]  # fmt: skip
    exported = export(masked)
    assert masks(exported) == unseen
    assert all(instance.visibility & RayVisibility.DIFFUSE for instance in exported.instances)


def test_materials_and_world_are_overridden(masked):
    set_world(masked, (1.0, 1.0, 1.0))
    layer = masked.view_layers[0]
    assert len(export(masked).materials) > 1
    layer.material_override = new_material("Clay")
    exported = export(masked)
    assert [material.name for material in exported.materials] == ["Clay"]
    assert all(instance.materials == [0] for instance in exported.instances)
    if hasattr(layer, "world_override"):
        own, layer.world_override = masked.world, set_world(masked, (0.5, 0.25, 0.0))
        masked.world = own
        np.testing.assert_allclose(world_map(export(masked))[0, 0], (0.5, 0.25, 0.0))


def test_samples_of_a_layer(scene):
    scene.rppm.samples, layer = 50, scene.view_layers[0]
    assert export(scene).settings.iterations == 50
    layer.samples = 7
    assert export(scene).settings.iterations == 7
    layer.samples = 0
    assert export(scene).settings.iterations == 50


@pytest.mark.parametrize(("use", "few", "many"), [("USE", 7, 70), ("BOUNDED", 7, 50), ("IGNORE", 50, 50)])
def test_use_of_the_samples_of_layers(scene, use, few, many):
    """As Cycles counts them; the viewport has samples of its own."""
    scene.rppm.samples, scene.rppm.preview_samples, scene.rppm.use_layer_samples = 50, 9, use
    layer = scene.view_layers[0]
    for samples, expected in ((0, 50), (7, few), (70, many)):
        layer.samples = samples
        assert export_settings(scene, layer).iterations == expected
        assert export_settings(scene, layer, viewport=True).iterations == 9


def test_layers_are_denoised_one_by_one(scene):
    scene.rppm.use_denoising = scene.rppm.use_preview_denoising = True
    layer = scene.view_layers[0]
    layer.rppm.use_denoising = False
    assert export_settings(scene, scene.view_layers.new("Other")).use_denoising
    assert not export_settings(scene, layer).use_denoising and not export(scene).settings.denoising_features
    assert export_settings(scene, layer, viewport=True).use_denoising, "viewports are denoised all the same"


def test_a_scene_that_lives_on_follows_its_layer(masked, followed):
    """States of objects that a viewport or persistent data keep are not taken for the current ones."""
    layer = masked.view_layers[0]
    assert masks(followed()) == FREE
    mask_of(masked).holdout = True
    assert [holdout for *_, holdout in masks(followed())] == [True, False, True, False]
    mask_of(masked).holdout = False
    assert masks(followed()) == FREE
    layer.material_override = new_material("Clay")
    assert [material.name for material in followed().materials] == ["Clay"]
    layer.material_override = None
    assert len(followed().materials) > 1


def test_filters_leave_out_the_environment_and_surfaces(scene, followed):
    """As in Cycles: no light comes from what is left out; lamps remain, and the mist's settings."""
    add_mesh(scene, "Quad")
    add_light(scene, "POINT")
    world = set_world(scene, (1.0, 1.0, 1.0))
    world.mist_settings.start = 3.0
    layer = scene.view_layers[0]
    assert followed().world.graph is not None and len(followed().instances) == 1
    layer.use_sky = layer.use_solid = False
    for found in (followed(), export(scene)):
        assert found.world.graph is None and not found.world.radiance.any() and found.world.mist.start == 3.0
        assert not found.instances and len(found.lights) == 1
    layer.use_solid = True
    assert len(followed().instances) == 1

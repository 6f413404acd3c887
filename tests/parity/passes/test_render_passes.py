# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of the first surface beside Cycles' of the same name, pixel by pixel."""

import bpy
import numpy as np
import pytest

from rppm_addon.scene.passes import AMBIENT_OCCLUSION, CAUSTICS, FILM_PASSES, ROUGHNESS, SCATTERED_LIGHT, VOLUME_LIGHT

from ..engines import PIXEL_CENTERS, cycles_channels, cycles_pass, exported_scene, render_frame, stacked, unfilter
from ..net import material as net_material
from ..scenes import DIFFUSE, EMISSION, GLOSSY, ball, camera, light, material, new_scene, place, plane

OF_LIGHT = {CAUSTICS.name, AMBIENT_OCCLUSION.name, ROUGHNESS.name, *(entry.name for entry in VOLUME_LIGHT)}.union(
    *((entry.name, entry.divided_by) for entry in SCATTERED_LIGHT)
)
"""Passes that others of these tests compare."""
FIRST_SURFACE = tuple(entry for entry in FILM_PASSES if entry.name not in OF_LIGHT)
WORLD, MIRROR = 0.3, (0.9, 0.8, 0.7)


@pytest.fixture
def surfaces():
    """A plane that has a UV map, a ball that has none, a ball that shines, a mirror, and a gray world beyond them."""
    world = new_scene(world=WORLD).world
    world.mist_settings.start, world.mist_settings.depth, world.mist_settings.falloff = 2.0, 3.0, "QUADRATIC"
    floor = plane(1.5, material(DIFFUSE), place(at=(0.0, 0.0, -0.5)))
    layer = floor.data.uv_layers.new(name="Map")
    layer.uv.foreach_set("vector", [0.1, 0.2, 0.9, 0.3, 1.7, 2.0, -0.4, 0.8])
    round_one = ball(0.5, material(DIFFUSE), place())
    while round_one.data.uv_layers:
        round_one.data.uv_layers.remove(round_one.data.uv_layers[0])
    shining = ball(0.2, material(EMISSION, Color=(1.0, 0.5, 0.2), Strength=0.8), place(at=(0.8, -0.4, 0.4)))
    mirror = plane(0.6, material(GLOSSY, Color=MIRROR, Roughness=0.0), place(at=(-0.8, 0.6, 0.3)))
    mirror.rotation_euler = (1.3, 0.0, 0.3)
    for number, thing in enumerate((floor, round_one, shining, mirror)):
        thing.pass_index, thing.data.materials[0].pass_index = 3 + number, 40 + 7 * number
    light("POINT", 10.0, place(at=(0.0, 0.0, 3.0)))
    camera((0.3, -3.0, 1.2), (0.0, 0.0, 0.0))
    scene = bpy.context.scene
    for entry in FIRST_SURFACE:
        if entry.switch:
            setattr(scene.view_layers[0], entry.switch, True)
    scene.view_layers[0].cycles.denoising_store_passes = scene.view_layers[0].rppm.use_pass_denoising_data = True
    unfilter()
    return scene


def mirrored_world_once(expected: dict[str, np.ndarray]) -> list[np.ndarray]:
    """Cycles' albedo: of the light that it sees in mirrors, it counts the mirror's color twice."""
    planes = [expected[f"Denoising Albedo.{channel}"] for channel in "RGB"]
    twice = np.isclose(planes, WORLD * np.reshape(MIRROR, (3, 1, 1)) ** 2).all(axis=0)
    assert twice.sum() > 100
    return [np.where(twice, WORLD * color, plane) for color, plane in zip(MIRROR, planes, strict=True)]


def test_every_pass_of_blender_is_that_of_cycles(renderer, surfaces):
    expected = cycles_channels()
    scene = exported_scene()
    names = tuple(entry.name for entry in FIRST_SURFACE)
    assert {entry.name for entry in FIRST_SURFACE if entry.switch} <= set(scene.settings.passes)
    scene.settings = scene.settings.with_values(**PIXEL_CENTERS, passes=names)
    frame = renderer.render(scene).frame
    expected |= dict(zip(("Denoising Albedo." + c for c in "RGB"), mirrored_world_once(expected), strict=True))
    for entry in FIRST_SURFACE:
        if entry.name in {"Shadow Catcher", "Debug Sample Count"}:
            continue  # nothing to be seen here
        mine = np.atleast_3d(frame.passes[entry.name])
        theirs = np.stack([expected[layer] for layer in entry.layers], axis=-1)
        same = np.isclose(mine, theirs, rtol=2e-3, atol=2e-3).all(axis=-1)
        assert same.mean() > 0.98, f"{entry.name}: more than edges differ"
        assert theirs.std() > 0.0, f"{entry.name}: nothing is shown"


def test_aovs_are_those_of_cycles(renderer, surfaces):
    """AOVs of nodes and of sockets are compared; surfaces that are seen in the mirror do not count."""
    for thing in surfaces.objects:
        if thing.type != "MESH":
            continue
        tree = thing.data.materials[0].node_tree
        geometry, layers = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeLayerWeight")
        for name, socket in (("Place", geometry.outputs["Position"]), ("Facing", layers.outputs["Facing"])):
            aov = tree.nodes.new("ShaderNodeOutputAOV")
            aov.aov_name = name
            tree.links.new(socket, aov.inputs["Color" if name == "Place" else "Value"])
        fixed = tree.nodes.new("ShaderNodeOutputAOV")
        fixed.aov_name, fixed.inputs["Color"].default_value = "Tint", (0.1 * thing.pass_index, 0.5, 2.0, 1.0)
    layer = surfaces.view_layers[0]
    for name, kind in (("Place", "COLOR"), ("Facing", "VALUE"), ("Tint", "COLOR")):
        aov = layer.aovs.add()
        aov.name, aov.type = name, kind
    expected = cycles_channels()
    frame = render_frame(renderer, **PIXEL_CENTERS, passes=())
    assert list(frame.passes) == ["Place", "Facing", "Tint"]
    for name, letters in (("Place", "RGBA"), ("Facing", "X"), ("Tint", "RGBA")):
        theirs = stacked(expected, name, letters)
        same = np.isclose(np.atleast_3d(frame.passes[name]), theirs, rtol=2e-3, atol=2e-3).all(axis=-1)
        assert same.mean() > 0.98, f"{name}: more than edges differ"
        assert theirs.std() > 0.0


@pytest.mark.parametrize("threshold", [0.0, 0.2, 0.4])
def test_passes_show_what_is_less_transparent_than_the_threshold(renderer, threshold):
    """A card of an alpha of 0.3 stands before a wall."""
    new_scene(resolution=16)
    card, net = net_material("Card")
    net.output(net.out("MixShader", 0, {0: 0.3, 1: net.out("BsdfTransparent"), 2: net.emission((0.5, 0.4, 0.3))}))
    for number, (surface, away) in enumerate(((card, -1.0), (material(DIFFUSE), 1.0))):
        plane(3.0, surface, place(at=(0.0, away, 0.0), turn=(90.0, 0.0, 0.0))).pass_index = 3 + number
    camera((0.0, -5.0, 0.0), (0.0, 0.0, 0.0))
    layer = bpy.context.view_layer
    layer.pass_alpha_threshold, layer.use_pass_z, layer.use_pass_object_index = threshold, True, True
    layer.use_pass_vector = True
    unfilter()
    channels = cycles_channels()
    passes = render_frame(renderer, **PIXEL_CENTERS).passes
    np.testing.assert_allclose(passes["Depth"], channels["Depth.V" if "Depth.V" in channels else "Depth.Z"], rtol=1e-4)
    assert (passes["Object Index"] == (3.0 if threshold < 0.3 else 4.0)).all()


def test_shadows_on_catchers_are_those_of_cycles(renderer):
    """The ball is black, as light from other surfaces is left out."""
    scene = new_scene(resolution=32, world=0.0)
    plane(3.0, material(DIFFUSE)).is_shadow_catcher = True
    ball(0.5, material(DIFFUSE, Color=0.0), place(at=(0.0, 0.0, 0.6)))
    light("AREA", 60.0, place(at=(0.8, -1.0, 2.5), turn=(20.0, 15.0, 0.0)), shape="SQUARE", size=0.8)
    camera((0.0, -4.0, 2.2), (0.0, 0.0, 0.5))
    layer = scene.view_layers[0]
    layer.cycles.use_pass_shadow_catcher = layer.rppm.use_pass_shadow_catcher = True
    theirs = cycles_pass("Shadow Catcher", samples=128)
    mine = render_frame(renderer, iterations=128, photons=64).passes["Shadow Catcher"]
    blocks = [np.asarray(array).reshape(8, 4, 8, 4, 3).mean(axis=(1, 3)) for array in (mine, theirs)]
    assert blocks[1].min() < 0.5
    # Shares of up to 1 of 128 x 16 rays that are lit or not: 0.5 / sqrt(2048) of either, five times.
    np.testing.assert_allclose(*blocks, atol=5 * np.sqrt(2) * 0.5 / np.sqrt(2048), err_msg="shadows")
    assert mine.mean() == pytest.approx(theirs.mean(), rel=0.01)

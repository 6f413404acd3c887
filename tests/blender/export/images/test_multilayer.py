# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of multilayer EXR files as textures."""

import ctypes
import struct

import bpy
import numpy as np
import OpenEXR
import pytest
from blender_scenes import add_mesh, export
from node_trees import add_node, link, surface

from rppm_addon.blender.export.images.multilayer import PassSelection, read_pass, split_channel
from rppm_addon.scene.common.working_space import ACESCG

HEIGHT, WIDTH = 3, 5
PASSES = {
    "View.Glass Albedo": "RGB",
    "View.Combined": "RGBA",
    "View.Normal": "XYZ",
    "View.Depth": "Z",
    "View.Vector": "XYZW",
    "View.UV": "UVA",
    "View.Emission": "RGB",
    "View.Ambient Occlusion": "RGB",
    "View.Object Index": "X",
    "View.Diffuse Color": "RGB",
    "View.Added": "X",
    "Back.Combined": "RGBA",
}
HEADER = {
    "compression": OpenEXR.ZIP_COMPRESSION,
    "type": OpenEXR.scanlineimage,
    "BlenderMultiChannel": "Blender V2.55.1 and newer",
}


def planes_of(name: str) -> dict[str, np.ndarray]:
    """Planes of random numbers from 0 to 1, the top row first, by the channels of a pass."""
    numbers = np.random.default_rng(list(name.encode()))
    return {f"{name}.{letter}": numbers.random((HEIGHT, WIDTH), np.float32) for letter in PASSES[name]}


def pixels_of(name: str) -> np.ndarray:
    """(height, width, channels) in the order of the pass's letters, row 0 at the bottom."""
    return np.stack(list(planes_of(name).values()), axis=-1)[::-1]


@pytest.fixture(params=[False, True], ids=["one part", "parts"])
def path(request, tmp_path):
    path = str(tmp_path / "layers.exr")
    if request.param:
        parts = [OpenEXR.Part(dict(HEADER), planes_of(name), name) for name in PASSES]
        OpenEXR.File(parts).write(path)
    else:
        planes = {channel: plane for name in PASSES for channel, plane in planes_of(name).items()}
        OpenEXR.File(dict(HEADER), planes).write(path)
    return path


def layers_of_blender(image) -> dict[str, list[str]]:
    """By layer, the names of its passes, both in Blender's order."""
    assert image.size[:] == (0, 0) and image.type == "MULTILAYER"
    tree = bpy.data.node_groups.new("Order", "CompositorNodeTree")
    node = tree.nodes.new("CompositorNodeImage")
    node.image = image
    names = {}
    for layer in (node.layer, "Back" if node.layer == "View" else "View"):
        node.layer = layer
        names[layer] = [output.name for output in node.outputs if output.name != "Alpha"]
    return names


def test_passes_are_numbered_as_in_blender(path):
    found = layers_of_blender(bpy.data.images.load(path))
    for layer, (name, passes) in enumerate(found.items()):
        for number, pass_name in enumerate(passes):
            pixels = read_pass(path, PassSelection(layer, number))
            np.testing.assert_array_equal(pixels, pixels_of(f"{name}.{pass_name}"), pass_name)
        assert read_pass(path, PassSelection(layer, len(passes))) is None
    assert len(found) == 2 and read_pass(path, PassSelection(2)) is None


def select(user, selection):
    """Have an image user select a pass, as its menus do: Python has no way to."""
    user.frame_duration, user.frame_offset, user.frame_start = 7301, 7302, 7303
    text = ctypes.string_at(user.as_pointer(), 64)
    start = text.index(struct.pack("iii", 7301, 7302, 7303))
    ctypes.c_short.from_address(user.as_pointer() + start + 14).value = selection.number
    ctypes.c_short.from_address(user.as_pointer() + start + 24).value = selection.layer
    assert (user.multilayer_layer, user.multilayer_pass) == (selection.layer, selection.number)


@pytest.mark.parametrize("packed", [False, True])
def test_textures_show_what_their_users_select(scene, path, packed):
    image = bpy.data.images.load(path)
    if packed:
        image.pack()
    names = list(layers_of_blender(image).items())
    layer = next(number for number, (name, _) in enumerate(names) if name == "View")
    number = names[layer][1].index("Normal")
    material, emission = surface("ShaderNodeEmission")
    tree = material.node_tree
    colors = add_node(tree, "ShaderNodeTexImage", image=image)
    normals = add_node(tree, "ShaderNodeTexImage", image=image)
    select(colors.image_user, PassSelection(layer, names[layer][1].index("Combined")))
    select(normals.image_user, PassSelection(layer, number))
    link(tree, colors.outputs["Color"], emission.inputs["Color"])
    link(tree, normals.outputs["Color"], emission.inputs["Strength"])
    add_mesh(scene, material=material)
    exported = export(scene)
    assert exported.warnings == [] and len(exported.images) == 2
    found = [image.pixels for image in exported.images]
    for expected in (pixels_of("View.Combined"), pixels_of("View.Normal")):
        assert any(np.array_equal(pixels[..., : expected.shape[-1]], expected) for pixels in found)


@pytest.mark.skipif(not hasattr(bpy.data, "colorspace"), reason="before Blender 5.0 all files have one working space")
@pytest.mark.parametrize("space", ["Linear Rec.709", "ACEScg", "Non-Color"])
def test_passes_are_of_the_working_space(scene, path, space):
    """As in Cycles, colors of another linear space are converted."""
    bpy.ops.wm.set_working_color_space(working_space="ACEScg")
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = space
    layer = list(layers_of_blender(image)).index("View")
    material, emission = surface("ShaderNodeEmission")
    texture = add_node(material.node_tree, "ShaderNodeTexImage", image=image)
    select(texture.image_user, PassSelection(layer, 0))
    link(material.node_tree, texture.outputs["Color"], emission.inputs["Color"])
    add_mesh(scene, material=material)
    (exported,) = export(scene).images
    colors = pixels_of("View.Combined")[..., :3]
    expected = ACESCG.from_rec709(colors) if space == "Linear Rec.709" else colors
    np.testing.assert_allclose(exported.pixels[..., :3], expected, atol=1e-5)


@pytest.mark.parametrize(
    ("channel", "expected"),
    [
        ("R", ("", "Combined", "R")),
        ("Z", ("", "Depth", "Z")),
        ("Depth.Z", ("", "Depth", "Z")),
        ("ViewLayer.Depth.Z", ("ViewLayer", "Depth", "Z")),
        ("a.b.Normal.NX", ("a.b", "Normal", "X")),
        ("beauty.red", ("", "beauty", "R")),
    ],
)
def test_names_of_channels(channel, expected):
    assert split_channel(channel) == expected

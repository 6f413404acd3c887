# SPDX-License-Identifier: GPL-3.0-or-later
"""F12 with a compositor in which every pass is linked, and nodes that take them."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, set_world
from exr import read_layers, write_exr
from node_trees import add_node, new_material, surface

from rppm_addon.scene.cryptomatte import identifiers_of
from rppm_addon.scene.passes import NOISY_IMAGE, PASSES

pytestmark = pytest.mark.skipif(bpy.app.version < (5, 0), reason="compositors are node groups since Blender 5.0")

SIZE = 48
TYPES = {"VALUE": "FLOAT", "RGBA": "RGBA", "VECTOR": "VECTOR"}
"""Type of a socket of the File Output node, by the kind of its values."""
NAMES = {"Image": "Combined"}
"""Pass of each socket that is named otherwise than its pass, by the socket's name."""
EVEN = {"Transmission Direct", "Volume Direct", "Volume Indirect", "Debug Sample Count"} | {
    f"Crypto{kind}{level:02d}" for kind in ("Object", "Material", "Asset") for level in (1, 2)
}
"""Passes that are the same all over this picture: no light comes straight through the pane, there are no volumes,
pixels have all samples, and nowhere are there more than two objects."""


@pytest.fixture
def stage(lit):
    """A quad with AOVs under a mirror that sends the sun there, a glowing quad that moves, one of rough glass, one that
    catches shadows, and a gray world; all passes are on."""
    lit.render.resolution_x = lit.render.resolution_y = SIZE
    set_world(lit, (0.2, 0.2, 0.2))
    materials = {
        "Glow": ("ShaderNodeEmission", {"Color": (0.2, 0.6, 1.0, 1.0)}),
        "Mirror": ("ShaderNodeBsdfAnisotropic", {"Color": (0.9, 0.8, 0.7, 1.0), "Roughness": 0.05}),
        "Pane": ("ShaderNodeBsdfRefraction", {"Color": (0.6, 0.9, 0.7, 1.0), "Roughness": 0.4}),
        "Catcher": ("ShaderNodeBsdfDiffuse", {"Color": (0.5, 0.5, 0.5, 1.0)}),
    }
    places = {
        "Glow": ((-0.6, 0.6, 0.5), (0.0, 0.0, 0.0), 0.2),
        "Mirror": ((0.7, 0.0, 0.7), (0.0, -0.9, 0.0), 0.4),
        "Pane": ((-0.5, -0.5, 0.5), (0.0, 0.0, 0.0), 0.3),
        "Catcher": ((0.0, -1.5, 0.0), (0.0, 0.0, 0.0), 0.4),
    }
    for number, (name, (kind, inputs)) in enumerate(materials.items()):
        material, _ = surface(kind, material=new_material(name), **inputs)
        material.pass_index = 10 + number
        location, rotation, scale = places[name]
        place = {"location": location, "rotation_euler": rotation, "scale": (scale,) * 3}
        shown = add_mesh(lit, name, material=material, pass_index=number + 1, **place)
        shown.data.uv_layers.new(name="UVMap")
    lit.objects["Catcher"].is_shadow_catcher = True
    for frame in (0, 2):
        lit.objects["Glow"].location.x = -0.7 + 0.1 * frame
        lit.objects["Glow"].keyframe_insert("location", frame=frame)
    tree = lit.objects["Quad"].data.materials[0].node_tree
    add_node(tree, "ShaderNodeOutputAOV", Value=0.25).aov_name = "Mask"
    add_node(tree, "ShaderNodeOutputAOV", Color=(0.1, 0.2, 0.3, 1.0)).aov_name = "Tint"
    turn_all_on(lit.view_layers[0])
    lit.rppm.samples, lit.rppm.photons, lit.rppm.use_denoising = 4, 4096, True
    return lit


def turn_all_on(layer):
    for entry in PASSES:
        owner, name = (layer, entry.switch) if entry.switch else (layer.rppm, entry.own_switch)
        setattr(owner, name, True)
    for name, kind in (("Mask", "VALUE"), ("Tint", "COLOR")):
        aov = layer.aovs.add()
        aov.name, aov.type = name, kind


def compositor(scene, folder):
    """A tree that writes all that the Render Layers node has, and what other nodes make of it, to a file."""
    tree = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
    scene.compositing_node_group = tree
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    layers, file = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeOutputFile")
    layers.scene = scene
    file.directory, file.file_name, file.format.color_depth = str(folder), "written", "32"
    sockets = {socket.name: socket for socket in layers.outputs if socket.enabled and not socket.is_unavailable}

    def write(name, socket):
        file.file_output_items.new(TYPES[socket.type], name)
        tree.links.new(socket, file.inputs[name])

    for name, socket in sockets.items():
        write(NAMES.get(name, name), socket)
    denoise = tree.nodes.new("CompositorNodeDenoise")
    for name, socket in (("Image", NOISY_IMAGE.name), ("Albedo", "Denoising Albedo"), ("Normal", "Denoising Normal")):
        tree.links.new(sockets[socket], denoise.inputs[name])
    write("Denoised", denoise.outputs[0])
    matte = tree.nodes.new("CompositorNodeCryptomatteV2")
    matte.source, matte.scene, matte.layer_name = "RENDER", scene, "ViewLayer.CryptoObject"
    matte.matte_id = "Glow"
    write("Matte", matte.outputs["Matte"])
    add = tree.nodes.new("ShaderNodeMix")
    add.data_type, add.blend_type = "RGBA", "ADD"
    inputs = {socket.identifier: socket for socket in add.inputs}
    inputs["Factor_Float"].default_value = 1.0
    tree.links.new(sockets[NOISY_IMAGE.name], inputs["A_Color"])
    tree.links.new(sockets["Caustics"], inputs["B_Color"])
    added = next(socket for socket in add.outputs if socket.identifier == "Result_Color")
    write("Added", added)
    tree.links.new(added, tree.nodes.new("NodeGroupOutput").inputs[0])
    return set(sockets)


def planes(path):
    """By layer, (SIZE, SIZE, channels), the channels in the order of their letters in Blender."""
    return {layer.removeprefix("ViewLayer."): values for layer, values in read_layers(path).items()}


def test_every_pass_arrives_in_the_compositor(stage, tmp_path):
    sockets = compositor(stage, tmp_path)
    expected = {entry.name for entry in PASSES if entry.accumulation.name != "COVERAGE"} | {NOISY_IMAGE.name}
    assert expected <= sockets | {"Image"}, expected - sockets
    stage.render.use_compositing = True
    write_exr(stage, tmp_path / "picture.exr")
    bpy.ops.render.render(write_still=True)
    written, rendered = planes(next(tmp_path.glob("written*.exr"))), planes(tmp_path / "picture.exr")
    for name, picture in rendered.items():
        if name == "Composite.Combined":
            continue
        shared = min(picture.shape[-1], written[name].shape[-1])
        same = written[name][..., :shared].view(np.uint32) == picture[..., :shared].view(np.uint32)
        assert same.all(), f"{name} is another in the compositor"  # identifiers of Cryptomatte are no numbers
        assert name in EVEN or np.ptp(picture, axis=(0, 1)).any(), f"{name} shows nothing"
    noisy, caustics = written[NOISY_IMAGE.name][..., :3], written["Caustics"][..., :3]
    np.testing.assert_allclose(written["Added"][..., :3], noisy + caustics, rtol=1e-6)
    np.testing.assert_array_equal(rendered["Composite.Combined"][..., :3], written["Added"][..., :3])
    # Blender's node denoises as RPPM does by default, with the same library.
    np.testing.assert_allclose(written["Denoised"][..., :3], written["Combined"][..., :3], rtol=1e-3, atol=1e-3)
    assert (written["Denoised"][..., :3] != noisy).mean() > 0.5
    (glow,) = identifiers_of(["Glow"])
    matte = np.zeros((SIZE, SIZE), np.float32)
    for level in range(3):
        pairs = rendered[f"CryptoObject{level:02d}"]
        for first in (0, 2):
            matte += np.where(pairs[..., first].copy().view(np.uint32) == glow, pairs[..., first + 1], 0.0)
    np.testing.assert_array_equal(written["Matte"][..., 0], matte)
    assert 0 < np.count_nonzero(matte) < 64

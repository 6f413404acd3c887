# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte and AOVs as Blender keeps them: in its files, and in its compositor."""

import json

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, export
from exr import read_channels, write_exr
from node_trees import add_node, node_group

from rppm_addon.scene.cryptomatte import hash_of, identifiers_of

LAYER = "ViewLayer.CryptoObject"


@pytest.fixture
def quads(lit):
    """The quad of ``lit`` and a small one without a material before it, which belongs to it; passes of objects and
    assets are on."""
    small = add_mesh(lit, "Small", location=(0.5, 0.0, 1.0), scale=(0.2, 0.2, 1.0))
    small.parent = bpy.data.objects["Quad"]
    layer = lit.view_layers[0]
    layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_asset = True
    layer.pass_cryptomatte_depth = 4
    return lit


def render(scene: bpy.types.Scene, path, is_multilayer=True):
    """Pixels by the channel's name, and the header of the file."""
    write_exr(scene, path / "picture.exr", is_multilayer)
    bpy.ops.render.render(write_still=True)
    return read_channels(path / "picture.exr")


def test_names_and_shares_are_in_the_file(quads, tmp_path):
    channels, header = render(quads, tmp_path)
    assert sorted({name.rpartition(".")[0] for name in channels if "Crypto" in name}) == [
        f"ViewLayer.Crypto{layer}{part:02d}" for layer in ("Asset", "Object") for part in range(2)
    ]
    key = f"cryptomatte/{hash_of(LAYER):08x}"[:19]
    assert header[f"{key}/name"] == LAYER
    manifest = json.loads(header[f"{key}/manifest"])
    assert manifest == {name: f"{hash_of(name):08x}" for name in ("Quad", "Small")}
    small, quad = identifiers_of(["Small", "Quad"])
    pixel = 15, 20  # of the small one
    assert channels[f"{LAYER}00.r"][pixel].view(np.uint32) == small and channels[f"{LAYER}00.g"][pixel] == 1.0
    assert channels["ViewLayer.CryptoAsset00.r"][pixel].view(np.uint32) == quad
    # What else Blender's own files tell.
    assert header["Frame"] == "001" and header["Camera"] == "Camera"
    assert header["rppm.ViewLayer.samples"] == "2" and header["rppm.ViewLayer.device"]


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="compositors are node groups since Blender 5.0")
def test_the_compositor_picks_by_name(quads, tmp_path):
    tree, _, output = node_group(outputs=[("Image", "Color")], tree_type="CompositorNodeTree")
    quads.compositing_node_group = tree
    matte = add_node(
        tree, "CompositorNodeCryptomatteV2", source="RENDER", scene=quads, layer_name=LAYER, matte_id="Quad"
    )
    tree.links.new(matte.outputs["Matte"], output.inputs[0])
    picked = render(quads, tmp_path, False)[0]["R"]
    assert picked[16, 12] == 1.0  # the quad
    assert picked[15, 20] == 0.0  # the small one before it
    assert picked[2, 2] == 0.0  # nothing


def test_assets_are_exported_where_they_are_asked_for(quads):
    assert export(quads).asset_names == {"Small": "Quad"}
    quads.view_layers[0].use_pass_cryptomatte_asset = False
    assert export(quads).asset_names == {}


def test_aov_outputs_of_a_material(quads, tmp_path):
    """In groups as well; those in muted groups and those without a name write nothing."""
    material = bpy.data.objects["Quad"].data.materials[0]
    group, _, _ = node_group()
    for tree, name, value in ((material.node_tree, "Mask", 0.25), (group, "Mask", 0.5), (group, "", 8.0)):
        add_node(tree, "ShaderNodeOutputAOV", aov_name=name, Value=value, Color=(value, 0.0, 1.0, 1.0))
    for mute in (False, True):
        add_node(material.node_tree, "ShaderNodeGroup", node_tree=group, mute=mute)
    layer = quads.view_layers[0]
    for name, kind in (("Mask", "VALUE"), ("Tint", "COLOR"), ("Depth", "VALUE")):
        aov = layer.aovs.add()
        aov.name, aov.type = name, kind
    layer.use_pass_z = True
    scene = export(quads)
    assert scene.settings.aovs == ("Mask.X", "Tint.RGBA")
    channels, _ = render(quads, tmp_path)
    assert channels["ViewLayer.Mask.X"][16, 12] == 0.75 and channels["ViewLayer.Mask.X"][2, 2] == 0.0
    assert not channels["ViewLayer.Tint.R"].any()
    assert channels["ViewLayer.Depth.Z"][16, 12] == pytest.approx(5.0)

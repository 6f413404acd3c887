# SPDX-License-Identifier: GPL-3.0-or-later
"""The compositor and the sequencer of files that the program renders."""

import numpy as np
import pytest
from cli.conftest import run_in_blender, succeed

from rppm_addon.pictures import read_exr

_MAKE = """
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
scene = bpy.context.scene
if hasattr(scene, "compositing_node_group"):
    tree = scene.compositing_node_group = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    output = tree.nodes.new("NodeGroupOutput").inputs[0]
else:
    scene.use_nodes, tree = True, scene.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("CompositorNodeComposite").inputs["Image"]
layers = tree.nodes.new("CompositorNodeRLayers")
tree.links.new(layers.outputs["Image"], output)
if sys.argv[3] == "with":
    invert = tree.nodes.new("CompositorNodeInvert")
    tree.links.new(layers.outputs["Image"], invert.inputs["Color"])
    tree.links.new(invert.outputs[0], output)
    editor = scene.sequence_editor_create()
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences
    color = strips.new_effect("Color", "COLOR", 1, 1, **(
        {"length": 9} if bpy.app.version >= (5, 0) else {"frame_end": 9}
    ))
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[2])
"""


@pytest.mark.parametrize("which", ["with", "without"])
def test_what_is_not_run_is_named(tmp_path, rppm, blend_files, which):
    """A compositor that hands the picture on changes nothing and is not named; pictures are those of the scene."""
    blend, exr, plain = tmp_path / "post.blend", tmp_path / "post.exr", tmp_path / "plain.exr"
    run_in_blender(_MAKE, blend_files[0], blend, which)
    _, errors = succeed(rppm, "render", blend, "-o", exr)
    named = [title for title in ("Compositing: the compositor", "Sequencer: the strips") if title in errors]
    assert len(named) == (2 if which == "with" else 0), errors
    succeed(rppm, "render", blend_files[0], "-o", plain)
    np.testing.assert_array_equal(read_exr(exr).combined, read_exr(plain).combined)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The compositor and the sequencer, which Blender would run on a finished render and the program does not."""

import logging
from typing import Any

logger = logging.getLogger(__name__)

_WITHOUT_EFFECT = {
    "CompositorNodeComposite", "CompositorNodeRLayers", "CompositorNodeViewer", "NodeFrame", "NodeGroupInput",
    "NodeGroupOutput", "NodeReroute",
}  # fmt: skip
"""Compositor nodes that hand a picture on as it is."""


def leave_post_processing_out(scene: Any, warn: bool) -> None:
    """Have Blender leave its result as the engine gives it; warn: say so where the file would have it changed.

    A compositor may write files of its own, and both hide the render.
    """
    render = scene.render
    if warn and render.use_compositing and _has_effect(_compositor_of(scene)):
        logger.warning(
            'Compositing: the compositor of scene "%s" is not run; pictures are as its view layers give them, with the '
            "passes that it needs in the EXR. Render with blender -b to have it run",
            scene.name,
        )
    if warn and render.use_sequencer and _has_strips(scene):
        logger.warning(
            'Sequencer: the strips of scene "%s" are not rendered; pictures are of the scene itself. Render with '
            "blender -b to have them rendered",
            scene.name,
        )
    render.use_compositing = render.use_sequencer = False


def _compositor_of(scene: Any) -> Any:
    """The node tree of a scene's compositor; None where there is none."""
    if hasattr(scene, "compositing_node_group"):  # Blender 5.0 and later
        return scene.compositing_node_group
    return scene.node_tree if scene.use_nodes else None


def _has_effect(tree: Any) -> bool:
    return tree is not None and any(not node.mute and node.bl_idname not in _WITHOUT_EFFECT for node in tree.nodes)


def _has_strips(scene: Any) -> bool:
    editor = scene.sequence_editor
    return editor is not None and len(editor.strips if hasattr(editor, "strips") else editor.sequences) > 0

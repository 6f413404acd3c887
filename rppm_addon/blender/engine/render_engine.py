# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine that Blender lists as RPPM."""

import bpy

from ...scene.passes import COMBINED, NOISY_IMAGE, aov_passes, light_group_passes
from ..export.view_layer.passes import aovs_of_layer, light_groups_of_layer, passes_of_layer
from ..export.view_layer.settings import is_denoised
from . import open_viewports
from .baking import bake
from .final import render_final


class RppmRenderEngine(bpy.types.RenderEngine):
    """Hands on what Blender asks of an engine."""

    bl_idname = "RPPM"
    bl_label = "RPPM"
    bl_use_preview = True
    bl_use_eevee_viewport = True  # Material Preview is drawn by EEVEE
    bl_use_shading_nodes_custom = False  # Cycles' nodes are ours
    bl_use_postprocess = True
    bl_use_gpu_context = False

    def __init__(self, *args: object, **kwargs: object) -> None:
        # Blender calls this twice on one object: nothing may be started here.
        super().__init__(*args, **kwargs)

    def update_render_passes(self, scene: bpy.types.Scene, renderlayer: bpy.types.ViewLayer) -> None:
        """Tell Blender of the passes that a render will have."""
        self.register_pass(scene, renderlayer, COMBINED, 4, "RGBA", "COLOR")
        noisy = (NOISY_IMAGE,) if scene.rppm.use_denoising and is_denoised(renderlayer) else ()
        aovs = aov_passes(aovs_of_layer(renderlayer))
        groups = light_group_passes(light_groups_of_layer(renderlayer))
        for entry in (*noisy, *passes_of_layer(renderlayer), *aovs, *groups):
            self.register_pass(scene, renderlayer, entry.name, len(entry.channels), entry.channels, entry.kind.value)

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Render a view layer to its end: F12, and previews of materials."""
        render_final(self, depsgraph)

    def bake(
        self,
        depsgraph: bpy.types.Depsgraph,
        obj: bpy.types.Object,
        pass_type: str,
        pass_filter: int,
        width: int,
        height: int,
    ) -> None:
        """Bake what of a texture is on an object."""
        bake(self, depsgraph, obj, pass_type, pass_filter, width, height)

    def view_update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Something in the scene has changed. A viewport that is switched to Rendered lifts Pause, as in Cycles."""
        if context.scene.rppm.preview_pause and not open_viewports.is_open(self):
            context.scene.rppm.preview_pause = False
        open_viewports.of_engine(self).update(context, depsgraph)

    def view_draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Draw the newest picture into the viewport."""
        open_viewports.of_engine(self).draw(context, depsgraph)


def register() -> None:
    """Add the engine."""
    bpy.utils.register_class(RppmRenderEngine)
    open_viewports.register()


def unregister() -> None:
    """Take out the engine."""
    open_viewports.unregister()
    bpy.utils.unregister_class(RppmRenderEngine)

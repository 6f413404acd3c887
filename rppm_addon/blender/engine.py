# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine that Blender lists as RPPM."""

import contextlib

import bpy

from . import viewport
from .final import DEEP_CUBEMAP_PASS, render_final


class RppmRenderEngine(bpy.types.RenderEngine):
    bl_idname = "RPPM"
    bl_label = "RPPM"
    bl_use_preview = True
    bl_use_eevee_viewport = True  # Material Preview is drawn by EEVEE
    bl_use_shading_nodes_custom = False  # Cycles' nodes are ours
    bl_use_postprocess = True
    bl_use_gpu_context = False

    def __init__(self, *args, **kwargs):
        # Blender calls this twice on one object: nothing may be started here.
        super().__init__(*args, **kwargs)

    def update_render_passes(self, scene: bpy.types.Scene, renderlayer: bpy.types.ViewLayer) -> None:
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        if renderlayer.use_pass_z:
            self.register_pass(scene, renderlayer, "Depth", 1, "Z", "VALUE")
        if renderlayer.use_pass_normal:
            self.register_pass(scene, renderlayer, "Normal", 3, "XYZ", "VECTOR")
        if scene.rppm.deep_cubemap_pass:
            self.register_pass(scene, renderlayer, DEEP_CUBEMAP_PASS, 3, "XYZ", "VECTOR")

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        render_final(self, depsgraph)

    def view_update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        viewport.of_engine(self).update(context, depsgraph)

    def view_draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        viewport.of_engine(self).draw(context, depsgraph)

    def __del__(self) -> None:
        # Blender may have freed what the object stands for.
        with contextlib.suppress(ReferenceError):
            viewport.close(self.as_pointer())


def register() -> None:
    bpy.utils.register_class(RppmRenderEngine)


def unregister() -> None:
    viewport.close_all()
    bpy.utils.unregister_class(RppmRenderEngine)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene that the parts of an export make together."""

import bpy

from ....scene import Light, Scene
from ..context import ExportContext
from ..images.color_spaces import working_space
from ..instances.objects import ObjectExporter
from ..instances.placements import Placed
from ..view_layer.assets import export_asset_names
from ..view_layer.settings import export_cubemap_center, export_dicing_view, export_exposure


def fill_scene(
    scene: Scene,
    depsgraph: bpy.types.Depsgraph,
    context: ExportContext,
    objects: ObjectExporter,
    placed: Placed,
    suns: list[Light],
) -> None:
    """Give a scene that has its camera, settings and world all else. suns: lights of the world."""
    source = depsgraph.scene_eval
    scene.meshes = list(objects.meshes.meshes)
    scene.instances = list(placed.instances)
    scene.instance_arrays = list(placed.arrays)
    scene.materials = list(objects.materials.materials)
    scene.lights = [*placed.lights, *suns]
    scene.images = list(context.images.images)
    scene.exposure = export_exposure(source)
    scene.pass_alpha_threshold = depsgraph.view_layer_eval.pass_alpha_threshold
    scene.working_space = working_space().name
    scene.dicing_view = export_dicing_view(depsgraph, context.viewport)
    scene.cubemap_center = export_cubemap_center(depsgraph)
    scene.asset_names = export_asset_names(depsgraph, scene.settings)
    scene.warnings = context.report.warnings

# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's evaluated scene to a Scene."""

from collections.abc import Callable

import bpy

from ...scene import Scene
from ...scene.common.garbage import collector_paused
from ...scene.errors import SceneError
from ...session.render.bake_passes import BakePass
from .camera.camera import export_camera
from .camera.culling import Culling
from .camera.eyes import Eye, views_of
from .camera.view import export_view
from .common.report import ExportStopped, Report
from .common.slices import ExportProgress
from .context import ExportContext
from .geometry.volumes.velocities import VelocityBlur
from .instances.objects import ObjectExporter
from .omissions import OmissionList, objects_of
from .shading.lights.world import export_world
from .updates.assembly import fill_scene
from .updates.baking import BakePixels, bake_settings, camera_beside, look_at_texels, seen_from
from .updates.frames import FrameExporter
from .updates.libraries import warn_of_missing
from .updates.motion import MotionExporter, is_blurred, wants_neighbors
from .updates.stamps import export_stamps
from .updates.sync import SceneSync
from .view_layer.layers import world_of
from .view_layer.light_linking import LightLinks
from .view_layer.settings import export_exposure, export_settings, preview_settings

__all__ = [
    "BakePixels",
    "ExportProgress",
    "ExportStopped",
    "Eye",
    "FrameExporter",
    "SceneError",
    "SceneSync",
    "export_baked_scene",
    "export_exposure",
    "export_scene",
    "export_settings",
    "export_view",
    "is_blurred",
    "views_of",
    "wants_neighbors",
]


@collector_paused()
def export_scene(
    depsgraph: bpy.types.Depsgraph,
    engine: bpy.types.RenderEngine | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Scene:
    """Everything a render of the depsgraph's scene and view layer needs, copied out of Blender.

    engine: shows the progress and is asked for test_break; should_stop: asked as well.
    Raises SceneError when there is nothing to render from, ExportStopped when the user stops the export.
    """
    context = _context_of(depsgraph, engine, should_stop)
    source = depsgraph.scene_eval
    scene = Scene(camera=export_camera(source, depsgraph, eye=Eye(engine), report=context.report))
    scene.settings = export_settings(source, depsgraph.view_layer)
    is_preview = engine is not None and engine.is_preview
    if is_preview:
        scene.settings = preview_settings(scene.settings)
    scene.settings.validate()
    context.culling = Culling(source, scene.camera)
    blurred, neighbors = is_blurred(depsgraph, engine), wants_neighbors(depsgraph, engine)
    if blurred:
        context.velocity_blur = VelocityBlur.of(source.render)
    objects = ObjectExporter(context)
    placed = objects.export(depsgraph, identify=blurred or neighbors)
    scene.world, suns = export_world(world_of(depsgraph), context)
    if not is_preview:  # whose scene is Blender's own
        _warn_of_omissions(depsgraph, context.report)
    if blurred or neighbors:
        placed = MotionExporter(depsgraph, engine, context, neighbors).run(scene, objects, placed)
    fill_scene(scene, depsgraph, context, objects, placed, suns)
    scene.stamps = export_stamps(source)
    return scene


@collector_paused()
def export_baked_scene(
    depsgraph: bpy.types.Depsgraph,
    engine: bpy.types.RenderEngine,
    baked: bpy.types.Object,
    bake_pass: BakePass,
    pixels: BakePixels,
) -> Scene:
    """Everything that a texture to be baked of a mesh object needs, copied out of Blender; nothing is blurred.

    Raises SceneError where the object is not rendered, ExportStopped when the user wants no more.
    """
    context = _context_of(depsgraph, engine)
    context.base_meshes = None  # texels know triangles by number
    source = depsgraph.scene_eval
    scene = Scene(camera=camera_beside(baked, depsgraph))
    scene.settings = bake_settings(export_settings(source, depsgraph.view_layer), bake_pass, pixels)
    scene.settings.validate()
    objects = ObjectExporter(context)
    placed = objects.export(depsgraph, identify=True)
    scene.world, suns = export_world(world_of(depsgraph), context)
    _warn_of_omissions(depsgraph, context.report)
    fill_scene(scene, depsgraph, context, objects, placed, suns)
    scene.stamps = export_stamps(source)
    look_at_texels(scene, baked, placed, pixels, seen_from(source, scene.camera), bake_pass)
    return scene


def _context_of(
    depsgraph: bpy.types.Depsgraph,
    engine: bpy.types.RenderEngine | None,
    should_stop: Callable[[], bool] | None = None,
) -> ExportContext:
    def stop() -> bool:
        return (engine is not None and engine.test_break()) or (should_stop is not None and should_stop())

    def show(text: str) -> None:
        if engine is not None:
            engine.update_stats("", text)

    report = Report(stop, show)
    report.progress("Exporting the scene")
    context = ExportContext(report)
    context.read_from(depsgraph)
    context.light_links = LightLinks(depsgraph.view_layer)
    context.light_links.warn(report)
    return context


def _warn_of_omissions(depsgraph: bpy.types.Depsgraph, report: Report) -> None:
    warn_of_missing(report)
    omissions = OmissionList()
    omissions.look_at(objects_of(depsgraph))
    omissions.warn(depsgraph, report)

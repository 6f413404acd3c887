# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's bake operator: light and other passes of a mesh as a texture or as colors of vertices."""

import logging

import bpy
import numpy as np

from ...scene import Scene
from ...scene.errors import RppmError, unforeseen
from ...scene.passes import COMBINED
from ...session.render.bake_passes import BakePass
from ...session.render.render_job import RenderJob
from ...session.render.results import Progress
from ..export import BakePixels, ExportStopped, export_baked_scene
from .final import render_scene, report_late_warnings, report_warnings, status_text
from .frame_reuse import reuse_previous_frame

logger = logging.getLogger(__name__)


def bake(
    engine: bpy.types.RenderEngine,
    depsgraph: bpy.types.Depsgraph,
    baked: bpy.types.Object,
    pass_type: str,
    pass_filter: int,
    width: int,
    height: int,
) -> None:
    """Bake what of a texture of width x height is on an object, as RenderEngine.bake is asked to.

    What cannot be baked ends in the engine's report, which Blender's operator raises; nothing is raised here.
    """
    # Blender takes what is in the result for baked, whether it was handed back or cancelled.
    result = engine.begin_result(0, 0, width, height, layer=depsgraph.view_layer_eval.name)
    try:
        pixels = BakePixels.of_result(result, width, height)
        if pixels.bounds is not None:  # of several objects on one texture, those whose turn it is not
            picture = _bake(engine, depsgraph, baked, BakePass.of_blender(pass_type, pass_filter), pixels)
            _show(result, picture, pixels)
    except ExportStopped:
        logger.info("baking was stopped during the export")
    except RppmError as error:
        engine.report({"ERROR"}, str(error))
    except Exception as error:
        logger.exception("RPPM failed")
        engine.report({"ERROR"}, unforeseen(error, "please report the system console's text"))
    finally:
        engine.end_result(result)


def _bake(
    engine: bpy.types.RenderEngine,
    depsgraph: bpy.types.Depsgraph,
    baked: bpy.types.Object,
    bake_pass: BakePass,
    pixels: BakePixels,
) -> np.ndarray:
    """(rows, columns, 4) float32 of the part of the texture that pixels.bounds tells."""
    scene = export_baked_scene(depsgraph, engine, baked, bake_pass, pixels)
    warned = list(scene.warnings)
    report_warnings(engine, warned)
    scene = reuse_previous_frame(scene)
    engine.update_stats("", "Preparing the graphics device")
    result = render_scene(engine, scene, _BakeJob(engine, scene, baked.name))
    report_late_warnings(engine, result, scene, warned)
    return bake_pass.picture(result.frame)


def _show(result: bpy.types.RenderResult, picture: np.ndarray, pixels: BakePixels) -> None:
    x_min, y_min, x_max, y_max = pixels.bounds
    for render_pass in result.layers[0].passes:
        if render_pass.name == COMBINED:
            whole = np.zeros((*pixels.triangles.shape, render_pass.channels), np.float32)
            on_object = pixels.triangles[y_min:y_max, x_min:x_max] >= 0
            whole[y_min:y_max, x_min:x_max][on_object] = picture[on_object][:, : render_pass.channels]
            render_pass.rect.foreach_set(whole.reshape(-1))


class _BakeJob(RenderJob):
    """Shows how far baking is, and stops it."""

    def __init__(self, engine: bpy.types.RenderEngine, scene: Scene, name: str) -> None:
        self._engine = engine
        self._scene = scene
        self._name = name

    def should_stop(self) -> bool:
        return self._engine.test_break()

    def on_progress(self, progress: Progress) -> bool:
        self._engine.update_progress(progress.fraction)
        self._engine.update_stats("", f"Baking {self._name} | {status_text(progress, self._scene)}")
        return False

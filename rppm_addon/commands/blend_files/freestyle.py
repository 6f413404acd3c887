# SPDX-License-Identifier: GPL-3.0-or-later
"""Freestyle's strokes, which Blender draws into its own result of a render once the engine has ended."""

import logging
import tempfile
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from ...pictures import PictureError, read_exr
from ..picture_set import PictureSet

logger = logging.getLogger(__name__)

_WITHOUT = "Freestyle: its strokes are not in %s, %s"


def add_strokes(bpy: ModuleType, pictures: PictureSet) -> None:
    """Give a finished picture the strokes that Blender has drawn; a warning says where it cannot have them."""
    scene = bpy.context.scene
    layers = [layer for layer in scene.view_layers if layer.use and layer.use_freestyle]
    if not (scene.render.use_freestyle and layers):
        return
    if not pictures.is_single:
        logger.warning(_WITHOUT, "these pictures", "as there are several; name one --view-layer, and switch off stereo")
        return
    if layers[0].freestyle_settings.as_render_pass:
        logger.warning(_WITHOUT, "the files", "as they are a pass; switch off As Render Pass (View Layer > Freestyle)")
        return
    (_, recorder) = pictures.finished[0]
    combined = _result_of(bpy, scene)
    if combined is None or combined.shape != recorder.frame.combined.shape:
        logger.warning(_WITHOUT, "EXR files", "as Blender's result has another size; render without a border")
        return
    recorder.frame.combined = combined


def _result_of(bpy: ModuleType, scene: Any) -> np.ndarray | None:
    """(height, width, 4) float32 of Blender's result, row 0 at the bottom, without a view transform."""
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # Blender 5.0 and later
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    settings.exr_codec = "ZIP"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "result.exr"
        try:
            bpy.data.images["Render Result"].save_render(str(path), scene=scene)
            return read_exr(path).combined
        except (OSError, RuntimeError, PictureError):
            return None

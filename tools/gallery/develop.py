# SPDX-License-Identifier: GPL-3.0-or-later
"""Saves EXR pictures as JPEG or PNG by the view transform of a .blend file.

Arguments: FILE.blend, then each EXR and the picture that it becomes.
"""

import os
import sys

import bpy
import numpy as np
import OpenEXR

_QUALITY = 86


def develop(source: str, target: str) -> None:
    """One picture."""
    with OpenEXR.File(source) as file:
        channels = file.channels()
        pixels = channels["RGBA" if "RGBA" in channels else "RGB"].pixels[::-1, :, :3]
    height, width = pixels.shape[:2]
    image = bpy.data.images.new("Picture", width, height, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    image.pixels.foreach_set(np.dstack([pixels, np.ones((height, width), np.float32)]).astype(np.float32).reshape(-1))
    scene = bpy.context.scene
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # Blender 5.0 and later
        settings.media_type = "IMAGE"
    settings.file_format, settings.quality = ("PNG" if target.endswith(".png") else "JPEG"), _QUALITY
    settings.color_mode, settings.color_depth = "RGB", "8"
    image.save_render(target, scene=scene)


if __name__ == "__main__":
    bpy.ops.wm.open_mainfile(filepath=sys.argv[1], load_ui=False, use_scripts=False)
    for k in range(2, len(sys.argv), 2):
        develop(sys.argv[k], sys.argv[k + 1])
    os._exit(0)  # Blender's own exit may hang

# SPDX-License-Identifier: GPL-3.0-or-later
"""Radiance as Cycles renders it."""

import bpy
import OpenEXR


def cycles_radiance(scene, folder):
    """Mean radiance of a millimeter around the origin from above, by Cycles, (3,)."""
    render = scene.render
    render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.max_bounces = "CPU", 256, 0
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 0.002
    render.resolution_x = render.resolution_y = 4
    if hasattr(render.image_settings, "media_type"):
        render.image_settings.media_type = "IMAGE"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = str(folder / "plane.exr")
    bpy.ops.render.render(write_still=True)
    with OpenEXR.File(render.filepath) as file:
        pixels = next(iter(file.channels().values())).pixels
    return pixels[..., :3].reshape(-1, 3).mean(axis=0)

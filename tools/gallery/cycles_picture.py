# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a .blend file with Cycles for so many seconds of the processor, all cores together, and denoises the picture.

Arguments: FILE.blend PICTURE.exr SECONDS PERCENT FRAME. Prints what it took as JSON. Settings are those of a new file
in Blender (caustics on, Filter Glossy 1, Clamp Indirect 10), with the file's bounces, without Noise Threshold: there
are as many samples as there is time for, which is told from what a few of them take.
"""

import json
import os
import sys
import time

import bpy

_FEW, _MORE = 1, 9


def _spent(scene: bpy.types.Scene, samples: int) -> float:
    """Seconds of the processor that a render takes."""
    scene.cycles.samples = samples
    began = time.process_time()
    bpy.ops.render.render(write_still=True)
    return time.process_time() - began


def main(source: str, target: str, seconds: float, percent: int, frame: int) -> None:
    """Render, denoise and write."""
    bpy.ops.wm.open_mainfile(filepath=source, load_ui=False, use_scripts=False)
    scene = bpy.context.scene
    scene.frame_set(frame)
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.resolution_percentage = percent
    render.use_compositing = render.use_sequencer = False
    cycles.use_adaptive_sampling, cycles.use_denoising, cycles.denoiser = False, True, "OPENIMAGEDENOISE"
    cycles.use_auto_tile, cycles.time_limit = False, 0.0
    if hasattr(render.image_settings, "media_type"):  # Blender 5.0 and later
        render.image_settings.media_type = "IMAGE"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.use_file_extension, render.filepath = False, target
    _spent(scene, _FEW)
    few, more = _spent(scene, _FEW), _spent(scene, _MORE)
    each = (more - few) / (_MORE - _FEW)
    samples = max(1, round(_FEW + (seconds - few) / each))
    spent = _spent(scene, samples)
    print(json.dumps({"seconds": round(spent, 1), "samples": samples, "version": bpy.app.version_string}))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]), int(sys.argv[4]), int(sys.argv[5]))
    sys.stdout.flush()
    os._exit(0)  # Blender's own exit may hang

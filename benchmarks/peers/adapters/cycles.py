# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles in the bpy module. Options: shadow_caustics, denoise, no_caustics (to tell caustics from the rest)."""

import os
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np
import OpenEXR

from ..description import Glass, Scene
from ..jobs import DEPTH, Job, Recorder, run_adapter

_NO_LIMIT = 1 << 24
_LEAST_SECONDS = 0.02


def render(job: Job, scene: Scene | None, recorder: Recorder) -> None:
    bpy.ops.wm.open_mainfile(filepath=job.source, load_ui=False, use_scripts=False)
    blender_scene = bpy.context.scene
    _set_up(blender_scene, job)
    if scene is not None:
        _set_light_paths(blender_scene, job)
        if job.options.get("shadow_caustics"):
            _mark_caustics(scene)
    cycles = blender_scene.cycles
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.exr"
        _render(blender_scene, 1, 0.0, path)
        recorder.first_picture()
        # What a render takes beside sampling: export, hierarchy, denoising.
        _, overhead = _render(blender_scene, 1, 0.0, path)
        for mark in job.samples or job.seconds:
            cycles.seed = job.seed
            if job.samples:
                pixels, seconds = _render(blender_scene, mark, 0.0, path)
            else:
                pixels, seconds = _render(blender_scene, _NO_LIMIT, max(mark - overhead, _LEAST_SECONDS), path)
            recorder.keep(mark, seconds, mark if job.samples else 0.0, pixels)


def _set_up(scene: bpy.types.Scene, job: Job) -> None:
    settings, cycles = scene.render, scene.cycles
    settings.engine, cycles.device = "CYCLES", "CPU"
    settings.use_compositing = settings.use_sequencer = False
    settings.image_settings.media_type = "IMAGE"
    settings.image_settings.file_format, settings.image_settings.color_depth = "OPEN_EXR", "32"
    settings.use_file_extension = False
    cycles.use_denoising = bool(job.options.get("denoise"))
    if cycles.use_denoising:
        cycles.denoiser, cycles.denoising_input_passes = "OPENIMAGEDENOISE", "RGB_ALBEDO_NORMAL"
        cycles.denoising_prefilter = "ACCURATE"


def _set_light_paths(scene: bpy.types.Scene, job: Job) -> None:
    settings, cycles = scene.render, scene.cycles
    settings.resolution_x = settings.resolution_y = job.resolution
    settings.resolution_percentage = 100
    cycles.use_adaptive_sampling, cycles.use_auto_tile = False, False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = not job.options.get("no_caustics")
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, f"{kind}_bounces", DEPTH)


def _mark_caustics(scene: Scene) -> None:
    """Let the glass cast, and all else receive, the caustics that manifold next-event estimation finds."""
    for mesh in scene.meshes:
        made = bpy.data.objects[mesh.name]
        made.cycles.is_caustics_caster = isinstance(mesh.material, Glass)
        made.cycles.is_caustics_receiver = not made.cycles.is_caustics_caster
    for light in bpy.data.lights:
        light.cycles.is_caustics_light = True


def _render(scene: bpy.types.Scene, samples: int, limit: float, path: Path) -> tuple[np.ndarray, float]:
    """The picture, (H, W, 3), the top row first, and the seconds it took."""
    scene.cycles.samples, scene.cycles.time_limit = samples, limit
    scene.render.filepath = str(path)
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    seconds = time.perf_counter() - start
    with OpenEXR.File(str(path)) as file:
        channels = file.channels()
        pixels = channels["RGBA" if "RGBA" in channels else "RGB"].pixels[..., :3].copy()
    return pixels, seconds


if __name__ == "__main__":
    status = run_adapter(lambda: f"Cycles of Blender {bpy.app.version_string}", render)
    sys.stdout.flush()
    os._exit(status)  # Blender's own exit may hang

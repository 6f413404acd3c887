# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm compile: the programs of a scene, compiled before anybody waits for its picture."""

import argparse
import dataclasses
import time

from ..scene import RenderSettings, Scene
from .options.options import load_blend_or_saved, split_values
from .recorder import apply_settings
from .terminal.progress_bar import ProgressBar

_LONGEST_SIDE = 64
"""Pixels, so that rendering takes next to no time beside compiling, and yet GPUs try both routes of density
estimation."""
_MOST_PHOTONS = 1024
_ITERATIONS = 2
"""The second is the first that rests on what another one learned."""


def compile_programs(options: argparse.Namespace, bar: ProgressBar) -> int:
    """Do it; returns the exit status."""
    from ..session.render.renderer import Renderer

    settings, data_values = split_values(options.values)
    apply_settings(RenderSettings(), settings)
    bar.show(0.0, "reading the scene")
    scene = small_scene(load_blend_or_saved(options.file, options, settings, data_values))
    start, processor_start = time.perf_counter(), time.process_time()
    with Renderer() as renderer:
        count = renderer.compile(
            scene,
            lambda fraction, name: bar.show(fraction, f"Compiling: {name}"),
        )
        device = renderer.device.label
    bar.clear()
    seconds, processor_seconds = time.perf_counter() - start, time.process_time() - processor_start
    print(f"{count} programs ready for {device} in {seconds:.1f} s ({processor_seconds:.1f} s of processor time)")
    return 0


def small_scene(scene: Scene) -> Scene:
    """The scene as a picture that needs the same programs in the least time."""
    from .saved_scene import camera_at_resolution

    camera, settings = scene.camera, scene.settings
    scale = min(1.0, _LONGEST_SIDE / max(camera.width, camera.height))
    size = (max(1, round(side * scale)) for side in (camera.width, camera.height))
    few = dataclasses.replace(
        settings, iterations=_ITERATIONS, time_limit=0.0, photons=min(scene.photon_count, _MOST_PHOTONS)
    )
    return dataclasses.replace(scene, camera=camera_at_resolution(camera, *size), settings=few)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares RPPM with Cycles where glass or water throws caustics into fog, in scenes of the gallery.

    python -m benchmarks.volumes.caustics_in_media lighthouse pool_shafts

Both have the same bounces and no denoising. Seconds are those of the processor, all cores together; the time to start,
to compile and to export is not counted for RPPM. References are long runs of both, weighted by their noise. Prints a
Markdown table.
"""

import argparse
import dataclasses
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import bpy
import numpy as np
import OpenEXR

import rppm_addon
from rppm_addon.blender.export import export_scene
from rppm_addon.scene import Scene
from rppm_addon.session.render.renderer import Renderer
from tools.gallery.render import build

from ..peers.metrics import relative_mse
from ..peers.references import combine

MARKS = (10.0, 30.0, 60.0)
"""Seconds of processor time after which pictures are compared."""
VOLUME_BOUNCES = 8
_NO_LIMIT = 1 << 24


def open_scene(name: str, percent: int) -> None:
    """Make a scene of the gallery and open it, with settings of Cycles that leave nothing out."""
    bpy.ops.wm.open_mainfile(filepath=str(build(name)), load_ui=False, use_scripts=False)
    scene = bpy.context.scene
    scene.render.resolution_percentage = percent
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.volume_bounces = VOLUME_BOUNCES


def rppm_pictures(renderer: Renderer, scene: Scene, marks: Sequence[float], seed: int) -> list[np.ndarray]:
    """(H, W, 3) pictures after so many seconds each, the bottom row first; the programs are compiled."""
    scene = dataclasses.replace(scene, settings=scene.settings.with_values(seed=seed, iterations=_NO_LIMIT))
    renderer.forget()
    began, pictures = time.process_time(), []

    def keep(_, read) -> None:
        nonlocal began
        if len(pictures) < len(marks) and time.process_time() - began >= marks[len(pictures)]:
            reading = time.process_time()
            pictures.append(read().combined[..., :3].astype(np.float64))
            began += time.process_time() - reading

    renderer.render(scene, keep, lambda: len(pictures) == len(marks))
    return pictures


def cycles_picture(seconds: float, rate: float, seed: int) -> tuple[np.ndarray, float]:
    """An (H, W, 3) picture of about so many seconds, the bottom row first, and its seconds; rate: samples a second."""
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.seed, scene.cycles.samples = "CYCLES", seed, max(round(seconds * rate), 1)
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.exr")
        began = time.process_time()
        bpy.ops.render.render(write_still=True)
        spent = time.process_time() - began
        with OpenEXR.File(scene.render.filepath) as file:
            channels = file.channels()
            pixels = channels["RGBA" if "RGBA" in channels else "RGB"].pixels[::-1, :, :3]
    return pixels.astype(np.float64), spent


def rows(name: str, percent: int, reference_seconds: float) -> list[str]:
    """Rows of the table for a scene, one for each of MARKS."""
    open_scene(name, percent)
    scene = export_scene(bpy.context.evaluated_depsgraph_get())
    settings = scene.settings.with_values(volume_bounces=VOLUME_BOUNCES, use_denoising=False, passes=())
    scene = dataclasses.replace(scene, settings=settings)
    with Renderer() as renderer:
        renderer.render(dataclasses.replace(scene, settings=settings.with_values(iterations=2)))
        ours = rppm_pictures(renderer, scene, MARKS, seed=1)
        longs = [rppm_pictures(renderer, scene, [reference_seconds], seed)[0] for seed in (1001, 1002)]
    _, spent = cycles_picture(4.0, 1.0, seed=9)
    rate = 4.0 / spent
    halves = [cycles_picture(reference_seconds, rate, seed)[0] for seed in (1001, 1002)]
    pixels, agreement = combine({"RPPM": tuple(longs), "Cycles": tuple(halves)}, 2.0 * reference_seconds)
    print(
        f"{name}, {pixels.shape[1]} x {pixels.shape[0]}: noise of the references {agreement.noise}, difference "
        f"{agreement.difference:.3g}, mean of RPPM over Cycles' {agreement.mean_ratio:.4f}",
        flush=True,
    )
    found = []
    for mark, picture in zip(MARKS, ours, strict=True):
        theirs, spent = cycles_picture(mark, rate, seed=1)
        our_error, their_error = relative_mse(picture, pixels), relative_mse(theirs, pixels) * spent / mark
        found.append(f"| {name} | {mark:.0f} s | {our_error:.2g} | {their_error:.2g} | {our_error / their_error:.2g} |")
        print(found[-1], flush=True)
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="+", help="names of scripts in docs/gallery")
    parser.add_argument("--percent", type=int, default=25, help="of the scenes' width and height (25)")
    parser.add_argument("--reference-seconds", type=float, default=120.0, help="of each half of a reference (120)")
    options = parser.parse_args()
    rppm_addon.register()
    lines = ["| scene | after | RPPM | Cycles | RPPM over Cycles |", "|---|--:|--:|--:|--:|"]
    for name in options.scenes:
        lines += rows(name, options.percent, options.reference_seconds)
    print("\n".join(lines))


if __name__ == "__main__":
    main()

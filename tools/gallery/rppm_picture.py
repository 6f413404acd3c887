# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a saved scene with RPPM for so many seconds of the processor, all cores together, and denoises the picture.

Arguments: SCENE.npz PICTURE.exr SECONDS. Prints what it took as JSON.
"""

import dataclasses
import json
import sys
import time

from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.denoising.places import library_places
from rppm_addon.pictures import write_exr
from rppm_addon.scene import load_scene
from rppm_addon.scene.passes import DENOISING_ALBEDO, DENOISING_NORMAL
from rppm_addon.session.render.renderer import Renderer
from rppm_addon.session.render.results import Frame, Progress

_NO_LIMIT = 1 << 30


def main(source: str, target: str, seconds: float) -> None:
    """Render, denoise and write."""
    saved = load_scene(source)
    # Stopped renders are not denoised: that is done below, by what guides it.
    settings = dataclasses.replace(
        saved.settings, time_limit=0.0, use_denoising=False, passes=(DENOISING_ALBEDO, DENOISING_NORMAL)
    )
    denoiser = Denoiser(library_places())

    def denoised(frame: Frame) -> Frame:
        return Frame(denoiser.denoise(frame.combined, frame.passes, settings), frame.passes)

    with Renderer() as renderer:
        first = renderer.render(dataclasses.replace(saved, settings=dataclasses.replace(settings, iterations=1)))
        began = time.process_time()
        denoised(first.frame)
        denoising = time.process_time() - began
        renderer.forget()  # programs are compiled; the scene is to be uploaded and built anew
        began = time.process_time()
        marks = [0.0]

        def on_progress(_: Progress, __: object) -> None:
            marks.append(time.process_time() - began)

        def is_over() -> bool:
            return marks[-1] + 0.5 * (marks[-1] - marks[-2]) + denoising > seconds

        endless = dataclasses.replace(saved, settings=dataclasses.replace(settings, iterations=_NO_LIMIT))
        result = renderer.render(endless, on_progress, is_over)
        frame = denoised(result.frame)
        spent = time.process_time() - began
        device = renderer.device.label
    write_exr(target, frame.combined)
    statistics = result.statistics
    height, width = frame.combined.shape[:2]
    print(
        json.dumps(
            {
                "seconds": round(spent, 1),
                "samples": statistics.iterations,
                "photons": statistics.photons,
                "triangles": statistics.triangles,
                "resolution": [width, height],
                "device": device,
            }
        )
    )


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]))

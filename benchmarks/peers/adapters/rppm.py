# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM on a scene that rppm export saved. Options: settings by name."""

import dataclasses
import sys
import time
from collections.abc import Callable

from rppm_addon.scene import Scene as SavedScene
from rppm_addon.scene import load_scene
from rppm_addon.session.render.renderer import Renderer

from ..description import Scene
from ..jobs import Job, Recorder, run_adapter

_NO_LIMIT = 1 << 30
_LEAST_SECONDS = 0.02


def render(job: Job, scene: Scene | None, recorder: Recorder) -> None:
    saved = load_scene(job.source)
    settings = saved.settings.with_values(seed=job.seed, **job.options)

    def limited(**values: object) -> SavedScene:
        return dataclasses.replace(saved, settings=dataclasses.replace(settings, **values))

    with Renderer() as renderer:
        recorder.answer.version += f" on {renderer.device.name} ({renderer.device.driver})"
        renderer.render(limited(iterations=1))
        recorder.first_picture()
        if settings.use_denoising and not job.samples:
            _denoise_in_time(job, renderer, limited, recorder)
            return
        renderer.forget()  # the programs stay; the scene is to be uploaded and built anew
        start = time.perf_counter()
        done = 0

        def on_progress(progress, frame) -> None:
            nonlocal done
            done = progress.iteration
            if done in job.samples:
                keep(done, frame())

        def keep(mark: float, frame) -> None:
            recorder.keep(mark, time.perf_counter() - start, done, frame.combined[::-1])

        if job.samples:
            renderer.render(limited(iterations=max(job.samples)), on_progress)
        else:
            limit = max(job.seconds)
            result = renderer.render(
                limited(iterations=_NO_LIMIT, time_limit=limit), on_progress, None, job.seconds, keep
            )
            if limit not in [picture.mark for picture in recorder.answer.pictures]:
                keep(limit, result.frame)  # it ended with the iteration nearest to the limit, shortly before


def _denoise_in_time(job: Job, renderer: Renderer, limited: Callable[..., SavedScene], recorder: Recorder) -> None:
    """A render for each mark, of which denoising takes its part."""
    for mark in job.seconds:
        denoising = renderer.render(limited(iterations=1)).statistics.stage_seconds["denoising"]
        renderer.forget()
        start = time.perf_counter()
        limit = max(mark - denoising, _LEAST_SECONDS)
        result = renderer.render(limited(iterations=_NO_LIMIT, time_limit=limit))
        seconds = time.perf_counter() - start
        recorder.keep(mark, seconds, result.statistics.iterations, result.frame.combined[::-1])


if __name__ == "__main__":
    sys.exit(run_adapter(lambda: "RPPM", render))

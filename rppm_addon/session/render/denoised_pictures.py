# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as they are handed out: denoised where the settings ask for it, with the passes that were asked for."""

import logging
import time
from collections.abc import Callable

from ...denoising.denoiser import Denoiser
from ...scene.errors import DenoiserError
from ...scene.passes import NOISY_IMAGE
from ...scene.settings import RenderSettings
from .results import Frame, Progress, RenderResult

log = logging.getLogger(__name__)


def wanted_frame(frame: Frame, settings: RenderSettings) -> Frame:
    """A frame of the film without the passes that it holds for denoising alone."""
    names = {entry.name for entry in settings.picture_passes}
    return Frame(frame.combined, {name: array for name, array in frame.passes.items() if name in names})


def denoised_frame(frame: Frame, settings: RenderSettings, denoiser: Denoiser) -> Frame:
    """A frame of the film as it is when nothing more is added to it: with its noise as Noisy Image, where the settings
    ask for denoising. Raises DenoiserError; wanted_frame needs no denoiser.
    """
    wanted = wanted_frame(frame, settings)
    if not settings.use_denoising:
        return wanted
    combined = denoiser.denoise(frame.combined, frame.passes, settings)
    return Frame(combined, {**wanted.passes, NOISY_IMAGE.name: frame.combined})


def noisy_frame(frame: Frame, settings: RenderSettings) -> Frame:
    """Return a frame as denoised_frame does, but noisy: denoising has failed or is not waited for."""
    wanted = wanted_frame(frame, settings)
    noisy = {NOISY_IMAGE.name: frame.combined} if settings.use_denoising else {}
    return Frame(wanted.combined, {**wanted.passes, **noisy})


def finished_frame(frame: Frame, settings: RenderSettings, denoiser: Denoiser, warnings: list[str]) -> Frame:
    """Return the denoised frame, or where that fails the noisy one and a line more in ``warnings``."""
    try:
        return denoised_frame(frame, settings, denoiser)
    except DenoiserError as error:
        text = f"the picture is not denoised: {error}"
        if text not in warnings:
            log.warning("%s", text)
            warnings.append(text)
        return noisy_frame(frame, settings)


def finished_result(result: RenderResult, settings: RenderSettings, denoiser: Denoiser) -> RenderResult:
    """Return a result with its frame finished. The picture of a render that was stopped is not denoised, which would
    make its user wait."""
    if result.stopped or not settings.use_denoising:
        return RenderResult(noisy_frame(result.frame, settings), result.statistics, result.stopped)
    start, statistics = time.perf_counter(), result.statistics
    frame = finished_frame(result.frame, settings, denoiser, statistics.warnings)
    seconds = time.perf_counter() - start
    statistics.seconds += seconds
    statistics.stage_seconds = {**statistics.stage_seconds, "denoising": seconds}
    return RenderResult(frame, statistics, result.stopped)


class FinishedPictures:
    """Callbacks of a render's caller, who receives pictures with the passes that the settings name."""

    def __init__(
        self,
        settings: RenderSettings,
        denoiser: Denoiser,
        on_progress: Callable[[Progress, Callable[[], Frame]], None] | None,
        on_snapshot: Callable[[float, Frame], None] | None,
    ) -> None:
        """on_progress, on_snapshot: as Renderer.render takes them."""
        self._settings = settings
        self._denoiser = denoiser
        self._on_progress = on_progress
        self._on_snapshot = on_snapshot
        self._warnings: list[str] = []
        """Warnings of snapshots, each logged once."""

    def report(self, progress: Progress, read_frame: Callable[[], Frame]) -> None:
        """Pass the progress on, with a function that returns the noisy picture so far."""
        if self._on_progress is not None:
            self._on_progress(progress, lambda: wanted_frame(read_frame(), self._settings))

    def take_snapshot(self, seconds: float, frame: Frame) -> None:
        """Pass a frame of the film on, denoised where the settings ask for it."""
        if self._on_snapshot is not None:
            self._on_snapshot(seconds, finished_frame(frame, self._settings, self._denoiser, self._warnings))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising in a thread of its own, which leaves the session free to render, answer messages and stop."""

import concurrent.futures
import time
from collections.abc import Mapping

import numpy as np

from ...denoising.denoiser import Denoiser
from ...scene.settings import RenderSettings
from .denoised_pictures import finished_result, noisy_frame
from .results import RenderResult

MOST_TIME = 0.2
"""Largest fraction of all time that denoising may take. Without a GPU it takes the processor from the iterations."""
POLL_SECONDS = 0.02
"""Time between two checks of a picture that is being denoised, when there is nothing else to do."""


class BackgroundDenoising:
    """Denoises pictures of a viewport, one at a time. The thread that renders calls all methods."""

    def __init__(self, denoiser: Denoiser) -> None:
        self._denoiser = denoiser
        self._executor: concurrent.futures.ThreadPoolExecutor | None = None
        self._work: concurrent.futures.Future[np.ndarray] | None = None
        self._key = (0, 0)
        self._started = self._rested = 0.0

    @property
    def is_idle(self) -> bool:
        """Whether no picture is being denoised or waits to be taken."""
        return self._work is None

    @property
    def is_due(self) -> bool:
        """Whether another picture may be denoised without taking more than MOST_TIME."""
        return self.is_idle and time.perf_counter() >= self._rested

    def start(
        self, key: tuple[int, int], combined: np.ndarray, passes: Mapping[str, np.ndarray], settings: RenderSettings
    ) -> None:
        """Begin to denoise a picture; ``key`` identifies it. No other one may be denoised.

        Raises DenoiserError where there is no library.
        """
        self._denoiser.open()
        self._executor = self._executor or concurrent.futures.ThreadPoolExecutor(1, "RPPM denoising")
        self._key, self._started = key, time.perf_counter()
        self._work = self._executor.submit(self._denoiser.denoise, combined, passes, settings)

    def take(self, seconds: float = 0.0) -> tuple[tuple[int, int], np.ndarray] | None:
        """Return the key and the denoised picture if it is ready within so many seconds, or None.

        Raises DenoiserError where it could not be denoised.
        """
        if self._work is None or not concurrent.futures.wait([self._work], seconds).done:
            return None
        work, self._work = self._work, None
        now = time.perf_counter()
        self._rested = now + (now - self._started) * (1.0 / MOST_TIME - 1.0)
        return self._key, work.result()

    def release(self) -> None:
        """End the thread, once it has finished its picture."""
        if self._executor is not None:
            self._executor.shutdown(wait=False)
            self._executor = self._work = None


class BackgroundFinish:
    """Finishes the result of a render (finished_result)."""

    def __init__(self, result: RenderResult, settings: RenderSettings, denoiser: Denoiser) -> None:
        self._result = result
        self._settings = settings
        executor = concurrent.futures.ThreadPoolExecutor(1, "RPPM denoising")
        self._work = executor.submit(finished_result, result, settings, denoiser)
        executor.shutdown(wait=False)

    def take(self, stopping: bool) -> RenderResult | None:
        """Return the finished result, or None until it is ready. ``stopping``: return it now, noisy if need be."""
        if concurrent.futures.wait([self._work], POLL_SECONDS).done:
            return self._work.result()
        if not stopping:
            return None
        return RenderResult(noisy_frame(self._result.frame, self._settings), self._result.statistics, stopped=True)

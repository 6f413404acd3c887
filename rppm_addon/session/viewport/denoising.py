# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoised pictures of a viewport."""

from collections.abc import Mapping

import numpy as np

from ...denoising.denoiser import Denoiser
from ...integrator.common.require import require
from ...scene.errors import DenoiserError
from ...scene.scene import Scene
from ..render.background_denoising import BackgroundDenoising


class ViewportDenoising:
    """Denoises pictures of a viewport in the background.

    The pictures of one scene and resolution are a series. Noisy pictures are presented until a series has its first
    denoised one, and only denoised pictures after that. A series that cannot be denoised stays noisy.
    """

    def __init__(self, denoiser: Denoiser) -> None:
        self._background = BackgroundDenoising(denoiser)
        self._scene: Scene | None = None
        """Scene of the series, which takes the warnings."""
        self._series = 0
        """Number of the series."""
        self._denoised_series = 0
        """The last series that has a denoised picture."""
        self._noisy_series = 0
        """The last series that could not be denoised."""

    def begin_series(self, scene: Scene) -> None:
        """Begin the pictures of a scene at one resolution. A picture of another series is dropped once it is ready."""
        self._series += 1
        self._scene = scene

    def is_wanted(self, iteration: int) -> bool:
        """Whether the settings ask for a denoised picture after this iteration, and the series can have one."""
        settings = require(self._scene).settings
        is_reached = settings.use_denoising and iteration >= settings.denoising_start_sample
        return is_reached and self._noisy_series != self._series

    @property
    def has_picture(self) -> bool:
        """Whether the series has a denoised picture: noisy ones are not presented any more."""
        return self._denoised_series == self._series

    @property
    def is_idle(self) -> bool:
        """Whether no picture is being denoised."""
        return self._background.is_idle

    @property
    def is_due(self) -> bool:
        """Whether denoising another picture leaves enough time to the iterations."""
        return self._background.is_due

    def start(self, iteration: int, combined: np.ndarray, passes: Mapping[str, np.ndarray]) -> None:
        """Denoise the series' picture after an iteration; a failure becomes a warning of the scene.

        Args:
            iteration: number of the film's iterations.
            combined: (height, width, 4) float32, the noisy picture.
            passes: the film's passes by name.
        """
        try:
            self._background.start((self._series, iteration), combined, passes, require(self._scene).settings)
        except DenoiserError as error:
            self._leave_noisy(error)

    def take(self, seconds: float = 0.0) -> tuple[int, np.ndarray] | None:
        """Return the iteration and the denoised picture of the series if it is ready within so many seconds, or None.

        A failure becomes a warning of the scene.
        """
        try:
            found = self._background.take(seconds)
        except DenoiserError as error:
            self._leave_noisy(error)
            return None
        if found is None:
            return None
        (series, iteration), combined = found
        if series != self._series:
            return None
        self._denoised_series = series
        return iteration, combined

    def _leave_noisy(self, error: DenoiserError) -> None:
        self._noisy_series, self._denoised_series = self._series, 0
        require(self._scene).warn(f"the viewport is not denoised: {error}")

    def release(self) -> None:
        """End the thread."""
        self._background.release()

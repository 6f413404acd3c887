# SPDX-License-Identifier: GPL-3.0-or-later
"""The progress of a render as a line on the terminal."""

from typing import TYPE_CHECKING

from ...scene.common.quantities import clock_text, count_text, noise_text
from .progress_bar import PartBar, ProgressBar

if TYPE_CHECKING:
    from ...session.render.results import Progress


class ProgressLine:
    """Shows the progress of one render on a bar."""

    def __init__(self, bar: ProgressBar | PartBar) -> None:
        self._bar = bar
        self.progress: Progress | None = None
        """The last progress; None before the first."""
        self._first_iteration = 0
        """Iteration with which the render has begun."""

    @property
    def has_samples(self) -> bool:
        """Whether the render has completed an iteration."""
        return self.progress is not None and self.progress.iteration > self._first_iteration

    def show_step(self, words: str) -> None:
        """Show what is done before the first iteration."""
        self._bar.show(0.0, words)

    def show(self, progress: "Progress", elapsed: float, time_limit: float | None) -> None:
        """Show the progress after an iteration.

        Args:
            progress: progress of the render.
            elapsed: seconds since the scene was there.
            time_limit: seconds after which the render ends, whatever its iterations; None if they count.
        """
        if self.progress is None:
            self._first_iteration = progress.iteration
        self.progress = progress
        fraction, words = progress.fraction, f"sample {progress.iteration}"
        if time_limit is not None:
            fraction = elapsed / time_limit
        else:
            words += f" of {progress.iterations}"
        words += f", {count_text(progress.photons)} photons"
        if progress.noise > 0.0:
            words += f", noise {noise_text(progress.noise, progress.noise_threshold)}"
        words += f", {elapsed:.1f} s"
        if progress.remaining_seconds is not None:
            words += f", {clock_text(progress.remaining_seconds)} left"
        self._bar.show(fraction, words)

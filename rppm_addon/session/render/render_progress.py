# SPDX-License-Identifier: GPL-3.0-or-later
"""The progress of a render: its iterations, time and noise, and whether it needs another iteration."""

import logging
import time

from ...integrator.progressive import ProgressivePhotonMapper
from ...scene.settings import RenderSettings
from ..limits.noise_threshold import NoiseThreshold
from ..limits.remaining_time import RemainingTime
from ..limits.time_limit import TimeLimit
from .results import Progress

log = logging.getLogger(__name__)


class RenderProgress:
    """Counts the iterations of one render and measures their time and noise."""

    def __init__(self, mapper: ProgressivePhotonMapper, settings: RenderSettings, seconds: float) -> None:
        """Start the clock; ``seconds`` were taken before, by a render that is continued."""
        self._mapper = mapper
        self._settings = settings
        self._start = time.perf_counter() - seconds
        self._resumed_iterations = 0
        """Iterations that were in the film when the render began."""
        self.iterations = 0
        """Number of complete iterations in the film."""
        self.between_iterations = False
        """Whether the photons and the film are those of a complete iteration, or of none."""
        self._limit = TimeLimit(settings.time_limit)
        self._noise = NoiseThreshold(settings)
        self._remaining = RemainingTime()
        self.warnings: list[str] = []
        """Warnings about the time that iterations took."""

    @property
    def elapsed(self) -> float:
        """Seconds since the render began."""
        return time.perf_counter() - self._start

    def resume(self, iterations: int) -> None:
        """Begin with so many iterations in the film."""
        self.iterations = self._resumed_iterations = iterations
        self.between_iterations = True

    @property
    def has_iterated(self) -> bool:
        """Whether this render has completed an iteration of its own."""
        return self.iterations > self._resumed_iterations

    @property
    def needs_iteration(self) -> bool:
        """Whether the settings, the noise and the time limit ask for another iteration."""
        is_done = self.iterations >= self._settings.iterations or self._noise.is_reached
        return not is_done and self._limit.allows_another(self.elapsed)

    def begin_iteration(self) -> None:
        """Record that the film is that of an iteration under way."""
        self.between_iterations = False

    @property
    def may_cut(self) -> bool:
        """Whether an iteration that begins now is to be given up when time is up before its end."""
        return self._limit.may_cut(self.elapsed)

    @property
    def is_over_time(self) -> bool:
        """Whether an iteration that is under way is too late."""
        return self._limit.has_passed(self.elapsed)

    def end_iteration(self, began: float) -> None:
        """Record a complete iteration, which the device has finished; ``began`` is ``elapsed`` at its begin."""
        seconds = self.elapsed - began
        self.iterations += 1
        self.between_iterations = True
        self._remaining.add(self.elapsed)
        if self._limit.is_first_too_long(self.elapsed):
            self.warnings = [
                f"the first sample ended after {self.elapsed:.1f} s, past the time limit of {self._limit.limit:.3g} s: "
                "there would be no picture without it; fewer photons or pixels make samples shorter"
            ]
            log.warning("%s", self.warnings[0])
        self._limit.add(seconds, *(self._photons_of(self.iterations + later) for later in (0, 1)))

    def _photons_of(self, number: int) -> int:
        """Photons of one of the film's iterations, counted from 1."""
        return self._mapper.photons_emitted(number) - self._mapper.photons_emitted(number - 1)

    def measure_noise(self) -> None:
        """Measure the film's noise if the noise threshold needs it now."""
        if self._noise.is_due(self.iterations):
            self._noise.add(self.iterations, self._mapper.measure_noise())

    @property
    def is_early(self) -> bool:
        """Whether the film has fewer iterations than the settings."""
        return self.iterations < self._settings.iterations

    def record(self) -> Progress:
        """Return the progress so far."""
        settings, noise = self._settings, self._noise
        iterations = min(settings.iterations, noise.expected_iterations or settings.iterations)
        return Progress(
            self.iterations,
            settings.iterations,
            self.elapsed,
            self._mapper.photons_emitted(self.iterations),
            settings.time_limit,
            noise.expected_iterations,
            self._remaining.seconds(iterations - self.iterations, self.elapsed, settings.time_limit),
            noise.noise,
            noise.threshold,
            sum(self._mapper.memory_bytes.values()),
            self._mapper.build_seconds,
        )

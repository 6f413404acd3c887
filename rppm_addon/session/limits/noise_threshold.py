# SPDX-License-Identifier: GPL-3.0-or-later
"""When a picture is done by its noise, and when that is expected."""

import math
from itertools import takewhile

from ...integrator.film.noise_estimate import LEAST_MEASURED, MEASURED_EVERY
from ...scene.settings import RenderSettings

_TRUST = 1.0
"""In the expected exponent: as much as measurements whose logarithms of iterations spread by so much in square."""
_LEAST_EXPONENT, _MOST_EXPONENT = 0.2, 0.7
_RECENT = 8.0
"""Greatest ratio of the iterations of the newest noise measurement to those of an older one that is used.
A measurement at less than an eighth of the newest one's iterations is ignored."""


class NoiseThreshold:
    """Says by the noise of the film's noisiest block whether another iteration is needed.

    Depends on nothing but the film, so the same render ends with the same iteration, also when it was interrupted.
    """

    def __init__(self, settings: RenderSettings) -> None:
        self.threshold = settings.adaptive_threshold if settings.use_adaptive_sampling else 0.0
        """0 is none."""
        self._least = _measured_after(max(settings.least_iterations, LEAST_MEASURED))
        self._exponent = 0.5 * settings.alpha
        """Noise is expected to fall with this power of the iterations: that of photons, whose radii shrink."""
        self._measured: list[tuple[int, float]] = []
        """Iterations and noise, the newest first."""

    def is_due(self, iterations: int) -> bool:
        """Whether the noise is to be measured after so many iterations of the film."""
        return self.threshold > 0.0 and iterations >= LEAST_MEASURED and iterations % MEASURED_EVERY == 0

    def add(self, iterations: int, noise: float) -> None:
        """Record a measurement."""
        self._measured.insert(0, (iterations, noise))

    @property
    def noise(self) -> float:
        """Noise when it was measured last; 0 before."""
        return self._measured[0][1] if self._measured else 0.0

    @property
    def is_reached(self) -> bool:
        """Whether the picture is done."""
        return bool(self._measured) and self._measured[0][0] >= self._least and self.noise < self.threshold

    @property
    def expected_iterations(self) -> int:
        """With which the picture will be done, the film's; 0 where nothing is known of that."""
        if not self._measured or not math.isfinite(self.noise):
            return 0
        newest = self._measured[0][0]
        if self.is_reached:
            return newest
        recent = list(takewhile(lambda entry: _RECENT * entry[0] >= newest, self._measured))
        points = [(math.log(iterations), math.log(noise)) for iterations, noise in recent if 0.0 < noise < math.inf]
        if not points:
            return max(self._least, newest)
        mean_x, mean_y = (sum(values) / len(points) for values in zip(*points))
        spread = _TRUST + sum((x - mean_x) ** 2 for x, _ in points)
        slope = (_TRUST * -self._exponent + sum((x - mean_x) * (y - mean_y) for x, y in points)) / spread
        exponent = min(max(-slope, _LEAST_EXPONENT), _MOST_EXPONENT)
        wanted = math.exp(min(mean_x + (mean_y - math.log(self.threshold)) / exponent, 60.0))
        return max(_measured_after(wanted), self._least, newest)


def _measured_after(iterations: float) -> int:
    """The first number of iterations, not below this one, after which the noise is measured."""
    return math.ceil(iterations / MEASURED_EVERY) * MEASURED_EVERY
